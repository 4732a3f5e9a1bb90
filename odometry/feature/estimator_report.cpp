// What the estimator reports about a frame.
#include "odometry/feature/debug_view.hpp"
#include "odometry/feature/estimator.hpp"
#include "odometry/shell/stage_stopwatch.hpp"

namespace overfly::odometry::feature {

void FeatureOdometry::report(const FrameImage& frame,
                             const Outcome& outcome,
                             VoEstimate& estimate) {
  estimate.sample.state = state_;
  estimate.sample.map_id = map_id_;
  if (state_ == TrackingState::kTracking) report_pose(outcome, estimate);
  const Map& map = this->map();
  if (outcome.keyframe) {
    const std::size_t old_bytes = old_map_ ? old_map_->map.memory_bytes() : 0;
    map_memory_mb_ = 1e-6 * static_cast<double>(parts_->keeper.memory_bytes() + old_bytes);
  }
  estimate.counters["searched"] = outcome.tracked.searched;
  estimate.counters["inliers"] = static_cast<double>(outcome.tracked.points.size());
  estimate.counters["residual_px"] = outcome.tracked.rms_px;
  estimate.counters["keyframes"] = map.keyframes().empty() ? 0.0 : map.newest().id + 1.0;
  estimate.counters["map_points"] = static_cast<double>(map.points().size());
  estimate.counters["map_memory_mb"] = map.keyframes().empty() ? 0.0 : map_memory_mb_;
  estimate.counters["keyframe"] = outcome.keyframe ? 1.0 : 0.0;
  if (debug_) draw(frame, outcome, estimate);
}

void FeatureOdometry::report_pose(const Outcome& outcome, VoEstimate& estimate) const {
  std::vector<Eigen::Vector3d> points;
  for (const TrackedPoint& seen : outcome.tracked.points) {
    const MapPoint* point = map().point(seen.point);
    if (point != nullptr) points.push_back(point->position_vo);
  }
  estimate.sample.T_vo_camera = T_camera_vo_.inverse();
  estimate.sample.T_vo_camera.translation *= scale();
  estimate.sample.scene_depth = axis_depth(T_camera_vo_, points);
  if (estimate.sample.scene_depth) *estimate.sample.scene_depth *= scale();
  if (!debug_) return;
  for (const Eigen::Vector3d& p : points) {
    estimate.map_points_vo.push_back((scale() * p).cast<float>());
  }
}

void FeatureOdometry::draw(const FrameImage& frame,
                           const Outcome& outcome,
                           VoEstimate& estimate) const {
  const StageStopwatch stopwatch(estimate.timing_ms, "debug_view");
  DebugContent content;
  content.state = state_;
  content.keyframe = outcome.keyframe;
  content.map_id = map_id_;
  content.keyframes = static_cast<int>(estimate.counters["keyframes"]);
  if (parameters_.threads > 1) content.timing_ms = &estimate.timing_ms;
  if (state_ == TrackingState::kTracking) {
    content.tracked = &outcome.tracked;
    for (const int id : outcome.tracked.missed) {
      const MapPoint* point = map().point(id);
      const auto pixel = point ? camera_.project(T_camera_vo_ * point->position_vo) : std::nullopt;
      if (pixel) content.missed_px.push_back(*pixel);
    }
    if (outcome.keyframe) {
      for (const Candidate& candidate : map().newest().candidates) {
        content.candidates_px.push_back(candidate.corner.pixel);
      }
    }
  }
  if (state_ == TrackingState::kInitialising) content.followed = &parts_->initialiser.tracks();
  estimate.debug_image = draw_debug_view(frame.pyramid, content);
}

}  // namespace overfly::odometry::feature
