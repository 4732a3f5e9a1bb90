// What all messages of ROS 2 are made of: their serialisation and the definitions of common types.
#pragma once

#include <concepts>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/motion/pose.hpp"
#include "core/time.hpp"
#include "server/ros2/ros2_type.hpp"

namespace overfly::server {

/// Parts of definitions as ros2msg: what follows the fields of a message.
namespace ros2_definition {
inline const std::string kSeparator = std::string(80, '=') + "\n";
inline const std::string kHeader =
    kSeparator + "MSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n" +
    kSeparator + "MSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n";
inline const std::string kQuaternion =
    kSeparator + "MSG: geometry_msgs/Quaternion\nfloat64 x\nfloat64 y\nfloat64 z\nfloat64 w\n";
inline const std::string kVector3 =
    kSeparator + "MSG: geometry_msgs/Vector3\nfloat64 x\nfloat64 y\nfloat64 z\n";
}  // namespace ros2_definition

class CdrWriter {
 public:
  explicit CdrWriter(const Ros2Header& first) { header(first); }
  /// A message that begins with a time.
  explicit CdrWriter(const Ros2Time& first) { time(first); }
  /// A message that begins with the length of a sequence.
  explicit CdrWriter(std::uint32_t length) { number(length); }

  template <typename T>
  requires std::integral<T> || std::floating_point<T>
  void number(T value) {
    constexpr std::size_t kHeaderBytes = 4;
    const std::size_t used = bytes_.size() - kHeaderBytes;
    const std::size_t at = kHeaderBytes + (used + sizeof(T) - 1) / sizeof(T) * sizeof(T);
    bytes_.resize(at + sizeof(T));
    std::memcpy(bytes_.data() + at, &value, sizeof(T));
  }
  void text(std::string_view value) {
    number(static_cast<std::uint32_t>(value.size() + 1));
    bytes_.insert(bytes_.end(), value.begin(), value.end());
    bytes_.push_back(0);
  }
  void numbers(std::span<const double> values) {
    for (const double value : values) number(value);
  }
  void octets(std::span<const std::uint8_t> values) {
    number(static_cast<std::uint32_t>(values.size()));
    bytes_.insert(bytes_.end(), values.begin(), values.end());
  }
  void time(const Ros2Time& time) {
    number(static_cast<std::int32_t>(time.stamp_ns / kNsPerS));
    number(static_cast<std::uint32_t>(time.stamp_ns % kNsPerS));
  }
  void header(const Ros2Header& header) {
    time({header.stamp_ns});
    text(header.frame_id);
  }
  void pose(const Pose& pose) {
    for (const double value : pose.translation) number(value);
    for (const double value : pose.rotation.coeffs()) number(value);  // x, y, z, w
  }
  [[nodiscard]] std::vector<std::uint8_t> take() { return std::move(bytes_); }

 private:
  std::vector<std::uint8_t> bytes_ = {0, 1, 0, 0};  // plain CDR, little-endian
};

}  // namespace overfly::server
