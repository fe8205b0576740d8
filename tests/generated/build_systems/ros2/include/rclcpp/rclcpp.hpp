// A node that takes its samples from standard input, a row of numbers each, and prints diagnostics.
#pragma once
#include <functional>
#include <iostream>
#include <memory>
#include <sstream>
#include <string>

#include <diagnostic_msgs/msg/diagnostic_array.hpp>
#include <std_msgs/msg/float64_multi_array.hpp>

#define RCLCPP_ERROR(logger, text) (void)(logger), std::cout << "error: " << (text) << "\n"

namespace rclcpp
{
template <typename Message> struct Publisher {
    using SharedPtr = std::shared_ptr<Publisher>;
    void publish(const Message &array)
    {
        for (const auto &status : array.status) {
            std::cout << int(status.level) << " " << status.name << ": " << status.message;
            for (const auto &one : status.values) {
                std::cout << " " << one.key << "=" << one.value;
            }
            std::cout << "\n";
        }
    }
};
template <typename Message> struct Subscription {
    using SharedPtr = std::shared_ptr<Subscription>;
    std::function<void(const Message &)> take;
};
class Node
{
public:
    explicit Node(const std::string &) {}
    int get_logger() const { return 0; }
    double now() const { return 0; }
    template <typename Message>
    std::shared_ptr<Publisher<Message>> create_publisher(const std::string &, int)
    {
        return std::make_shared<Publisher<Message>>();
    }
    template <typename Message, typename Callback>
    std::shared_ptr<Subscription<Message>>
    create_subscription(const std::string &, int, Callback take)
    {
        call = take;
        return std::make_shared<Subscription<Message>>();
    }
    std::function<void(const std_msgs::msg::Float64MultiArray &)> call;
};
inline void init(int, char **) {}
inline void shutdown() {}
inline void spin(const std::shared_ptr<Node> &node)
{
    std::string line;
    while (std::getline(std::cin, line)) {
        std_msgs::msg::Float64MultiArray message;
        std::istringstream words(line);
        for (double x; words >> x;) {
            message.data.push_back(x);
        }
        node->call(message);
    }
}
} // namespace rclcpp
