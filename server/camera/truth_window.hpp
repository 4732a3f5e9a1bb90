// The truth around each frame: where the aircraft was while the shutter was open.
#pragma once

#include <atomic>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <vector>

#include "core/motion/truth_source.hpp"
#include "core/result.hpp"

namespace overfly::server {

/// The state dt_ns later, extrapolated with constant velocity and rate.
[[nodiscard]] AircraftState extrapolated(const AircraftState& state, std::int64_t dt_ns);

/// Queries a truth source on regular grids around increasing times. The source cannot go back in
/// time. Times that overlap the previous window are therefore interpolated between the samples in
/// memory: linear in position, SLERP in rotation.
class TruthWindow {
 public:
  explicit TruthWindow(std::unique_ptr<TruthSource> source) : source_(std::move(source)) {}

  /// States at t_ns + j step_ns, j in [-n, n], n = ceil(half_ns / step_ns); the middle one is at
  /// t_ns. Before t = 0 and after the flight's end the motion is extrapolated. t_ns must not
  /// decrease from call to call. Empty if the flight has ended at t_ns.
  /// @param step_ns  > 0
  /// @param next_ns  t_ns of the next call, > t_ns: asked for too if the window reaches beyond it,
  ///                 so that the middle state of that call is not interpolated
  /// @param cancel  as in TruthSource::state_at
  /// Errors: as TruthSource::state_at.
  [[nodiscard]] Result<std::optional<std::vector<AircraftState>>> around(
      std::int64_t t_ns,
      std::int64_t half_ns,
      std::int64_t step_ns,
      std::int64_t next_ns,
      const std::atomic<bool>* cancel = nullptr);
  /// The state at one time, which must not precede the windows so far except by times in memory.
  [[nodiscard]] Result<std::optional<AircraftState>> at(std::int64_t t_ns,
                                                        const std::atomic<bool>* cancel = nullptr);
  [[nodiscard]] const TruthSource& source() const { return *source_; }
  [[nodiscard]] TruthSource& source() { return *source_; }

 private:
  [[nodiscard]] AircraftState remembered(std::int64_t t_ns) const;
  void forget_before(std::int64_t t_ns);

  std::unique_ptr<TruthSource> source_;
  std::optional<std::int64_t> ended_ns_;  ///< the first queried time beyond the flight's end
  std::deque<AircraftState> known_;       ///< by time; the first one precedes the present window
};

}  // namespace overfly::server
