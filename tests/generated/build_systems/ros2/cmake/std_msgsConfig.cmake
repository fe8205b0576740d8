add_library(std_msgs::std_msgs INTERFACE IMPORTED)
set(std_msgs_TARGETS std_msgs::std_msgs)
