#include "sensor/noise_source.hpp"

namespace overfly::sensor {

namespace {

/// The finaliser of SplitMix64.
std::uint64_t mixed(std::uint64_t value) {
  value = (value ^ (value >> 30U)) * 0xbf58476d1ce4e5b9U;
  value = (value ^ (value >> 27U)) * 0x94d049bb133111ebU;
  return value ^ (value >> 31U);
}

constexpr std::uint64_t kGoldenGamma = 0x9e3779b97f4a7c15U;

}  // namespace

double SeededSequence::next() {
  state_ += kGoldenGamma;
  return static_cast<double>(mixed(state_) >> 11U) * 0x1p-53;
}

NoiseKey noise_key(std::uint64_t seed, std::int64_t frame, NoiseStage stage) {
  std::uint64_t state = mixed(seed + kGoldenGamma);
  state = mixed(state + kGoldenGamma * (static_cast<std::uint64_t>(frame) + 1));
  state = mixed(state + kGoldenGamma * static_cast<std::uint64_t>(stage));
  const std::uint64_t more = mixed(state + kGoldenGamma);
  // Odd, so that the first multiplications of the hash keep all bits of the counter.
  return {static_cast<std::uint32_t>(state) | 1U,
          static_cast<std::uint32_t>(state >> 32U) | 1U,
          static_cast<std::uint32_t>(more) | 1U};
}

}  // namespace overfly::sensor
