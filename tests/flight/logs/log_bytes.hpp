// Flight logs built by hand, byte by byte, for tests and benchmarks.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

#include "flight/mavlink/frame.hpp"

namespace overfly::flight::testing {

using Bytes = std::vector<std::uint8_t>;

template <typename T>
void put(Bytes& bytes, T value) {
  bytes.resize(bytes.size() + sizeof value);
  std::memcpy(bytes.data() + bytes.size() - sizeof value, &value, sizeof value);
}

/// Text, filled up with zeros to `length`. @pre it is not longer
inline void put_text(Bytes& bytes, std::string_view text, std::size_t length) {
  const std::size_t start = bytes.size();
  bytes.resize(start + length, 0);
  std::memcpy(bytes.data() + start, text.data(), text.size());
}

inline void append(Bytes& bytes, const Bytes& more) {
  bytes.insert(bytes.end(), more.begin(), more.end());
}

inline void write_bytes(const std::filesystem::path& file, const Bytes& bytes) {
  std::ofstream(file, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()),
             static_cast<std::streamsize>(bytes.size()));
}

// --- MAVLink ---

inline Bytes attitude_payload(std::uint32_t boot_ms, float roll, float pitch, float yaw) {
  Bytes payload;
  put(payload, boot_ms);
  for (const float value : {roll, pitch, yaw, 0.1F, 0.2F, 0.3F}) put(payload, value);
  return payload;
}

inline Bytes global_position_payload(std::uint32_t boot_ms,
                                     std::int32_t lat,
                                     std::int32_t lon,
                                     std::int32_t alt_mm) {
  Bytes payload;
  put(payload, boot_ms);
  for (const std::int32_t value : {lat, lon, alt_mm, alt_mm}) put(payload, value);
  for (const std::int16_t value : {2500, 0, 0, 0}) put(payload, value);
  return payload;
}

/// A frame of a system, component 1; empty if it cannot be encoded.
inline Bytes frame_bytes(std::uint32_t id,
                         const Bytes& payload,
                         std::uint8_t sequence,
                         std::uint8_t system = 1,
                         mavlink::Version version = mavlink::Version::kTwo) {
  const auto bytes = mavlink::encode_frame({version, sequence, system, 1, id, false, payload});
  return bytes ? *bytes : Bytes{};
}

/// A record of a .tlog.
inline Bytes tlog_record(std::uint64_t received_us, const Bytes& frame) {
  Bytes record;
  for (int shift = 56; shift >= 0; shift -= 8) {
    record.push_back(static_cast<std::uint8_t>(received_us >> static_cast<unsigned>(shift)));
  }
  append(record, frame);
  return record;
}

// --- DataFlash ---

inline Bytes format_record(std::uint8_t type,
                           std::uint8_t size,
                           std::string_view name,
                           std::string_view letters,
                           std::string_view labels) {
  Bytes record;
  put_text(record, "\xA3\x95\x80", 3);
  record.push_back(type);
  record.push_back(size);
  put_text(record, name, 4);
  put_text(record, letters, 16);
  put_text(record, labels, 64);
  return record;
}

inline Bytes record_header(std::uint8_t type) { return {0xA3, 0x95, type}; }

// --- ULog ---

inline Bytes ulog_header() {
  Bytes bytes;
  put_text(bytes, "ULog\x01\x12\x35\x01", 8);
  put(bytes, std::uint64_t{1000});
  return bytes;
}

inline Bytes ulog_message(char kind, const Bytes& body) {
  Bytes bytes;
  put(bytes, static_cast<std::uint16_t>(body.size()));
  bytes.push_back(static_cast<std::uint8_t>(kind));
  append(bytes, body);
  return bytes;
}

inline Bytes ulog_text(char kind, std::string_view text) {
  return ulog_message(kind, Bytes(text.begin(), text.end()));
}

inline Bytes ulog_subscription(std::uint8_t instance, std::uint16_t id, std::string_view topic) {
  Bytes body;
  put(body, instance);
  put(body, id);
  put_text(body, topic, topic.size());
  return ulog_message('A', body);
}

inline Bytes ulog_data(std::uint16_t id, const Bytes& data) {
  Bytes body;
  put(body, id);
  append(body, data);
  return ulog_message('D', body);
}

// --- LCM ---

template <typename T>
void put_big(Bytes& bytes, T value) {
  put(bytes, value);
  std::reverse(bytes.end() - static_cast<std::ptrdiff_t>(sizeof value), bytes.end());
}

inline Bytes lcm_event(std::int64_t number,
                       std::int64_t time_us,
                       std::string_view channel,
                       const Bytes& data) {
  Bytes bytes;
  put_big(bytes, std::uint32_t{0xEDA1DA01});
  put_big(bytes, number);
  put_big(bytes, time_us);
  put_big(bytes, static_cast<std::int32_t>(channel.size()));
  put_big(bytes, static_cast<std::int32_t>(data.size()));
  put_text(bytes, channel, channel.size());
  append(bytes, data);
  return bytes;
}

/// A message truth_t.
inline Bytes lcm_truth(std::int64_t t_ns,
                       const Eigen::Vector3d& p_enu,
                       const Eigen::Quaterniond& R_enu_camera) {
  Bytes bytes;
  put_big(bytes, std::uint64_t{0x5287a249b16a09ba});
  for (const std::int64_t value : {t_ns / 1000, t_ns, t_ns, std::int64_t{0}}) {
    put_big(bytes, value);
  }
  for (const double value : p_enu) put_big(bytes, value);
  for (const double value : R_enu_camera.coeffs()) put_big(bytes, value);
  return bytes;
}

}  // namespace overfly::flight::testing
