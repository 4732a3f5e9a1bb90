#pragma once

#include <cstdint>

namespace overfly::flight::mavlink {

// MAV_AUTOPILOT: the firmware that a heartbeat names.
inline constexpr std::uint8_t kArduPilot = 3;
inline constexpr std::uint8_t kNoAutopilot = 8;  ///< ground stations, gimbals and cameras
inline constexpr std::uint8_t kPx4 = 12;

}  // namespace overfly::flight::mavlink
