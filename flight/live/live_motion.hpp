// The states of a live vehicle between its samples.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <string>

#include "core/earth/geodesy.hpp"
#include "core/motion/truth_source.hpp"
#include "flight/live/live_samples.hpp"

namespace overfly::flight::live {

/// "12.345 s".
[[nodiscard]] std::string seconds_shown(std::int64_t t_ns);

/// Interpolates positions by cubic Hermite polynomials of their velocities, or linearly without
/// (the velocity is then their difference), and attitudes by SLERP, and counts the gaps that it
/// bridges. Not thread-safe.
class LiveMotion {
 public:
  /// @param geoid_separation_m  added to the heights of positions
  /// @param gap_limit_ns        longer gaps are counted
  LiveMotion(const LocalFrame& frame, double geoid_separation_m, std::int64_t gap_limit_ns)
      : frame_(frame), geoid_separation_m_(geoid_separation_m), gap_limit_ns_(gap_limit_ns) {}

  /// The state at a time of the samples' clock; so is its t_ns. Times must not decrease.
  /// @param joint  positions and attitudes are those of the same messages
  /// @pre both have a sample before or at the time, and one at or after it
  [[nodiscard]] AircraftState at(const std::deque<LivePosition>& positions,
                                 const std::deque<LiveAttitude>& attitudes,
                                 bool joint,
                                 std::int64_t t_ns);

  [[nodiscard]] std::uint64_t gap_count() const { return gaps_; }
  /// The gaps so far; empty without.
  /// @param start_ns  of the flight, by the samples' clock
  [[nodiscard]] std::optional<std::string> gaps_text(std::int64_t start_ns) const;

 private:
  [[nodiscard]] Geodetic point_of(const Eigen::Vector3d& geodetic) const;
  [[nodiscard]] AircraftState state_of(const LivePosition& position) const;
  void set_attitude(const std::deque<LiveAttitude>& attitudes,
                    bool joint,
                    std::int64_t t_ns,
                    AircraftState& state);
  static void complete_airspeed(const LivePosition& position, AircraftState& state);
  void note_gap(std::int64_t begin_ns, std::int64_t end_ns);

  LocalFrame frame_;
  double geoid_separation_m_;
  std::int64_t gap_limit_ns_;
  std::uint64_t gaps_ = 0;
  std::int64_t longest_gap_ns_ = 0;
  std::int64_t longest_gap_at_ns_ = 0;
  std::int64_t last_gap_begin_ns_ = -1;  ///< counted already
};

}  // namespace overfly::flight::live
