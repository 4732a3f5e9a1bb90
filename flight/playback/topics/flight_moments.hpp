// A flight as what the aircraft's sensors would measure without errors, at equal steps of time.
#pragma once

#include <cstdint>
#include <optional>
#include <utility>

#include "core/earth/geodesy.hpp"
#include "core/result.hpp"
#include "core/sensors/sensor_samples.hpp"
#include "flight/playback/played_flight.hpp"

namespace overfly::flight::playback {

struct FlightMoment {
  std::int64_t number = 0;
  std::int64_t t_ns = 0;  ///< since the flight's start
  Pose T_map_body;        ///< map: east, north, up at the map's origin; body: forward-right-down
  Eigen::Quaterniond R_enu_body = Eigen::Quaterniond::Identity();  ///< enu: where the aircraft is
  GpsSample gps;  ///< the true place and velocity, with unknown accuracies (NaN)
  /// The flight's angular rate; the specific force is the change of the velocity over the step
  /// around the moment (at the ends half of it), minus normal gravity.
  ImuSample imu;
};

class FlightMoments {
 public:
  /// Errors: kInvalidArgument for a rate outside of [kSlowestMessagesHz, kFastestMessagesHz];
  /// kUnsupported for a flight of unknown length; kNotFound for a flight without a state; those of
  /// the flight.
  static Result<FlightMoments> create(PlayedFlight played);

  /// Empty behind the end of the flight. @param number  from 0 on, in any order
  /// Errors: those of the flight.
  [[nodiscard]] Result<std::optional<FlightMoment>> at(std::int64_t number);
  /// Moments 0 to count() - 1 are within the flight.
  [[nodiscard]] std::int64_t count() const { return count_; }
  [[nodiscard]] std::int64_t period_ns() const { return period_ns_; }
  /// That of the flight's frame if its recording has one, else the flight's first position within
  /// 1e-9 deg and 1 mm.
  [[nodiscard]] const Geodetic& map_origin() const { return map_.origin(); }
  /// Unix time of the flight's start where it is known; else that of the recording's clock, from
  /// 1 s on.
  [[nodiscard]] std::int64_t epoch_ns() const { return epoch_ns_; }

 private:
  explicit FlightMoments(PlayedFlight played) : played_(std::move(played)) {}

  PlayedFlight played_;
  LocalFrame map_{Geodetic{}};
  std::int64_t length_ns_ = 0;
  std::int64_t period_ns_ = 0;
  std::int64_t count_ = 0;
  std::int64_t epoch_ns_ = 0;
};

}  // namespace overfly::flight::playback
