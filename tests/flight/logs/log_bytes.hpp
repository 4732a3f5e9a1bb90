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

#include "flight/logs/probes/log_bytes.hpp"

namespace overfly::flight::testing {

using namespace logs::probes;

inline void write_bytes(const std::filesystem::path& file, const Bytes& bytes) {
  std::ofstream(file, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()),
             static_cast<std::streamsize>(bytes.size()));
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
