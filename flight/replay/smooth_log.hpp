// A flight log as a smooth motion.
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/earth/geodesy.hpp"
#include "core/motion/pose.hpp"
#include "core/result.hpp"
#include "flight/logs/flight_log.hpp"
#include "flight/logs/truth/log_trajectory.hpp"
#include "flight/logs/truth/logged_truth.hpp"
#include "flight/smoothing/smooth_motion.hpp"

namespace overfly::flight {

/// A smoothed log. Times of the motion count from epoch_ns of the vehicle's clock [s]; its frame is
/// east-north-up at the first position.
struct SmoothedLog {
  std::int64_t epoch_ns = 0;
  LocalFrame frame;
  logs::HeightDatum height = logs::HeightDatum::kMeanSeaLevel;  ///< of the log's positions
  double geoid_separation_m = 0.0;                              ///< added to them
  smoothing::SmoothedMotion smoothed;
  std::string position_source;
  std::string attitude_source;
  std::uint32_t boot = 0;  ///< as LoggedTruth::boot
  std::vector<std::string> warnings;

  /// First and last time of the motion by the vehicle's clock [ns].
  [[nodiscard]] std::int64_t begin_ns() const;
  [[nodiscard]] std::int64_t end_ns() const;
  /// T_frame_body at a time of the motion.
  [[nodiscard]] Pose pose(const smoothing::MotionState& state) const;
};

/// Reads the samples of a log and smooths them.
/// @param geoid_separation_m  height of the geoid above the ellipsoid at the place
/// Errors: as read_log_samples, separation_of and smooth_motion, naming the file; kUnsupported if
/// the log does not state where its positions are.
[[nodiscard]] Result<SmoothedLog> smooth_log(const logs::OpenedLog& log,
                                             const logs::TrajectoryRequest& request,
                                             const smoothing::SmoothingOptions& options,
                                             double geoid_separation_m,
                                             const std::atomic<bool>* cancel = nullptr,
                                             const smoothing::SmoothingProgress& progress = {});

inline constexpr std::size_t kMaxSampledPoses = 10'000'000;

/// The motion at even times from its begin, by the vehicle's clock.
/// @param rate_hz  (0, 1000]
/// Errors: kInvalidArgument outside of that range or for more than kMaxSampledPoses.
[[nodiscard]] Result<logs::LogTrajectory> sampled_trajectory(const SmoothedLog& log,
                                                             double rate_hz);

/// Writes the residuals of all samples as CSV: t_s by the vehicle's clock, kind (position,
/// attitude), used, shifted (0 or 1), east_m, north_m, up_m or x_deg, y_deg, z_deg in body axes.
/// Errors: kIo.
[[nodiscard]] Status write_residuals(const std::filesystem::path& file, const SmoothedLog& log);

/// A jump as a line: "step of the positions by 14.5 m at 40.000 s".
[[nodiscard]] std::string jump_text(const SmoothedLog& log, const smoothing::Jump& jump);

}  // namespace overfly::flight
