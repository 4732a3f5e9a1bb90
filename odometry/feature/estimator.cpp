#include "odometry/feature/estimator.hpp"

#include <algorithm>
#include <cstring>
#include <iomanip>
#include <sstream>
#include <utility>

#include "odometry/feature/debug_view.hpp"
#include "odometry/feature/stopwatch.hpp"

namespace overfly::odometry {
namespace {

constexpr double kGiveUpS = 3.0;
/// A map of so few keyframes is not worth finding again.
constexpr int kYoungMap = 6;
/// For so long after a loss the prediction is still tried.
constexpr double kExtrapolateS = 1.5;
/// Images that repeat while the camera should have moved by more than this show nothing new.
constexpr double kFrozenMotionPx = 0.3;
constexpr int kMinCornersToSearch = 100;
/// Corners a frame is asked for, per point that is tracked in it.
constexpr double kFeaturesPerPoint = 2.0;

int tracked_points(const FeatureParameters& parameters) {
  return std::max(100, static_cast<int>(parameters.features / kFeaturesPerPoint));
}

TrackerOptions tracker_options(const FeatureParameters& parameters, const Rectifier& rectifier) {
  TrackerOptions options;
  options.seen = rectifier.seen();
  options.max_points = tracked_points(parameters);
  return options;
}

InitialiserOptions initialiser_options(const FeatureParameters& parameters) {
  InitialiserOptions options;
  options.seed = parameters.seed;
  options.min_tracks = std::min(options.min_tracks, parameters.features / 2);
  return options;
}

MapperOptions mapper_options(const FeatureParameters& parameters) {
  MapperOptions options;
  options.cells = tracked_points(parameters);
  return options;
}

}  // namespace

FeatureOdometry::Parts::Parts(const CameraModel& camera, const FeatureParameters& parameters)
    : rectifier(camera),
      initialiser(camera.pinhole(), initialiser_options(parameters)),
      tracker(camera.pinhole(), tracker_options(parameters, rectifier)),
      mapper(camera.pinhole(), mapper_options(parameters)) {}

FeatureOdometry::FeatureOdometry(const FeatureParameters& parameters)
    : parameters_(parameters), orb_(parameters) {}

std::map<std::string, std::string> FeatureOdometry::effective_parameters() const {
  std::ostringstream scale;
  scale << parameters_.scale_factor;
  return {{"features", std::to_string(parameters_.features)},
          {"scale_factor", scale.str()},
          {"levels", std::to_string(parameters_.levels)},
          {"ini_fast_threshold", std::to_string(parameters_.ini_fast_threshold)},
          {"min_fast_threshold", std::to_string(parameters_.min_fast_threshold)},
          {"seed", std::to_string(parameters_.seed)}};
}

void FeatureOdometry::reset() {
  const bool debug = debug_;
  *this = FeatureOdometry(parameters_);
  debug_ = debug;
}

void FeatureOdometry::start_over() {
  map_.clear();
  motion_.reset();
  parts_->initialiser.reset();
  state_ = TrackingState::kInitialising;
  ++map_id_;
}

Result<VoEstimate> FeatureOdometry::track(const VoFrame& frame) {
  if (Status status = validate_vo_frame(frame, previous_ ? &*previous_ : nullptr); !status) {
    return status.error();
  }
  if (!parts_) {
    camera_ = frame.intrinsics;
    parts_ = std::make_unique<Parts>(CameraModel(camera_, frame.distortion), parameters_);
    orb_.look_only_at(parts_->rectifier.seen());
  }
  VoEstimate estimate;
  Outcome outcome;
  {
    const Stopwatch stopwatch(estimate.timing_ms, "total");
    FrameImage image{frame.index, frame.t_ns, {}};
    {
      const Stopwatch pyramid_watch(estimate.timing_ms, "pyramid");
      image.pyramid = build_pyramid(parts_->rectifier.rectify(frame.image));
    }
    const bool repeated = previous_ && previous_->image->data == frame.image->data;
    const double expected_px =
        (motion_.rate_rad_s() + motion_.speed()) * camera_.fx_px *
        (previous_ ? static_cast<double>(frame.t_ns - previous_->t_ns) * 1e-9 : 0.0);
    const bool frozen = repeated && expected_px > kFrozenMotionPx;
    if (state_ == TrackingState::kInitialising) {
      if (!repeated) initialise(image, estimate, outcome);
    } else if (frozen) {
      if (state_ == TrackingState::kTracking) lose();
    } else if (state_ == TrackingState::kTracking) {
      follow(image, estimate, outcome);
    } else {
      search(image, estimate, outcome);
    }
    estimate.sample.frame = frame.index;
    estimate.sample.t_ns = frame.t_ns;
    report(image, outcome, estimate);
  }
  previous_ = frame;
  return estimate;
}

void FeatureOdometry::initialise(const FrameImage& frame, VoEstimate& estimate, Outcome& outcome) {
  const Stopwatch stopwatch(estimate.timing_ms, "initialisation");
  if (!parts_->initialiser.process(frame, orb_, map_)) return;
  for (const auto& [id, keyframe] : map_.keyframes()) {
    motion_.observe(keyframe.t_ns, keyframe.T_camera_vo);
  }
  parts_->mapper.add_candidates(orb_, map_);
  const Keyframe& newest = map_.newest();
  T_camera_vo_ = newest.T_camera_vo;
  for (const Observation& seen : newest.observations) {
    outcome.tracked.points.push_back({seen.point, seen.pixel, seen.sigma_px});
  }
  outcome.keyframe = true;
  state_ = TrackingState::kTracking;
}

TrackResult FeatureOdometry::track_map(const FrameImage& frame) const {
  // From the prediction; then with a wider search; then as if a turn had just stopped.
  TrackResult result = parts_->tracker.track(frame.pyramid, motion_.predict(frame.t_ns), 3, map_);
  if (!result.tracked) {
    result =
        parts_->tracker.track(frame.pyramid, motion_.predict(frame.t_ns), kPyramidLevels, map_);
  }
  if (!result.tracked) {
    result = parts_->tracker.track(
        frame.pyramid, motion_.predict_unturned(frame.t_ns), kPyramidLevels, map_);
  }
  return result;
}

void FeatureOdometry::follow(const FrameImage& frame, VoEstimate& estimate, Outcome& outcome) {
  {
    const Stopwatch stopwatch(estimate.timing_ms, "tracking");
    outcome.tracked = track_map(frame);
  }
  if (!outcome.tracked.tracked) {
    lose();
    return;
  }
  accept(frame, estimate, outcome);
}

void FeatureOdometry::accept(const FrameImage& frame, VoEstimate& estimate, Outcome& outcome) {
  count_sights(outcome.tracked);
  T_camera_vo_ = outcome.tracked.T_camera_vo;
  if (parts_->mapper.wants_keyframe(frame, outcome.tracked, map_)) {
    const Stopwatch stopwatch(estimate.timing_ms, "mapping");
    parts_->mapper.insert_keyframe(frame, outcome.tracked, orb_, map_, estimate.timing_ms);
    T_camera_vo_ = map_.newest().T_camera_vo;
    outcome.keyframe = true;
  }
  motion_.observe(frame.t_ns, T_camera_vo_);
  state_ = TrackingState::kTracking;
}

void FeatureOdometry::count_sights(const TrackResult& tracked) {
  const auto count = [&](int id, bool found) {
    MapPoint* point = map_.point(id);
    if (point == nullptr) return;
    ++point->expected;
    if (found) ++point->found;
  };
  for (const TrackedPoint& seen : tracked.points) count(seen.point, true);
  for (const TrackedPoint& seen : tracked.outliers) count(seen.point, false);
  for (const int id : tracked.missed) count(id, false);
}

void FeatureOdometry::lose() {
  state_ = TrackingState::kLost;
  lost_at_ns_ = previous_->t_ns;
  blind_search_s_ = 0.0;
  if (static_cast<int>(map_.keyframes().size()) < kYoungMap) start_over();
}

void FeatureOdometry::search(const FrameImage& frame, VoEstimate& estimate, Outcome& outcome) {
  const Stopwatch stopwatch(estimate.timing_ms, "relocalisation");
  const double lost_s = static_cast<double>(frame.t_ns - lost_at_ns_) * 1e-9;
  if (lost_s < kExtrapolateS) outcome.tracked = track_map(frame);
  if (!outcome.tracked.tracked) {
    RelocaliserOptions options;
    options.seed = parameters_.seed + static_cast<std::uint64_t>(frame.index);
    const Relocalisation found = relocalise(camera_, options, frame.pyramid.level(0), orb_, map_);
    estimate.counters["relocalisation_matches"] = found.matches;
    if (found.corners >= kMinCornersToSearch) {
      blind_search_s_ += static_cast<double>(frame.t_ns - previous_->t_ns) * 1e-9;
    }
    if (found.T_camera_vo) {
      outcome.tracked = parts_->tracker.track(frame.pyramid, *found.T_camera_vo, 2, map_);
    }
  }
  if (outcome.tracked.tracked) {
    motion_.reset();
    accept(frame, estimate, outcome);
  } else if (blind_search_s_ > kGiveUpS) {
    start_over();
  }
}

void FeatureOdometry::report(const FrameImage& frame,
                             const Outcome& outcome,
                             VoEstimate& estimate) {
  estimate.sample.state = state_;
  estimate.sample.map_id = map_id_;
  const bool tracking = state_ == TrackingState::kTracking;
  if (tracking) {
    estimate.sample.T_vo_camera = T_camera_vo_.inverse();
    std::vector<Eigen::Vector3d> points;
    for (const TrackedPoint& seen : outcome.tracked.points) {
      const MapPoint* point = map_.point(seen.point);
      if (point != nullptr) points.push_back(point->position_vo);
    }
    estimate.sample.scene_depth = median_depth(T_camera_vo_, points);
    if (debug_) {
      for (const Eigen::Vector3d& p : points) estimate.map_points_vo.push_back(p.cast<float>());
    }
  }
  estimate.counters["searched"] = outcome.tracked.searched;
  estimate.counters["inliers"] = static_cast<double>(outcome.tracked.points.size());
  estimate.counters["residual_px"] = outcome.tracked.rms_px;
  estimate.counters["keyframes"] = static_cast<double>(map_.keyframes().size());
  estimate.counters["map_points"] = static_cast<double>(map_.points().size());
  estimate.counters["keyframe"] = outcome.keyframe ? 1.0 : 0.0;
  if (!debug_) return;
  const Stopwatch stopwatch(estimate.timing_ms, "debug_view");
  DebugContent content;
  content.state = state_;
  content.keyframe = outcome.keyframe;
  content.map_id = map_id_;
  content.keyframes = static_cast<int>(map_.keyframes().size());
  if (tracking) content.tracked = &outcome.tracked;
  if (state_ == TrackingState::kInitialising) content.followed = &parts_->initialiser.tracks();
  estimate.debug_image = draw_debug_view(frame.pyramid, content);
}

Result<std::unique_ptr<VoPort>> create_feature_odometry(const FeatureParameters& parameters) {
  const Result<FeatureParameters> checked = feature_parameters_from({
      {"features", parameters.features},
      {"scale_factor", parameters.scale_factor},
      {"levels", parameters.levels},
      {"ini_fast_threshold", parameters.ini_fast_threshold},
      {"min_fast_threshold", parameters.min_fast_threshold},
  });
  if (!checked) return checked.error();
  return std::unique_ptr<VoPort>(std::make_unique<FeatureOdometry>(parameters));
}

}  // namespace overfly::odometry
