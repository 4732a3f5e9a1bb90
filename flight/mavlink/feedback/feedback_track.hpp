// The estimates that can be sent back: with their velocities and the count of their jumps.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <deque>
#include <optional>

#include "core/motion/estimate_receiver.hpp"
#include "core/motion/pose.hpp"

namespace overfly::flight::mavlink {

/// An estimate to be sent.
struct FeedbackSample {
  std::int64_t t_ns = 0;  ///< capture
  Pose T_world_body;
  /// From the positions of the last 0.5 s; empty until there are enough.
  std::optional<Eigen::Vector3d> v_world_m_s;
  std::uint8_t reset_counter = 0;  ///< starts again at 0 after 255
};

/// Takes the answers of one estimator in order.
///
/// The reset counter goes up where the positions before and after are not of one motion: with a new
/// map, with the first position after a loss, and with a step of more than kJumpM from where the
/// velocity leads. Velocities are the derivative, at the newest position, of the parabola that fits
/// the positions since the last reset best, of at most 0.5 s.
class FeedbackTrack {
 public:
  /// A relocation or a closed loop moves an estimate further than this.
  static constexpr double kJumpM = 3.0;
  static constexpr std::int64_t kFitNs = 500'000'000;

  /// @return empty without a pose, and if the time is not later than the one before
  [[nodiscard]] std::optional<FeedbackSample> take(const PlacedEstimate& estimate);

  [[nodiscard]] std::uint64_t resets() const { return resets_; }

 private:
  struct Point {
    std::int64_t t_ns = 0;
    Eigen::Vector3d p_world_m;
  };
  [[nodiscard]] bool is_reset(const PlacedEstimate& estimate) const;
  [[nodiscard]] std::optional<Eigen::Vector3d> fit() const;

  std::deque<Point> points_;  ///< since the last reset, of at most kFitNs
  std::optional<Eigen::Vector3d> velocity_;
  std::optional<std::int64_t> last_ns_;
  int map_id_ = 0;
  bool lost_ = false;
  std::uint64_t resets_ = 0;
};

}  // namespace overfly::flight::mavlink
