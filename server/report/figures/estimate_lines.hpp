// Poses and errors of a run as lines of plots. Times in seconds, lengths in metres, angles in
// degrees.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "server/report/plot/band_plot.hpp"
#include "server/report/plot/series.hpp"
#include "server/report/run/report_run.hpp"

namespace overfly::server::report {

/// Value of a quantity at a pose of the body in the world.
using PoseValue = std::function<double(const Pose&)>;

[[nodiscard]] double height_m(const Pose& T_world_body);
[[nodiscard]] double roll_deg(const Pose& T_world_body);
[[nodiscard]] double pitch_deg(const Pose& T_world_body);
/// In [0, 360), clockwise from north.
[[nodiscard]] double yaw_deg(const Pose& T_world_body);

/// Longest time between two frames without a gap in the lines: half a second, or three frames at
/// low rates [ns].
[[nodiscard]] std::int64_t gap_limit_ns(const std::vector<FrameRow>& frames);

/// A quantity of the truth over time; of the main camera's frames.
[[nodiscard]] std::vector<plot::Point> truth_over_time(const ReportRun& run,
                                                       const PoseValue& value);
/// A quantity of the estimate over time. Gaps where it does not track, and in other maps.
[[nodiscard]] std::vector<plot::Point> estimate_over_time(const ReportRun& run,
                                                          const ReportEstimate& estimate,
                                                          const PoseValue& value);

/// Paths: `x` and `y` are axes of the world frame (0 = east, 1 = north, 2 = up).
[[nodiscard]] std::vector<plot::Point> truth_path(const ReportRun& run, int x, int y);
[[nodiscard]] std::vector<plot::Point> estimate_path(const ReportRun& run,
                                                     const ReportEstimate& estimate,
                                                     int x,
                                                     int y);

/// Values of the matched poses (Score::matched_t_ns), with gaps like those of estimate_over_time.
[[nodiscard]] std::vector<plot::Point> matched_over_time(const ReportRun& run,
                                                         const ReportEstimate& estimate,
                                                         const std::vector<double>& values);

/// Time from a frame to its answer [ms].
[[nodiscard]] std::vector<plot::Point> latency_over_time(const ReportRun& run,
                                                         const ReportEstimate& estimate);

/// A quantity of a camera's frames over time; frames of which `value` is empty are gaps.
[[nodiscard]] std::vector<plot::Point> frames_over_time(
    const ReportRun& run,
    std::size_t camera,
    const std::function<std::optional<double>(const FrameRow&)>& value);

/// The estimator's states. A state lasts to the next answer, or at most for the gap limit.
[[nodiscard]] std::vector<plot::Band> state_bands(const ReportRun& run,
                                                  const ReportEstimate& estimate);

}  // namespace overfly::server::report
