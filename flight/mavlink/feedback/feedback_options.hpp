// What is sent back to an autopilot.
#pragma once

#include <cstdint>
#include <optional>

namespace overfly::flight::mavlink {

enum class FeedbackMessage {
  kVisionPositionEstimate,
  kOdometry,
  kGpsInput,
};

/// "VISION_POSITION_ESTIMATE", "ODOMETRY", "GPS_INPUT".
[[nodiscard]] const char* to_string(FeedbackMessage message);

struct FeedbackOptions {
  FeedbackMessage message = FeedbackMessage::kOdometry;
  /// Between capture and sending, by the vehicle's clock; in [0, 400 ms].
  std::int64_t latency_ns = 0;
  /// Most messages per second of the vehicle's clock; 0: every estimate.
  double rate_hz = 0.0;
  /// Heights and climb rates are the estimate's; otherwise they are the vehicle's own.
  bool send_height = false;
  /// Sets the origin of the vehicle's local positions if it has none.
  bool set_origin = false;
  /// Standard deviations of each axis; empty: unknown. Of a pose either both or none.
  std::optional<double> position_std_dev_m;
  std::optional<double> attitude_std_dev_rad;
  std::optional<double> velocity_std_dev_m_s;
};

}  // namespace overfly::flight::mavlink
