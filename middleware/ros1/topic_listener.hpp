// Listens to topics of any type and passes their messages on as bytes. Does not require ROS.
#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/result.hpp"

namespace overfly::ros1 {

/// A serialised message; valid during the call.
struct ListenedMessage {
  const std::string& topic;  ///< as it was asked for
  std::string type;          ///< as its publisher declares it: "sensor_msgs/Imu"
  std::span<const std::uint8_t> bytes;
};

struct TopicListenerOptions {
  std::string master_uri = "http://127.0.0.1:11311";
  std::string node_name = "overfly";
  std::vector<std::string> topics;
  /// The topics have images: messages of up to kMostImageBytes are passed on, and of those that
  /// wait only the newest are kept.
  bool images = false;
  std::chrono::milliseconds patience{10000};  ///< for the master's answer
};

class TopicListener {
 public:
  /// Larger messages are left out and counted.
  static constexpr std::size_t kMostBytes = std::size_t{1} << 16U;
  static constexpr std::size_t kMostImageBytes = std::size_t{128} << 20U;
  using Take = std::function<void(const ListenedMessage&)>;

  /// Subscribes to topics. Publishers may come and go.
  /// @param take    called on a thread of the listener until it is destroyed
  /// @param cancel  ends the wait for the master; may be null
  /// Errors: kUnsupported if ROS 1 is not built in; kInvalidArgument naming the address or topic;
  /// as Node::join.
  [[nodiscard]] static Result<std::unique_ptr<TopicListener>> open(
      const TopicListenerOptions& options, Take take, const std::atomic<bool>* cancel);
  virtual ~TopicListener() = default;

  /// One line for error messages: "/mavros/imu/data has 1 publisher, ...".
  [[nodiscard]] virtual std::string publishers() const = 0;
  /// Messages left out because they are too large.
  [[nodiscard]] virtual std::uint64_t too_large() const = 0;
};

}  // namespace overfly::ros1
