// Options of a live flight.
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>

#include "core/time.hpp"

namespace overfly::flight::mavlink {
class FrameRecorder;
}

namespace overfly::flight::live {

/// What is taken as truth.
enum class TruthPreference {
  kBest,        ///< the simulator's state if the vehicle sends it, the estimate otherwise
  kSimulation,  ///< SIM_STATE or HIL_STATE_QUATERNION
  kEstimate,    ///< what the autopilot believes
};

/// When the flight begins. Without a condition: with the first position and attitude.
struct StartCondition {
  /// When this item of the mission, or one after it, is the current one; negative: no condition.
  std::int32_t mission_item = -1;
};

/// Conditions that end the flight, in addition to a restart of the vehicle.
struct StopConditions {
  bool on_disarm = false;   ///< when the vehicle is disarmed after it was armed
  bool on_landing = false;  ///< when it reports to be on the ground after it was in the air
  /// When this item of the mission becomes the current one, or one after it where one before it
  /// was; the item that is current at first does not count. Negative: never.
  std::int32_t mission_item = -1;
};

struct LiveTruthOptions {
  TruthPreference truth = TruthPreference::kBest;
  /// Height of the geoid above the ellipsoid at the place: vehicles send heights above sea level.
  double geoid_separation_m = 0.0;
  /// Longer gaps between samples are interpolated as well, but reported [vehicle's clock].
  std::int64_t gap_limit_ns = kNsPerS / 2;
  /// Time of the vehicle's clock for which kBest waits for the simulator's state.
  std::int64_t simulation_wait_ns = 2 * kNsPerS;
  /// A wait for a sample ends with an error after this time without one.
  std::chrono::milliseconds patience{10000};
  StartCondition start;
  StopConditions stop;
  /// Records the link's messages; its problem is a warning of the flight. May be null.
  std::shared_ptr<mavlink::FrameRecorder> recorder = nullptr;
  std::vector<std::string> warnings{};  ///< of the preparation, which come first
};

}  // namespace overfly::flight::live
