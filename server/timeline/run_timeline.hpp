// A run as a timeline, read by every view both during the run and after it.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "core/camera/camera_model.hpp"
#include "core/camera/image.hpp"
#include "core/motion/flight_event.hpp"
#include "core/motion/pose.hpp"
#include "core/result.hpp"
#include "server/files/file_stamp.hpp"
#include "server/record/estimator_status.hpp"
#include "server/record/rows/rows.hpp"
#include "server/record/run_info.hpp"
#include "server/scoring/run_metrics.hpp"
#include "server/timeline/audience.hpp"

namespace overfly::server {

/// Thread-safe. Rows are only appended and are numbered from 0. A reader asks for the rows from its
/// next number on, so no row is lost or delivered twice, live or in replay.
class RunTimeline {
 public:
  static constexpr std::size_t kMaxCounters = 32;

  explicit RunTimeline(RunInfo info, std::vector<std::string> estimators);
  /// Reads a run folder: complete, failed, or still marked as running by a program that has ended
  /// (its status is then kInterrupted).
  /// Errors: kNotFound, kUnreadable naming file and line.
  static Result<std::shared_ptr<RunTimeline>> open(const std::filesystem::path& folder);

  [[nodiscard]] RunInfo info() const;
  [[nodiscard]] const std::vector<std::string>& estimators() const { return estimators_; }
  /// The cameras, the main one first; never empty.
  [[nodiscard]] std::vector<RunCamera> cameras() const;
  /// Index of a camera by name; an empty name = the main one. Errors: kNotFound naming it.
  [[nodiscard]] Result<std::size_t> camera_index(const std::string& name) const;
  [[nodiscard]] RunCamera main_camera() const;
  /// Stamp of the manifest that this was read from or written to; none during the run.
  [[nodiscard]] FileStamp manifest_stamp() const;
  /// Null until the run is scored.
  [[nodiscard]] std::shared_ptr<const RunMetrics> metrics() const;

  /// Copies rows [first, first + at most `limit`); of the main camera by default.
  [[nodiscard]] std::vector<FrameRow> frames(std::size_t first,
                                             std::size_t limit,
                                             std::size_t camera = kMainCamera) const;
  [[nodiscard]] std::vector<EstimateRow> estimates(std::size_t estimator,
                                                   std::size_t first,
                                                   std::size_t limit) const;
  [[nodiscard]] std::vector<LogRow> logs(std::size_t first, std::size_t limit) const;
  [[nodiscard]] std::vector<VehicleStatus> vehicle_statuses(std::size_t first,
                                                            std::size_t limit) const;
  [[nodiscard]] std::size_t frame_count(std::size_t camera = kMainCamera) const;
  [[nodiscard]] std::size_t estimate_count(std::size_t estimator) const;
  [[nodiscard]] std::size_t log_count() const;
  /// Names of the counters of an estimator's answers so far, in the order of EstimateRow::counters.
  [[nodiscard]] std::vector<std::string> counter_names(std::size_t estimator) const;
  /// True if an answer so far has a covariance.
  [[nodiscard]] bool states_covariances(std::size_t estimator) const;
  /// Row of the last frame stamped at or before t; empty before the first.
  [[nodiscard]] std::optional<FrameRow> frame_at(std::int64_t t_ns,
                                                 std::size_t camera = kMainCamera) const;
  [[nodiscard]] std::optional<EstimateRow> estimate_at(std::size_t estimator,
                                                       std::int64_t t_ns) const;
  /// Row of the first answer stamped after t; empty after the last.
  [[nodiscard]] std::optional<EstimateRow> estimate_after(std::size_t estimator,
                                                          std::int64_t t_ns) const;

  /// The latest images of a live run; empty after it.
  [[nodiscard]] std::optional<StampedImage> live_camera(std::size_t camera = kMainCamera) const;
  [[nodiscard]] std::optional<StampedImage> live_debug(std::size_t estimator) const;
  /// The latest sparse map points, world frame.
  [[nodiscard]] std::vector<Eigen::Vector3f> live_points(std::size_t estimator) const;

  /// The viewers.
  [[nodiscard]] const std::shared_ptr<Audience>& audience() const { return audience_; }

  /// State, latency and resource use of each estimator.
  [[nodiscard]] std::vector<EstimatorStatus> statuses() const;

  /// Increases with every change.
  [[nodiscard]] std::uint64_t revision() const;
  /// Waits until revision() differs from `seen`, or for the timeout. @return revision()
  std::uint64_t wait_for_change(std::uint64_t seen, std::int64_t timeout_ms) const;

  // Written by the run.
  // @pre !cameras.empty(), and there are no frames yet
  void set_cameras(std::vector<RunCamera> cameras);
  void set_manifest_stamp(const FileStamp& stamp);
  void set_info(const RunInfo& info);
  /// Changes parts of it, while no other thread does: `change` must not use the timeline.
  void change_info(const std::function<void(RunInfo&)>& change);
  void append_frame(const FrameRow& row, std::size_t camera = kMainCamera);
  /// @param counters  of the answer, by name; at most kMaxCounters different ones are kept
  void append_estimate(std::size_t estimator,
                       EstimateRow row,
                       const std::map<std::string, double>& counters = {});
  void append_log(const LogRow& row);
  void append_vehicle_status(const VehicleStatus& status);
  void set_status(std::size_t estimator, const EstimatorStatus& status);
  /// Keeps what metrics.json contains; errors of single poses would occupy memory as long as the
  /// run is viewed.
  void set_metrics(RunMetrics metrics);
  void set_live_camera(StampedImage image, std::size_t camera = kMainCamera);
  void set_live_debug(std::size_t estimator, StampedImage image);
  void set_live_points(std::size_t estimator, std::vector<Eigen::Vector3f> points_world);

 private:
  struct EstimatorRows {
    std::vector<EstimateRow> rows;
    std::vector<std::string> counter_names;
    bool states_covariances = false;
    EstimatorStatus status;
    std::optional<StampedImage> debug;
    std::vector<Eigen::Vector3f> points;
  };
  struct CameraRows {
    RunCamera camera;
    std::vector<FrameRow> rows;
    std::optional<StampedImage> live;
  };
  void changed();

  const std::shared_ptr<Audience> audience_ = std::make_shared<Audience>();
  mutable std::mutex mutex_;
  mutable std::condition_variable changed_;
  std::uint64_t revision_ = 0;
  RunInfo info_;
  FileStamp manifest_stamp_;
  std::vector<std::string> estimators_;
  std::vector<CameraRows> cameras_;
  std::shared_ptr<const RunMetrics> metrics_;
  std::vector<EstimatorRows> estimates_;
  std::vector<LogRow> logs_;
  std::vector<VehicleStatus> vehicle_statuses_;
};

}  // namespace overfly::server
