// The true motion of a flight, sampled before the flight is flown.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/motion/truth_source.hpp"
#include "core/result.hpp"

namespace overfly::server::predict {

/// The longest flight that is walked [s].
inline constexpr double kLongestFlightS = 6.0 * 3600.0;
/// The most instants; those of longer flights are farther apart.
inline constexpr std::size_t kMostInstants = 1200;

/// A flight as poses every 20 ms, and instants at equal distances.
class WalkedFlight {
 public:
  /// @param step_s  between instants, at least; > 0
  /// @param duration_s  of the flight, at most
  /// @param cancel  may be null
  /// Errors: kInvalidArgument for a flight without an end, of more than kLongestFlightS or of no
  /// duration; kCancelled; as TruthSource::state_at.
  [[nodiscard]] static Result<WalkedFlight> walk(TruthSource& source,
                                                 double step_s,
                                                 double duration_s,
                                                 const std::atomic<bool>* cancel = nullptr);

  [[nodiscard]] std::size_t instants() const { return instants_; }
  [[nodiscard]] std::int64_t instant_ns(std::size_t index) const;
  [[nodiscard]] double step_s() const;
  [[nodiscard]] double duration_s() const;
  /// Between the poses: linear in position, SLERP in rotation. Clamped to the beginning; after the
  /// end straight on, without rotation.
  [[nodiscard]] Pose T_world_body_at(std::int64_t t_ns) const;
  /// States as CameraUnit::request needs them, without rates.
  [[nodiscard]] std::vector<AircraftState> states_around(std::int64_t t_ns,
                                                         std::int64_t half_ns,
                                                         std::int64_t raster_ns) const;
  /// Of the flight and of up to a second after the duration that was asked for.
  [[nodiscard]] const std::vector<Pose>& path() const { return path_; }
  /// Over ground, along the path [m].
  [[nodiscard]] double length_m() const;

 private:
  std::int64_t every_ = 1;  ///< poses from one instant to the next
  std::size_t instants_ = 0;
  std::size_t last_ = 0;  ///< pose of the flight
  std::vector<Pose> path_;
};

}  // namespace overfly::server::predict
