add_library(diagnostic_msgs::diagnostic_msgs INTERFACE IMPORTED)
set(diagnostic_msgs_TARGETS diagnostic_msgs::diagnostic_msgs)
