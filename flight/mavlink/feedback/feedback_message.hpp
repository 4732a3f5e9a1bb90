// Estimates as MAVLink messages.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>

#include "core/earth/geodesy.hpp"
#include "flight/logs/local_grid.hpp"
#include "flight/mavlink/autopilots.hpp"
#include "flight/mavlink/feedback/feedback_options.hpp"
#include "flight/mavlink/feedback/feedback_track.hpp"
#include "flight/mavlink/messages.hpp"
#include "flight/mavlink/payload.hpp"

namespace overfly::flight::mavlink {

/// What a message needs to know of the vehicle and of the place.
struct FeedbackPlace {
  LocalFrame frame;  ///< the world's
  double geoid_separation_m = 0.0;
  std::uint8_t autopilot = kArduPilot;  ///< MAV_AUTOPILOT
  /// Where the vehicle's local positions count from; needed but for GPS_INPUT.
  std::optional<logs::LocalOrigin> origin;
  /// The vehicle's own height and climb; needed if the estimate's height is not sent.
  std::optional<double> own_alt_msl_m;
  double own_v_down_m_s = 0.0;
  std::int64_t utc_ns = 0;  ///< of the capture; for GPS_INPUT
};

/// A message and the bytes of its payload.
struct FeedbackPayload {
  MessageId id = MessageId::kOdometry;
  PayloadWriter payload;
};

/// The message of an estimate, stamped with the time of its capture. Positions are
/// north-east-down from the vehicle's origin in the metres of its own grid (logs::LocalGrid),
/// attitudes those of the body (forward-right-down) relative to north-east-down at the aircraft.
///
/// Without the estimate's height, height and climb are the vehicle's own, and GPS_INPUT says in its
/// ignore_flags that they are not measured. The other two messages have no such flag, and a NaN
/// makes ArduPilot and PX4 drop the whole position. Unknown covariances are NaN in their first
/// element, unknown velocities and rates NaN.
/// @return empty if the origin or the own height is needed and unknown
[[nodiscard]] std::optional<FeedbackPayload> feedback_message(const FeedbackOptions& options,
                                                              const FeedbackSample& sample,
                                                              const FeedbackPlace& place);

}  // namespace overfly::flight::mavlink
