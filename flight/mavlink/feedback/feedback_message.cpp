#include "flight/mavlink/feedback/feedback_message.hpp"

#include <cmath>
#include <limits>

#include "core/earth/gps_time.hpp"
#include "flight/logs/ned_attitude.hpp"
#include "flight/mavlink/autopilots.hpp"

namespace overfly::flight::mavlink {
namespace {

constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();
constexpr std::int64_t kStampUnitNs = 1000;

// MAV_FRAME
constexpr std::uint8_t kLocalNed = 1;
constexpr std::uint8_t kBodyFrd = 12;
constexpr std::uint8_t kLocalFrd = 20;

constexpr std::uint8_t kEstimatorVision = 2;  // MAV_ESTIMATOR_TYPE_VISION

// GPS_INPUT_IGNORE_FLAGS
constexpr std::uint16_t kIgnoreAlt = 1;
constexpr std::uint16_t kIgnoreVdop = 4;
constexpr std::uint16_t kIgnoreVelHoriz = 8;
constexpr std::uint16_t kIgnoreVelVert = 16;
constexpr std::uint16_t kIgnoreSpeedAccuracy = 32;
constexpr std::uint16_t kIgnoreHorizontalAccuracy = 64;
constexpr std::uint16_t kIgnoreVerticalAccuracy = 128;

/// Of a receiver that all checks accept. A camera has none of these.
constexpr std::uint8_t kFix3d = 3;
constexpr std::uint8_t kSatellites = 10;
constexpr float kDilution = 1.0F;

/// The estimate as the vehicle sees it.
struct InVehicleTerms {
  Geodetic point;  ///< with the estimate's height
  double alt_msl_m = 0.0;
  Eigen::Quaterniond R_ned_body;
  std::optional<Eigen::Vector3d> v_ned_m_s;
};

std::optional<InVehicleTerms> vehicle_terms(const FeedbackOptions& options,
                                            const FeedbackSample& sample,
                                            const FeedbackPlace& place) {
  InVehicleTerms terms;
  terms.point = place.frame.geodetic_from_world(sample.T_world_body.translation);
  terms.alt_msl_m = terms.point.alt_ellipsoid_m - place.geoid_separation_m;
  const Eigen::Quaterniond R_ned_world =
      (place.frame.R_world_enu_at(terms.point) * logs::R_enu_ned()).conjugate();
  terms.R_ned_body = (R_ned_world * sample.T_world_body.rotation).normalized();
  if (terms.R_ned_body.w() < 0.0) terms.R_ned_body.coeffs() = -terms.R_ned_body.coeffs();
  if (sample.v_world_m_s) terms.v_ned_m_s = R_ned_world * *sample.v_world_m_s;
  if (options.send_height) return terms;
  if (!place.own_alt_msl_m) return std::nullopt;
  terms.alt_msl_m = *place.own_alt_msl_m;
  if (terms.v_ned_m_s) terms.v_ned_m_s->z() = place.own_v_down_m_s;
  return terms;
}

void put_floats(PayloadWriter& payload, std::size_t at, const Eigen::Vector3d& value) {
  for (int i = 0; i < 3; ++i) {
    payload.put(at + 4 * static_cast<std::size_t>(i), static_cast<float>(value[i]));
  }
}

/// The upper triangle of a covariance of 6x6, row by row: the first three states have one variance,
/// the others another one.
void put_covariance(PayloadWriter& payload,
                    std::size_t at,
                    const std::optional<double>& first,
                    const std::optional<double>& second) {
  if (!first || !second) {
    payload.put(at, kUnknown);
    return;
  }
  std::size_t index = 0;
  for (std::size_t row = 0; row < 6; index += 6 - row, ++row) {
    const double std_dev = row < 3 ? *first : *second;
    payload.put(at + 4 * index, static_cast<float>(std_dev * std_dev));
  }
}

std::uint64_t capture_us(const FeedbackSample& sample) {
  return static_cast<std::uint64_t>(sample.t_ns / kStampUnitNs);
}

Eigen::Vector3d local_ned(const InVehicleTerms& terms, const logs::LocalOrigin& origin) {
  return logs::local_from_geodetic(
      origin,
      {deg_from_rad(terms.point.lat_rad), deg_from_rad(terms.point.lon_rad), terms.alt_msl_m});
}

PayloadWriter vision_position(const FeedbackOptions& options,
                              const FeedbackSample& sample,
                              const InVehicleTerms& terms,
                              const logs::LocalOrigin& origin) {
  const RollPitchYaw angles = attitude_from(logs::R_enu_ned() * terms.R_ned_body);
  PayloadWriter payload(117);
  payload.put(0, capture_us(sample));
  put_floats(payload, 8, local_ned(terms, origin));
  put_floats(payload, 20, {angles.roll_rad, angles.pitch_rad, angles.yaw_rad});
  put_covariance(payload, 32, options.position_std_dev_m, options.attitude_std_dev_rad);
  return payload.put(116, sample.reset_counter);
}

PayloadWriter odometry(const FeedbackOptions& options,
                       const FeedbackSample& sample,
                       const InVehicleTerms& terms,
                       const FeedbackPlace& place) {
  const Eigen::Quaterniond& q = terms.R_ned_body;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const Eigen::Vector3d unknown(nan, nan, nan);
  PayloadWriter payload(233);
  payload.put(0, capture_us(sample));
  put_floats(payload, 8, local_ned(terms, *place.origin));
  payload.put(20, static_cast<float>(q.w()));
  put_floats(payload, 24, q.vec());
  put_floats(
      payload, 36, terms.v_ned_m_s ? Eigen::Vector3d(q.conjugate() * *terms.v_ned_m_s) : unknown);
  put_floats(payload, 48, unknown);
  put_covariance(payload, 60, options.position_std_dev_m, options.attitude_std_dev_rad);
  // The rates are not known: their variance stays unknown when the velocity's is known.
  if (options.velocity_std_dev_m_s && terms.v_ned_m_s) {
    put_covariance(payload, 144, options.velocity_std_dev_m_s, nan);
  } else {
    put_covariance(payload, 144, std::nullopt, std::nullopt);
  }
  // ArduPilot accepts no other frame; with "forward" to the north it is north-east-down.
  return payload.put(228, place.autopilot == kArduPilot ? kLocalFrd : kLocalNed)
      .put(229, kBodyFrd)
      .put(230, sample.reset_counter)
      .put(231, kEstimatorVision);
}

PayloadWriter gps_input(const FeedbackOptions& options,
                        const FeedbackSample& sample,
                        const InVehicleTerms& terms,
                        const FeedbackPlace& place) {
  const auto degrees = [](double angle_rad) {
    return static_cast<std::int32_t>(std::llround(1e7 * deg_from_rad(angle_rad)));
  };
  const GpsTime time = gps_time_from_unix_ns(place.utc_ns);
  std::uint16_t ignored = 0;
  const auto ignore = [&ignored](bool unknown, std::uint16_t flags) {
    if (unknown) ignored = static_cast<std::uint16_t>(ignored | flags);
  };
  ignore(!options.send_height, kIgnoreAlt | kIgnoreVdop | kIgnoreVelVert | kIgnoreVerticalAccuracy);
  ignore(!terms.v_ned_m_s, kIgnoreVelHoriz | kIgnoreVelVert | kIgnoreSpeedAccuracy);
  ignore(!options.velocity_std_dev_m_s, kIgnoreSpeedAccuracy);
  ignore(!options.position_std_dev_m, kIgnoreHorizontalAccuracy | kIgnoreVerticalAccuracy);
  // 0 stands for unknown, 36000 for north.
  const RollPitchYaw angles = attitude_from(logs::R_enu_ned() * terms.R_ned_body);
  const auto yaw_cdeg = std::lround(100.0 * deg_from_rad(angles.yaw_rad));
  PayloadWriter payload(65);
  payload.put(0, capture_us(sample))
      .put(8, time.week_ms)
      .put(12, degrees(terms.point.lat_rad))
      .put(16, degrees(terms.point.lon_rad))
      .put(20, static_cast<float>(terms.alt_msl_m))
      .put(24, kDilution)
      .put(28, kDilution);
  put_floats(payload, 32, terms.v_ned_m_s.value_or(Eigen::Vector3d::Zero()));
  return payload.put(44, static_cast<float>(options.velocity_std_dev_m_s.value_or(0.0)))
      .put(48, static_cast<float>(options.position_std_dev_m.value_or(0.0)))
      .put(52, static_cast<float>(options.position_std_dev_m.value_or(0.0)))
      .put(56, ignored)
      .put(58, time.week)
      .put(61, kFix3d)
      .put(62, kSatellites)
      .put(63, static_cast<std::uint16_t>(yaw_cdeg <= 0 ? yaw_cdeg + 36000 : yaw_cdeg));
}

}  // namespace

const char* to_string(FeedbackMessage message) {
  switch (message) {
    case FeedbackMessage::kVisionPositionEstimate:
      return "VISION_POSITION_ESTIMATE";
    case FeedbackMessage::kOdometry:
      return "ODOMETRY";
    case FeedbackMessage::kGpsInput:
      return "GPS_INPUT";
  }
  return "";
}

std::optional<FeedbackPayload> feedback_message(const FeedbackOptions& options,
                                                const FeedbackSample& sample,
                                                const FeedbackPlace& place) {
  if (options.message != FeedbackMessage::kGpsInput && !place.origin) return std::nullopt;
  const std::optional<InVehicleTerms> terms = vehicle_terms(options, sample, place);
  if (!terms) return std::nullopt;
  switch (options.message) {
    case FeedbackMessage::kVisionPositionEstimate:
      return FeedbackPayload{MessageId::kVisionPositionEstimate,
                             vision_position(options, sample, *terms, *place.origin)};
    case FeedbackMessage::kGpsInput:
      return FeedbackPayload{MessageId::kGpsInput, gps_input(options, sample, *terms, place)};
    case FeedbackMessage::kOdometry:
      break;
  }
  return FeedbackPayload{MessageId::kOdometry, odometry(options, sample, *terms, place)};
}

}  // namespace overfly::flight::mavlink
