// Records of flight logs as bytes, for logs that are made: to measure reading, and for tests.
#pragma once

#include <cstdint>
#include <cstring>
#include <string_view>
#include <vector>

#include "flight/mavlink/frame.hpp"

namespace overfly::flight::logs::probes {

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

}  // namespace overfly::flight::logs::probes
