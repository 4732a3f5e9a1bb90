#include "server/timeline/run_timeline.hpp"

#include <algorithm>
#include <chrono>
#include <limits>
#include <utility>

namespace overfly::server {
namespace {

template <typename Row>
std::vector<Row> slice(const std::vector<Row>& rows, std::size_t first, std::size_t limit) {
  if (first >= rows.size()) return {};
  const std::size_t count = std::min(limit, rows.size() - first);
  const auto begin = rows.begin() + static_cast<std::ptrdiff_t>(first);
  return {begin, begin + static_cast<std::ptrdiff_t>(count)};
}

/// The last row stamped at or before t.
template <typename Row, typename Stamp>
std::optional<Row> last_at(const std::vector<Row>& rows, std::int64_t t_ns, Stamp stamp) {
  const auto after =
      std::upper_bound(rows.begin(), rows.end(), t_ns, [&](std::int64_t t, const Row& row) {
        return t < stamp(row);
      });
  if (after == rows.begin()) return std::nullopt;
  return *std::prev(after);
}

}  // namespace

RunTimeline::RunTimeline(RunInfo info, std::vector<std::string> estimators)
    : info_(std::move(info)),
      estimators_(std::move(estimators)),
      cameras_(1),
      estimates_(estimators_.size()) {}

RunInfo RunTimeline::info() const {
  const std::lock_guard lock(mutex_);
  return info_;
}

std::vector<RunCamera> RunTimeline::cameras() const {
  const std::lock_guard lock(mutex_);
  std::vector<RunCamera> cameras;
  for (const CameraRows& entry : cameras_) cameras.push_back(entry.camera);
  return cameras;
}

Result<std::size_t> RunTimeline::camera_index(const std::string& name) const {
  if (name.empty()) return std::size_t{kMainCamera};
  const std::lock_guard lock(mutex_);
  for (std::size_t i = 0; i < cameras_.size(); ++i) {
    if (cameras_[i].camera.name == name) return i;
  }
  return Error{ErrorCode::kNotFound, "camera \"" + name + "\": the run has none of that name"};
}

RunCamera RunTimeline::main_camera() const {
  const std::lock_guard lock(mutex_);
  return cameras_.at(kMainCamera).camera;
}

FileStamp RunTimeline::manifest_stamp() const {
  const std::lock_guard lock(mutex_);
  return manifest_stamp_;
}

std::shared_ptr<const RunMetrics> RunTimeline::metrics() const {
  const std::lock_guard lock(mutex_);
  return metrics_;
}

std::vector<FrameRow> RunTimeline::frames(std::size_t first,
                                          std::size_t limit,
                                          std::size_t camera) const {
  const std::lock_guard lock(mutex_);
  return slice(cameras_.at(camera).rows, first, limit);
}

std::vector<EstimateRow> RunTimeline::estimates(std::size_t estimator,
                                                std::size_t first,
                                                std::size_t limit) const {
  const std::lock_guard lock(mutex_);
  return slice(estimates_.at(estimator).rows, first, limit);
}

std::vector<LogRow> RunTimeline::logs(std::size_t first, std::size_t limit) const {
  const std::lock_guard lock(mutex_);
  return slice(logs_, first, limit);
}

std::vector<VehicleStatus> RunTimeline::vehicle_statuses(std::size_t first,
                                                         std::size_t limit) const {
  const std::lock_guard lock(mutex_);
  return slice(vehicle_statuses_, first, limit);
}

std::size_t RunTimeline::frame_count(std::size_t camera) const {
  const std::lock_guard lock(mutex_);
  return cameras_.at(camera).rows.size();
}

std::size_t RunTimeline::estimate_count(std::size_t estimator) const {
  const std::lock_guard lock(mutex_);
  return estimates_.at(estimator).rows.size();
}

std::size_t RunTimeline::log_count() const {
  const std::lock_guard lock(mutex_);
  return logs_.size();
}

std::vector<std::string> RunTimeline::counter_names(std::size_t estimator) const {
  const std::lock_guard lock(mutex_);
  return estimates_.at(estimator).counter_names;
}

bool RunTimeline::states_covariances(std::size_t estimator) const {
  const std::lock_guard lock(mutex_);
  return estimates_.at(estimator).states_covariances;
}

std::optional<FrameRow> RunTimeline::frame_at(std::int64_t t_ns, std::size_t camera) const {
  const std::lock_guard lock(mutex_);
  return last_at(cameras_.at(camera).rows, t_ns, [](const FrameRow& row) { return row.t_ns; });
}

std::optional<EstimateRow> RunTimeline::estimate_at(std::size_t estimator,
                                                    std::int64_t t_ns) const {
  const std::lock_guard lock(mutex_);
  return last_at(
      estimates_.at(estimator).rows, t_ns, [](const EstimateRow& row) { return row.sample.t_ns; });
}

std::optional<EstimateRow> RunTimeline::estimate_after(std::size_t estimator,
                                                       std::int64_t t_ns) const {
  const std::lock_guard lock(mutex_);
  const auto& rows = estimates_.at(estimator).rows;
  const auto after =
      std::upper_bound(rows.begin(), rows.end(), t_ns, [](std::int64_t t, const EstimateRow& row) {
        return t < row.sample.t_ns;
      });
  return after == rows.end() ? std::nullopt : std::optional(*after);
}

std::optional<StampedImage> RunTimeline::live_camera(std::size_t camera) const {
  const std::lock_guard lock(mutex_);
  return cameras_.at(camera).live;
}

std::optional<StampedImage> RunTimeline::live_debug(std::size_t estimator) const {
  const std::lock_guard lock(mutex_);
  return estimates_.at(estimator).debug;
}

std::vector<Eigen::Vector3f> RunTimeline::live_points(std::size_t estimator) const {
  const std::lock_guard lock(mutex_);
  return estimates_.at(estimator).points;
}

std::vector<EstimatorStatus> RunTimeline::statuses() const {
  const std::lock_guard lock(mutex_);
  std::vector<EstimatorStatus> statuses;
  statuses.reserve(estimates_.size());
  for (const EstimatorRows& rows : estimates_) statuses.push_back(rows.status);
  return statuses;
}

std::uint64_t RunTimeline::revision() const {
  const std::lock_guard lock(mutex_);
  return revision_;
}

std::uint64_t RunTimeline::wait_for_change(std::uint64_t seen, std::int64_t timeout_ms) const {
  std::unique_lock lock(mutex_);
  changed_.wait_for(lock, std::chrono::milliseconds(timeout_ms), [&] { return revision_ != seen; });
  return revision_;
}

void RunTimeline::changed() {
  ++revision_;
  changed_.notify_all();
}

void RunTimeline::set_cameras(std::vector<RunCamera> cameras) {
  const std::lock_guard lock(mutex_);
  cameras_.clear();
  for (RunCamera& camera : cameras) cameras_.push_back({std::move(camera), {}, {}});
  changed();
}

void RunTimeline::set_manifest_stamp(const FileStamp& stamp) {
  const std::lock_guard lock(mutex_);
  manifest_stamp_ = stamp;
}

void RunTimeline::set_info(const RunInfo& info) {
  change_info([&](RunInfo& changed) { changed = info; });
}

void RunTimeline::change_info(const std::function<void(RunInfo&)>& change) {
  const std::lock_guard lock(mutex_);
  change(info_);
  const bool live = info_.status == RunStatus::kQueued || info_.status == RunStatus::kRunning;
  if (!live) {
    // Pictures of a run that is over are read from its folder or rendered again.
    for (CameraRows& camera : cameras_) camera.live.reset();
    for (EstimatorRows& rows : estimates_) {
      rows.debug.reset();
      rows.points.clear();
    }
  }
  changed();
}

void RunTimeline::append_frame(const FrameRow& row, std::size_t camera) {
  const std::lock_guard lock(mutex_);
  cameras_.at(camera).rows.push_back(row);
  changed();
}

void RunTimeline::append_estimate(std::size_t estimator,
                                  EstimateRow row,
                                  const std::map<std::string, double>& counters) {
  const std::lock_guard lock(mutex_);
  EstimatorRows& own = estimates_.at(estimator);
  for (const auto& [name, value] : counters) {
    const auto known = std::find(own.counter_names.begin(), own.counter_names.end(), name);
    const auto index = static_cast<std::size_t>(known - own.counter_names.begin());
    if (index >= kMaxCounters) continue;
    if (known == own.counter_names.end()) own.counter_names.push_back(name);
    if (row.counters.size() <= index) {
      row.counters.resize(index + 1, std::numeric_limits<double>::quiet_NaN());
    }
    row.counters[index] = value;
  }
  if (row.sample.covariance) own.states_covariances = true;
  own.rows.push_back(std::move(row));
  changed();
}

void RunTimeline::append_log(const LogRow& row) {
  const std::lock_guard lock(mutex_);
  logs_.push_back(row);
  changed();
}

void RunTimeline::append_vehicle_status(const VehicleStatus& status) {
  const std::lock_guard lock(mutex_);
  vehicle_statuses_.push_back(status);
  changed();
}

void RunTimeline::set_status(std::size_t estimator, const EstimatorStatus& status) {
  const std::lock_guard lock(mutex_);
  estimates_.at(estimator).status = status;
  changed();
}

void RunTimeline::set_metrics(RunMetrics metrics) {
  for (auto& [name, estimator] : metrics.estimators) {
    for (auto& [mode, alignment] : estimator.score.alignments) {
      alignment.position_errors_m = std::vector<double>();  // "= {}" would keep the memory
      alignment.rotation_errors_deg = std::vector<double>();
    }
    estimator.score.matched_t_ns = std::vector<std::int64_t>();
  }
  auto shared = std::make_shared<const RunMetrics>(std::move(metrics));
  const std::lock_guard lock(mutex_);
  metrics_ = std::move(shared);
  changed();
}

void RunTimeline::set_live_camera(StampedImage image, std::size_t camera) {
  const std::lock_guard lock(mutex_);
  cameras_.at(camera).live = std::move(image);
  changed();
}

void RunTimeline::set_live_debug(std::size_t estimator, StampedImage image) {
  const std::lock_guard lock(mutex_);
  estimates_.at(estimator).debug = std::move(image);
  changed();
}

void RunTimeline::set_live_points(std::size_t estimator,
                                  std::vector<Eigen::Vector3f> points_world) {
  const std::lock_guard lock(mutex_);
  estimates_.at(estimator).points = std::move(points_world);
  changed();
}

}  // namespace overfly::server
