// Overfly's LCM messages as bytes. Private to lcm.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>
#include <string_view>

#include "flight/logs/log_sink.hpp"

namespace overfly::flight::logs {

/// Fingerprints of the types in middleware/lcm/types whose second field is t_ns, as lcm-gen
/// computes them.
enum class LcmType : std::uint64_t {
  kTruth = 0x5287a249b16a09ba,
  kImage = 0xf4937b0d814172f8,
  kPose = 0x8e3c3a4ab34b4e3a,
  kSimTime = 0xe90c6fc4d87af431,
  kDebug = 0x856bca71191b3891,
  kWorldPose = 0x7884b766ddbdb1af,
  kImu = 0x13b6cfa4e7f6d5d2,
  kBarometer = 0x7474facbe707e2be,
  kGps = 0x6e481370a472a917,
  kAirspeed = 0x636cd740e32eee76,
  kMagnetometer = 0xedeb216826c4afd7,
  kRange = 0xd7c5028f3465f922,
  kOther = 0,
};

/// Fingerprint of bot_core.image_t of the libbot library (field for field the type of many robots'
/// logs), as lcm-gen computes it.
inline constexpr std::uint64_t kBotCoreImage = 0x14739ffe13d5f5f0;

/// A number at an offset, big-endian; 0 if the bytes end before it.
template <typename T>
[[nodiscard]] T big_endian_at(std::span<const std::uint8_t> bytes, std::size_t offset) {
  static_assert(std::endian::native == std::endian::little, "the bytes are reversed");
  std::uint8_t raw[sizeof(T)] = {};
  if (offset + sizeof(T) <= bytes.size()) {
    for (std::size_t i = 0; i < sizeof(T); ++i) raw[i] = bytes[offset + sizeof(T) - 1 - i];
  }
  T value{};
  std::memcpy(&value, raw, sizeof value);
  return value;
}

/// The type of a message, by its first 8 bytes.
[[nodiscard]] LcmType lcm_type_of(std::span<const std::uint8_t> message);

[[nodiscard]] StreamDescription describe_channel(std::string_view channel, LcmType type);

/// Field t_ns; empty if the message ends before it. @pre not kOther
[[nodiscard]] std::optional<std::int64_t> lcm_time_ns(std::span<const std::uint8_t> message);

/// Passes the position and attitude of a truth_t on. @return false if the message ends early
bool pass_truth(std::span<const std::uint8_t> message,
                StreamId id,
                const LogTime& time,
                LogSink& sink);

/// The sample in a message of one of the types from kImu on; without one if it has none that can be
/// right. @return empty if the message ends early
[[nodiscard]] std::optional<SensorSamples> lcm_samples_in(LcmType type,
                                                          std::span<const std::uint8_t> message);

}  // namespace overfly::flight::logs
