// Writes a run folder during its run, and updates the timeline with the same data.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "server/files/whole_file.hpp"
#include "server/record/estimator_event.hpp"
#include "server/record/rows/agreement_rows.hpp"
#include "server/record/rows/sensor_files.hpp"
#include "server/record/run_folder.hpp"
#include "server/record/run_info.hpp"
#include "server/record/run_lock.hpp"
#include "server/record/run_manifest.hpp"
#include "server/record/run_records.hpp"
#include "server/record/truth_samples.hpp"
#include "server/scenario/scenario.hpp"
#include "server/scoring/run_metrics.hpp"
#include "server/timeline/live_alignment.hpp"
#include "server/timeline/run_timeline.hpp"
#include "server/timing/latency_histogram.hpp"
#include "server/timing/stage_timer.hpp"

namespace overfly::server {

/// Used only by the run's thread.
class RunRecorder {
 public:
  /// Creates the folder and takes its lock; from then on the manifest says "running".
  /// @param timeline  its info has the id and the time of the request; created if null
  /// Errors: kConflict if the folder is not empty; kIo.
  static Result<std::unique_ptr<RunRecorder>> create(const std::filesystem::path& folder,
                                                     const Scenario& scenario,
                                                     std::shared_ptr<RunTimeline> timeline,
                                                     bool publish_images);

  /// Contents of the manifest without the run's info; written by write_manifest().
  [[nodiscard]] RunManifest& manifest() { return manifest_; }
  Status write_manifest();
  /// Takes the truth while the run flies.
  [[nodiscard]] TruthSampleFile& truth_samples() { return *truth_samples_; }

  /// Adds the cameras to manifest and timeline, and stores their photometric calibration.
  /// @param calibrated  what estimators are given of each camera; empty = the true intrinsics
  Status set_cameras(const std::vector<std::optional<CalibratedIntrinsics>>& calibrated);
  void set_length(std::int64_t duration_ns, std::int64_t frames_total);

  /// @param camera  index; of each frame the main camera's record comes first
  /// @param image  null if it was lost: then it is neither recorded nor shown
  /// @param deep  the same image from a sensor deeper than 8 bit, else empty
  Status add_frame(FrameRow row,
                   const std::shared_ptr<const Image>& image,
                   const Image16& deep,
                   std::size_t camera);
  /// Samples of the aircraft's other sensors, in the order of their times.
  Status add_sensor_samples(const SensorSamples& samples) { return sensor_files_.add(samples); }
  /// @pre the scenario compares recorded images
  Status add_agreement(const AgreementRow& row);
  Status add_late_frame(std::int64_t frame, std::int64_t t_ns);
  Status add_event(std::size_t estimator, EstimatorEvent event);
  /// Log lines of an estimator; beyond a limit further lines are dropped.
  Status add_estimator_log(std::size_t estimator,
                           std::int64_t t_ns,
                           const std::vector<std::string>& lines);
  /// Called at the end with the resources that an estimator has used.
  void set_use(std::size_t estimator, const EstimatorUse& use);
  Status log(std::int64_t t_ns,
             const std::string& level,
             const std::string& text,
             const std::string& kind = "",
             const std::string& source = "");

  Status add_vehicle_status(const VehicleStatus& status);

  /// Derives trajectories and metrics, writes timings and the final manifest, releases the folder.
  /// @param timings  wall-clock measurements, written with those of the estimators
  Result<RunMetrics> finish(RunStatus status, const std::string& error, nlohmann::json timings);

  /// Called after finish() failed: sets the manifest to "failed" and releases the folder. Does
  /// nothing if finish() succeeded.
  void give_up(const Error& error);

  [[nodiscard]] RunInfo info() const { return info_; }
  [[nodiscard]] const RunRecords& records() const { return records_; }

 private:
  struct EstimatorState {
    LineFile lines;
    LiveAlignment alignment;
    TrackingState last = TrackingState::kInitialising;
    int last_map_id = 0;
    std::set<int> maps = {};  ///< ids of its answers so far
    std::vector<std::int64_t> frames = {};
    DurationList latency = {};
    LatencyHistogram latency_so_far = {};
    std::map<std::string, DurationList> stages = {};
    EstimatorStatus status = {};
    int log_rows = 0;
  };

  RunRecorder(std::filesystem::path folder, RunLock lock, const Scenario& scenario);
  Status open_files();
  Status open_camera_files();
  Status keep_image(std::int64_t frame,
                    const Image& image,
                    const Image16& deep,
                    std::size_t camera);
  Status add_answer(std::size_t estimator, EstimatorEvent& event);
  void tell_status(std::size_t estimator, const EstimatorEvent& event);
  Status log_transition(std::size_t estimator, const EstimateRecord& record);
  Status keep_debug_image(std::size_t estimator, EstimatorEvent& event);
  Status keep_map_points(std::size_t estimator, EstimatorEvent& event);
  Status write_timings(nlohmann::json timings) const;
  /// Writes the final manifest and releases the lock.
  Status let_go();

  std::filesystem::path folder_;
  std::optional<RunLock> lock_;
  const Scenario& scenario_;
  bool publish_images_ = false;
  std::shared_ptr<RunTimeline> timeline_;
  RunInfo info_;
  RunManifest manifest_;
  RunRecords records_;
  std::vector<LineFile> frame_lines_;  ///< by camera
  std::optional<LineFile> log_lines_;
  std::optional<LineFile> vehicle_lines_;    ///< created with the first line
  std::optional<LineFile> agreement_lines_;  ///< if recorded images are compared
  std::optional<TruthSampleFile> truth_samples_;
  SensorFilesWriter sensor_files_;
  std::vector<EstimatorState> estimators_;
};

}  // namespace overfly::server
