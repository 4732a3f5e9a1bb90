// Any recorded flight as the messages of a vehicle that flies it.
#pragma once

#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "core/result.hpp"
#include "flight/playback/playback_records.hpp"
#include "flight/playback/played_flight.hpp"

namespace overfly::flight::playback {

/// A vehicle of system 1 with the pose, velocity and angular rate of a flight, in the messages of
/// the built-in vehicle: ATTITUDE, ATTITUDE_QUATERNION, SIM_STATE, GLOBAL_POSITION_INT at the
/// rate, HEARTBEAT (armed, AUTO) and SYSTEM_TIME each second.
///
/// The vehicle's clock is that of the recording, where that counts from the vehicle's start; else
/// it is 0 at the flight's start. Messages have it in whole milliseconds, so the flight is sampled
/// at those. Heights above the ellipsoid are sent where MAVLink has heights above mean sea level:
/// whoever flies the messages without a geoid separation gets the same heights. Specific forces are
/// not known (NaN).
class FlightRecords final : public PlaybackRecords {
 public:
  /// Errors: kInvalidArgument for a rate outside of [kSlowestMessagesHz, kFastestMessagesHz];
  /// kUnsupported for a flight of unknown length, or of more than 49 days of its clock.
  static Result<FlightRecords> create(PlayedFlight played);

  [[nodiscard]] Result<std::optional<Record>> next() override;
  Status seek(std::int64_t t_us) override;
  [[nodiscard]] std::int64_t duration_us() const override { return time_us(instants_ - 1); }
  [[nodiscard]] std::uint64_t count() const override;

 private:
  explicit FlightRecords(PlayedFlight played) : played_(std::move(played)) {}
  [[nodiscard]] std::int64_t time_us(std::int64_t instant) const {
    return instant * period_ms_ * 1000;
  }
  /// The messages of an instant, of the ids of that instant. Errors: as TruthSource::state_at.
  Status make(std::int64_t instant);

  PlayedFlight played_;
  std::int64_t period_ms_ = 0;
  std::int64_t first_ms_ = 0;  ///< the vehicle's clock at instant 0
  std::int64_t first_ns_ = 0;  ///< the flight's time at instant 0
  std::int64_t instants_ = 0;
  std::int64_t instants_per_s_ = 1;  ///< between two heartbeats
  double home_alt_m_ = 0.0;          ///< of the first state
  std::int64_t next_instant_ = 0;
  std::vector<std::vector<std::uint8_t>> frames_;  ///< of the last instant
  std::size_t next_frame_ = 0;
  std::uint8_t sequence_ = 0;
};

}  // namespace overfly::flight::playback
