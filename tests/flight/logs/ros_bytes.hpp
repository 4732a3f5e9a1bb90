// ROS messages and ROS bags built by hand, byte by byte, for tests.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "flight/logs/probes/ros_bytes.hpp"
#include "tests/flight/logs/log_bytes.hpp"

namespace overfly::flight::testing {

inline Bytes pose_stamped(Wire wire,
                          std::int64_t stamp_ns,
                          const Eigen::Vector3d& position,
                          const Eigen::Quaterniond& rotation,
                          std::string_view frame_id = "map") {
  return WireWriter(wire).header(stamp_ns, frame_id).vector(position).quaternion(rotation).bytes();
}

inline Bytes nav_sat_fix(Wire wire,
                         std::int64_t stamp_ns,
                         double lat_deg,
                         double lon_deg,
                         double alt_ellipsoid_m,
                         std::int8_t status = 0) {
  WireWriter message(wire);
  message.header(stamp_ns, "gps").number(status).number(std::uint16_t{1});
  message.vector({lat_deg, lon_deg, alt_ellipsoid_m}).zeros(9).number(std::uint8_t{0});
  return message.bytes();
}

/// sensor_msgs/Image with `size` bytes of pixels.
inline Bytes image_message(Wire wire, std::int64_t stamp_ns, std::uint32_t size) {
  WireWriter message(wire);
  message.header(stamp_ns, "camera").number(std::uint32_t{1}).number(size).text("mono8");
  message.number(std::uint8_t{0}).number(size).number(size);
  Bytes bytes = message.bytes();
  bytes.resize(bytes.size() + size, 0x55);
  return bytes;
}

// --- ROS bags ---

inline Bytes bag_fields(const std::vector<std::pair<std::string, Bytes>>& fields) {
  Bytes bytes;
  for (const auto& [name, value] : fields) {
    put(bytes, static_cast<std::uint32_t>(name.size() + 1 + value.size()));
    put_text(bytes, name + "=", name.size() + 1);
    append(bytes, value);
  }
  return bytes;
}

inline Bytes bag_record(const std::vector<std::pair<std::string, Bytes>>& fields,
                        const Bytes& data) {
  const Bytes header = bag_fields(fields);
  Bytes bytes;
  put(bytes, static_cast<std::uint32_t>(header.size()));
  append(bytes, header);
  put(bytes, static_cast<std::uint32_t>(data.size()));
  append(bytes, data);
  return bytes;
}

inline Bytes bytes_of(std::string_view text) { return {text.begin(), text.end()}; }

template <typename T>
Bytes bytes_of_number(T value) {
  Bytes bytes;
  put(bytes, value);
  return bytes;
}

/// @param index_pos  0: the bag was not closed
inline Bytes bag_start(std::uint64_t index_pos, std::string_view encryptor = "") {
  Bytes bytes = bytes_of("#ROSBAG V2.0\n");
  append(bytes,
         bag_record({{"op", {3}},
                     {"index_pos", bytes_of_number(index_pos)},
                     {"encryptor", bytes_of(encryptor)}},
                    Bytes(40, ' ')));
  return bytes;
}

inline Bytes bag_connection(std::uint32_t id, std::string_view topic, std::string_view type) {
  return bag_record(
      {{"op", {7}}, {"conn", bytes_of_number(id)}, {"topic", bytes_of(topic)}},
      bag_fields({{"topic", bytes_of(topic)}, {"type", bytes_of(type)}, {"md5sum", {}}}));
}

inline Bytes bag_message(std::uint32_t connection, std::int64_t t_ns, const Bytes& data) {
  constexpr std::int64_t kNs = 1'000'000'000;
  Bytes time = bytes_of_number(static_cast<std::uint32_t>(t_ns / kNs));
  put(time, static_cast<std::uint32_t>(t_ns % kNs));
  return bag_record({{"op", {2}}, {"conn", bytes_of_number(connection)}, {"time", time}}, data);
}

inline Bytes bag_chunk(std::string_view compression, std::uint32_t raw_bytes, const Bytes& stored) {
  return bag_record(
      {{"op", {5}}, {"compression", bytes_of(compression)}, {"size", bytes_of_number(raw_bytes)}},
      stored);
}

}  // namespace overfly::flight::testing
