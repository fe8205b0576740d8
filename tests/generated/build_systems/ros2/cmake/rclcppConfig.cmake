# As much of ROS 2 as the generated node asks for; see tests/generated/test_build_systems.py.
add_library(rclcpp::rclcpp INTERFACE IMPORTED)
target_include_directories(rclcpp::rclcpp INTERFACE ${CMAKE_CURRENT_LIST_DIR}/../include)
