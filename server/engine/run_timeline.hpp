// A run as a time line: what every view of it reads, while it is being written and after.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/camera_model.hpp"
#include "core/estimate.hpp"
#include "core/image.hpp"
#include "core/pose.hpp"
#include "core/result.hpp"
#include "server/engine/audience.hpp"
#include "server/engine/estimator_status.hpp"
#include "server/engine/file_stamp.hpp"

namespace overfly::engine {

enum class RunStatus {
  kQueued,
  kRunning,
  kCompleted,
  kFailed,
  kCancelled,
  kInterrupted,  ///< its program ended before it did
  kUnreadable,   ///< its folder does not say; RunInfo::problem tells why
};
[[nodiscard]] const char* to_string(RunStatus status);  ///< "queued", "running", ...

/// One camera frame's row.
struct FrameRow {
  std::int64_t frame = 0;
  std::int64_t t_ns = 0;
  Pose T_world_camera;
  Pose T_world_body;
  double texels_per_pixel_median = 0.0;
  double texels_per_pixel_min = 0.0;
  double void_fraction = 0.0;
  std::int64_t exposure_ns = 0;      ///< 0 = not known
  double gain = 1.0;                 ///< of auto-exposure, times the sensor's own
  double saturated_fraction = 0.0;   ///< of the pixels
  int late_tiles = 0;                ///< drawn from coarser ones
  std::int64_t stamp_offset_ns = 0;  ///< of the stamp that estimators were told, less t_ns
  std::vector<std::string> faults;   ///< kinds of those in force
  /// Of the grey image as estimators were sent it; empty where none was.
  std::optional<std::uint32_t> image_crc32;
};

/// One estimator's answer to a frame, in its own frame and, once aligned, in the world.
struct EstimateRow {
  EstimateSample sample;
  std::optional<Pose> T_world_body;  ///< by `init_scale`; empty while not tracking
  double latency_ms = 0.0;
};

struct LogRow {
  std::int64_t t_ns = 0;
  std::string level;  ///< "info", "warning", "error"
  std::string text;
  std::string kind = {};    ///< "fault" where a fault of the scenario begins or ends; else empty
  std::string source = {};  ///< estimator that said it; empty = the range
};

/// A picture that belongs to a frame; shared, never written to after it is made.
struct StampedImage {
  std::int64_t frame = 0;
  std::int64_t t_ns = 0;
  std::shared_ptr<const Image> image;
};

/// What a list of runs shows.
struct RunInfo {
  std::string id;        ///< folder name
  std::string scenario;  ///< name
  std::string title;
  RunStatus status = RunStatus::kQueued;
  std::string created_utc;       ///< ISO 8601
  std::string error;             ///< why it failed; empty otherwise
  std::string problem;           ///< file and field of its folder that are wrong; else empty
  std::int64_t duration_ns = 0;  ///< of the flight, 0 = not known yet
  std::int64_t frames = 0;       ///< done
  std::int64_t frames_total = 0;
  std::string pacing;
  std::vector<std::string> estimators;
  std::vector<std::string> estimator_cameras;  ///< whose images each estimator gets
  std::string attribution;
  std::vector<std::string> cameras;  ///< names, the main one first
  /// The imagery, not the camera, limits the result: fewer than 0.5 texels a pixel (median).
  bool texture_limited = false;
  /// What it is busy with before its first frame ("making the built-in world: 30 %"); empty
  /// otherwise. Of this process only: no file keeps it.
  std::string notice;
  /// Which files of its world have changed since it was flown; empty where none has, and until its
  /// world was opened for a view. Of this process only: no file keeps it.
  std::string world_change;
};

/// One camera of a run.
struct RunCamera {
  std::string name;
  CameraModel model;
  Pose T_body_camera{R_body_camera_nadir(), Eigen::Vector3d::Zero()};
};

/// Thread-safe. Rows are only ever appended and are numbered from 0: a reader asks for the rows
/// from its next number on, so nothing is lost or told twice, live or replayed.
class RunTimeline {
 public:
  explicit RunTimeline(RunInfo info, std::vector<std::string> estimators);
  /// Reads a run folder (complete, failed, or still marked running by a program that is gone:
  /// then its status is kInterrupted). Errors: kNotFound, kUnreadable naming file and line.
  static Result<std::shared_ptr<RunTimeline>> open(const std::filesystem::path& folder);

  [[nodiscard]] RunInfo info() const;
  [[nodiscard]] const std::vector<std::string>& estimators() const { return estimators_; }
  /// The cameras, the main one first; there is always one.
  [[nodiscard]] std::vector<RunCamera> cameras() const;
  /// Index of a camera by its name; empty name = the main one. Errors: kNotFound naming it.
  [[nodiscard]] Result<std::size_t> camera_index(const std::string& name) const;
  /// Main camera of the run and its mount.
  [[nodiscard]] PinholeCamera camera() const;
  [[nodiscard]] Pose T_body_camera() const;
  /// Of the manifest that this was read from or written to; none while the run goes on.
  [[nodiscard]] FileStamp manifest_stamp() const;
  /// Empty object until the run is scored.
  [[nodiscard]] nlohmann::json metrics() const;

  /// Copies rows [first, first + at most `limit`); of the main camera where none is named.
  [[nodiscard]] std::vector<FrameRow> frames(std::size_t first,
                                             std::size_t limit,
                                             std::size_t camera = 0) const;
  [[nodiscard]] std::vector<EstimateRow> estimates(std::size_t estimator,
                                                   std::size_t first,
                                                   std::size_t limit) const;
  [[nodiscard]] std::vector<LogRow> logs(std::size_t first, std::size_t limit) const;
  [[nodiscard]] std::size_t frame_count() const;
  [[nodiscard]] std::size_t estimate_count(std::size_t estimator) const;
  /// Row of the last frame stamped at or before t; empty before the first.
  [[nodiscard]] std::optional<FrameRow> frame_at(std::int64_t t_ns, std::size_t camera = 0) const;
  [[nodiscard]] std::optional<EstimateRow> estimate_at(std::size_t estimator,
                                                       std::int64_t t_ns) const;

  /// The newest pictures of a live run; empty after it.
  [[nodiscard]] std::optional<StampedImage> live_camera(std::size_t camera = 0) const;
  [[nodiscard]] std::optional<StampedImage> live_debug(std::size_t estimator) const;
  /// Sparse map points seen last, world frame.
  [[nodiscard]] std::vector<Eigen::Vector3f> live_points(std::size_t estimator) const;

  /// Who watches it.
  [[nodiscard]] const std::shared_ptr<Audience>& audience() const { return audience_; }

  /// How each estimator fares.
  [[nodiscard]] std::vector<EstimatorStatus> statuses() const;

  /// Grows with every change.
  [[nodiscard]] std::uint64_t revision() const;
  /// Waits until revision() differs from `seen`, or the timeout. @return revision()
  std::uint64_t wait_for_change(std::uint64_t seen, std::int64_t timeout_ms) const;

  // The writer's side: the run that feeds it.
  /// @pre !cameras.empty(), and no frame is there yet
  void set_cameras(std::vector<RunCamera> cameras);
  void set_camera(const PinholeCamera& camera, const Pose& T_body_camera);  ///< the only one
  void set_manifest_stamp(const FileStamp& stamp);
  void set_info(const RunInfo& info);
  void append_frame(const FrameRow& row, std::size_t camera = 0);
  void append_estimate(std::size_t estimator, const EstimateRow& row);
  void append_log(const LogRow& row);
  void set_status(std::size_t estimator, const EstimatorStatus& status);
  void set_metrics(nlohmann::json metrics);
  void set_live_camera(StampedImage image, std::size_t camera = 0);
  void set_live_debug(std::size_t estimator, StampedImage image);
  void set_live_points(std::size_t estimator, std::vector<Eigen::Vector3f> points_world);

 private:
  struct EstimatorRows {
    std::vector<EstimateRow> rows;
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
  nlohmann::json metrics_ = nlohmann::json::object();
  std::vector<EstimatorRows> estimates_;
  std::vector<LogRow> logs_;
};

}  // namespace overfly::engine
