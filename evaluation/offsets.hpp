// Constant offsets between an estimate and the truth that explain its errors: clocks and mounts.
#pragma once

#include <cstdint>
#include <optional>

#include "core/motion/estimate.hpp"
#include "core/motion/trajectory.hpp"
#include "evaluation/evaluation.hpp"

namespace overfly::evaluation {

/// Offsets of clocks are looked for up to this size.
inline constexpr std::int64_t kMaxClockOffsetNs = 2'000'000'000;
/// An offset is reported only if it explains at least this share of the mean square error, and
/// reduces the error by more than rounding does.
inline constexpr double kLeastExplained = 0.5;
inline constexpr double kLeastGainM = 1e-3;
inline constexpr double kLeastGainDeg = 1e-2;

/// The estimate's stamps plus `offset_ns` are times of the truth.
struct ClockOffset {
  std::int64_t offset_ns = 0;
  double position_rmse_before_m = 0.0;  ///< aligned by sim3
  double position_rmse_after_m = 0.0;   ///< with the stamps corrected, aligned again
  double explained = 0.0;               ///< share of the mean square, [0, 1]
};

/// R_world_vo * R_vo_estimated * R_estimated_true is the true rotation: another mount of the
/// camera, or another definition of its axes.
struct MountOffset {
  Eigen::Quaterniond R_estimated_true = Eigen::Quaterniond::Identity();
  double rotation_rmse_before_deg = 0.0;  ///< aligned by sim3, with the clock offset corrected
  double rotation_rmse_after_deg = 0.0;
  double explained = 0.0;  ///< share of the mean square, [0, 1]
};

struct Offsets {
  std::optional<ClockOffset> clock;
  std::optional<MountOffset> mount;
};

/// Estimates both offsets from at most 2000 tracked poses of the longest map, those whose stamps
/// lie kMaxClockOffsetNs or more inside the truth.
///
/// The clock offset minimises the position error after sim3 alignment: over a grid of 50 ms, then
/// by golden-section search. Alignment leaves nothing of an offset on a straight path at constant
/// speed, and on a level circle; there it is not determined, does not explain any error, and is not
/// reported. Neither is one at the end of the range, nor any where gaps of the truth take more than
/// a tenth of the poses without an offset. The mount offset is the mean of the
/// rotation errors (chordal L2 mean: Hartley, Trumpf, Dai, Li 2013, "Rotation averaging", sec. 5.3,
/// doi:10.1007/s11263-012-0601-0); it is not determined where sim3 is degenerate.
/// Both are reported only from kLeastExplained and kLeastGainM or kLeastGainDeg on.
[[nodiscard]] Offsets find_offsets(const Trajectory& T_world_camera_truth,
                                   const EstimateTrack& estimate);

}  // namespace overfly::evaluation
