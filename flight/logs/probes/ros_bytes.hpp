// ROS messages and records of MCAP files as bytes, for logs that are made: to measure reading, and
// for tests.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cstdint>
#include <string_view>

#include "flight/logs/probes/log_bytes.hpp"

namespace overfly::flight::logs::probes {

enum class Wire { kRos1, kCdrLittle, kCdrBig };

/// Serialises the fields of a message.
class WireWriter {
 public:
  explicit WireWriter(Wire wire) : wire_(wire) {
    if (wire == Wire::kRos1) return;
    bytes_ = {0, static_cast<std::uint8_t>(wire == Wire::kCdrLittle ? 1 : 0), 0, 0};
  }

  template <typename T>
  WireWriter& number(T value) {
    while (wire_ != Wire::kRos1 && (bytes_.size() - 4) % sizeof(T) != 0) bytes_.push_back(0);
    put(bytes_, value);
    if (wire_ == Wire::kCdrBig) {
      std::reverse(bytes_.end() - static_cast<std::ptrdiff_t>(sizeof(T)), bytes_.end());
    }
    return *this;
  }
  WireWriter& text(std::string_view value) {
    const bool cdr = wire_ != Wire::kRos1;
    number(static_cast<std::uint32_t>(value.size() + (cdr ? 1 : 0)));
    bytes_.insert(bytes_.end(), value.begin(), value.end());
    if (cdr) bytes_.push_back(0);
    return *this;
  }
  WireWriter& header(std::int64_t stamp_ns, std::string_view frame_id) {
    constexpr std::int64_t kNs = 1'000'000'000;
    if (wire_ == Wire::kRos1) number(std::uint32_t{7});
    number(static_cast<std::int32_t>(stamp_ns / kNs));
    number(static_cast<std::uint32_t>(stamp_ns % kNs));
    return text(frame_id);
  }
  WireWriter& vector(const Eigen::Vector3d& value) {
    for (const double component : value) number(component);
    return *this;
  }
  WireWriter& quaternion(const Eigen::Quaterniond& q) {
    for (const double component : {q.x(), q.y(), q.z(), q.w()}) number(component);
    return *this;
  }
  WireWriter& zeros(int count) {
    for (int i = 0; i < count; ++i) number(0.0);
    return *this;
  }
  [[nodiscard]] const Bytes& bytes() const { return bytes_; }

 private:
  Wire wire_;
  Bytes bytes_;
};

inline Bytes odometry(Wire wire,
                      std::int64_t stamp_ns,
                      const Eigen::Vector3d& position,
                      const Eigen::Quaterniond& rotation,
                      std::string_view frame_id = "odom",
                      std::string_view child_frame_id = "base_link") {
  WireWriter message(wire);
  message.header(stamp_ns, frame_id).text(child_frame_id).vector(position).quaternion(rotation);
  return message.zeros(36 + 6 + 36).bytes();
}

inline Bytes imu_message(Wire wire,
                         std::int64_t stamp_ns,
                         const Eigen::Quaterniond& rotation,
                         double first_covariance = 0.01,
                         std::string_view frame_id = "base_link") {
  WireWriter message(wire);
  message.header(stamp_ns, frame_id).quaternion(rotation).number(first_covariance);
  return message.zeros(8 + 3 + 9 + 3 + 9).bytes();
}

// --- MCAP ---

inline void put_counted(Bytes& bytes, std::string_view text) {
  put(bytes, static_cast<std::uint32_t>(text.size()));
  put_text(bytes, text, text.size());
}

inline Bytes mcap_record(std::uint8_t opcode, const Bytes& content) {
  Bytes record = {opcode};
  put(record, std::uint64_t{content.size()});
  append(record, content);
  return record;
}

inline Bytes mcap_start(std::string_view profile) {
  Bytes content;
  put_counted(content, profile);
  put_counted(content, "by hand");
  Bytes bytes;
  put_text(bytes, "\x89MCAP0\r\n", 8);
  append(bytes, mcap_record(0x01, content));
  return bytes;
}

inline Bytes mcap_schema(std::uint16_t id, std::string_view name) {
  Bytes content;
  put(content, id);
  put_counted(content, name);
  put_counted(content, "ros2msg");
  put_counted(content, "the definition");
  return mcap_record(0x03, content);
}

inline Bytes mcap_channel(std::uint16_t id,
                          std::uint16_t schema,
                          std::string_view topic,
                          std::string_view encoding) {
  Bytes content;
  put(content, id);
  put(content, schema);
  put_counted(content, topic);
  put_counted(content, encoding);
  put(content, std::uint32_t{0});
  return mcap_record(0x04, content);
}

inline Bytes mcap_message(std::uint16_t channel, std::uint64_t log_time_ns, const Bytes& data) {
  Bytes content;
  put(content, channel);
  put(content, std::uint32_t{0});
  put(content, log_time_ns);
  put(content, log_time_ns);
  append(content, data);
  return mcap_record(0x05, content);
}

/// @param stored  the records as they are stored; `records` of `raw_bytes` without compression
inline Bytes mcap_chunk(const Bytes& stored,
                        std::uint64_t raw_bytes,
                        std::uint32_t raw_crc,
                        std::string_view compression,
                        std::uint64_t first_ns = 0,
                        std::uint64_t last_ns = 0) {
  Bytes content;
  put(content, first_ns);
  put(content, last_ns);
  put(content, raw_bytes);
  put(content, raw_crc);
  put_counted(content, compression);
  put(content, std::uint64_t{stored.size()});
  append(content, stored);
  return mcap_record(0x06, content);
}

/// The end of the data and a footer without a summary.
inline Bytes mcap_end(std::uint32_t data_crc = 0) {
  Bytes crc;
  put(crc, data_crc);
  Bytes bytes = mcap_record(0x0F, crc);
  append(bytes, mcap_record(0x02, Bytes(20, 0)));
  put_text(bytes, "\x89MCAP0\r\n", 8);
  return bytes;
}

}  // namespace overfly::flight::logs::probes
