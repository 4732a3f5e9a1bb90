// A run as a report shows it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/motion/pose.hpp"
#include "evaluation/axis_errors.hpp"
#include "server/record/estimator_status.hpp"
#include "server/record/rows/rows.hpp"
#include "server/record/run_info.hpp"
#include "server/record/run_manifest.hpp"
#include "server/scoring/run_metrics.hpp"

namespace overfly::server::report {

/// What a report shows of an estimator's answer to a frame.
struct ReportAnswer {
  std::int64_t t_ns = 0;
  TrackingState state = TrackingState::kInitialising;
  bool scored = false;      ///< it tracks, in the map that is scored
  double latency_ms = 0.0;  ///< 0 = not known
  /// Estimated pose of the body by the alignment that is shown; only of answers that are scored.
  std::optional<Pose> T_world_body = {};
};

/// One estimator of a run.
struct ReportEstimate {
  std::string name;
  std::size_t camera = kMainCamera;  ///< index of the camera whose images it gets
  std::vector<ReportAnswer> answers;
  EstimatorStatus status;
  std::map<evaluation::AlignmentMode, evaluation::AxisRmse> axis_rmse;
  /// By the alignment that is shown; one for each of Score::matched_t_ns.
  std::vector<evaluation::AxisError> axis_errors;
};

/// A warning of a run, or equal lines of its log as one.
struct ReportWarning {
  std::string level;   ///< "note", "warning" or "error"
  std::string source;  ///< the estimator that wrote it; else empty
  std::string text;
  std::optional<double> first_s;  ///< time of the first line in the log
  std::int64_t lines = 1;
};

struct ReportRun {
  std::filesystem::path folder;
  std::string id;     ///< name of its folder
  std::string label;  ///< short and unique in the report: "run 2"; empty if it is the only one
  RunInfo info;
  RunManifest manifest;
  nlohmann::json scenario;  ///< as flown; null if the file cannot be read
  RunMetrics metrics;       ///< with the errors of single poses by the alignment that is shown
  std::vector<RunCamera> cameras;
  std::vector<std::vector<FrameRow>> frames;  ///< by camera
  std::vector<ReportEstimate> estimates;      ///< in the order of the manifest
  std::vector<ReportWarning> warnings;
  std::size_t warnings_left_out = 0;

  [[nodiscard]] const EstimatorMetrics& metrics_of(const ReportEstimate& estimate) const {
    return metrics.estimators.at(estimate.name);
  }
  /// Frames and answers: what the run's size in memory depends on.
  [[nodiscard]] std::size_t rows() const {
    std::size_t count = 0;
    for (const std::vector<FrameRow>& of_camera : frames) count += of_camera.size();
    for (const ReportEstimate& estimate : estimates) count += estimate.answers.size();
    return count;
  }
  [[nodiscard]] const std::vector<FrameRow>& main_frames() const { return frames.at(kMainCamera); }
};

}  // namespace overfly::server::report
