#include "odometry/feature/estimator.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/measure/processor_time.hpp"
#include "odometry/feature/debug_view.hpp"
#include "odometry/shell/stage_stopwatch.hpp"

namespace overfly::odometry::feature {
namespace {

/// An image that repeats although the camera should have moved by more than this is a frozen image.
constexpr double kFrozenMotionPx = 0.3;
/// Number of features requested per frame, relative to the points tracked in it.
constexpr double kFeaturesPerPoint = 2.0;

/// Coarsest level for patches whose finer levels lack texture.
int coarsest_patch_level(const FeatureParameters& parameters) {
  return parameters.low_texture ? 3 : 2;
}

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
  options.planar_start = parameters.planar_start;
  options.coarsest_patch_level = coarsest_patch_level(parameters);
  options.min_tracks = std::min(options.min_tracks, parameters.features / 2);
  options.cells = tracked_points(parameters);
  options.min_cells = std::max(TrackerOptions{}.min_inliers, options.min_tracks / 2);
  return options;
}

DescriptorInitialiserOptions descriptor_initialiser_options(const FeatureParameters& parameters) {
  const InitialiserOptions like = initialiser_options(parameters);
  DescriptorInitialiserOptions options;
  options.seed = like.seed;
  options.planar_start = like.planar_start;
  options.coarsest_patch_level = like.coarsest_patch_level;
  options.scale_factor = parameters.scale_factor;
  options.cells = like.cells;
  // In scenes that are not planar the mapper finds new points with every image.
  options.min_cells = 3 * like.min_cells / 4;
  return options;
}

MapperOptions mapper_options(const FeatureParameters& parameters, const Rectifier& rectifier) {
  MapperOptions options;
  options.cells = tracked_points(parameters);
  options.scale_factor = parameters.scale_factor;
  options.coarsest_patch_level = coarsest_patch_level(parameters);
  options.seen = rectifier.seen();
  return options;
}

}  // namespace

FeatureOdometry::Parts::Parts(const CameraModel& camera, const FeatureParameters& parameters)
    : rectifier(camera),
      initialiser(camera.pinhole(), initialiser_options(parameters)),
      descriptor_initialiser(camera.pinhole(), descriptor_initialiser_options(parameters)),
      tracker(camera.pinhole(), tracker_options(parameters, rectifier)),
      keeper(camera.pinhole(), mapper_options(parameters, rectifier), parameters) {}

FeatureOdometry::FeatureOdometry(const FeatureParameters& parameters)
    : parameters_(parameters), orb_(parameters), known_height_m_(parameters.initial_height_m) {}

std::map<std::string, std::string> FeatureOdometry::effective_parameters() const {
  return texts_of(parameters_);
}

FrameImage FeatureOdometry::image_of(const VoFrame& frame) const {
  return {frame.index,
          frame.t_ns,
          build_pyramid(parts_->rectifier.rectify(frame.image), parameters_.reject_saturated)};
}

/// Whether the image repeats although the camera should have moved.
bool FeatureOdometry::frozen(const VoFrame& frame, bool repeated) const {
  if (!repeated || state_ == TrackingState::kInitialising) return false;
  const double dt_s = static_cast<double>(frame.t_ns - previous_->t_ns) * 1e-9;
  return (motion_.rate_rad_s() + motion_.speed()) * camera_.fx_px * dt_s > kFrozenMotionPx;
}

std::optional<ResourceUse> FeatureOdometry::resource_use() const {
  return ResourceUse{account_.cpu_s(), account_.peak_memory_mb(), false};
}

Result<VoEstimate> FeatureOdometry::track(const VoFrame& frame) {
  const double before_s = thread_cpu_s();
  Result<VoEstimate> estimate = answer(frame);
  double used_s = thread_cpu_s() - before_s;
  if (parts_) used_s += parts_->keeper.take_cpu_s();
  account_.add_cpu_s(used_s);
  account_.note_memory_mb(map_memory_mb_);
  return estimate;
}

Result<VoEstimate> FeatureOdometry::answer(const VoFrame& frame) {
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
    const StageStopwatch stopwatch(estimate.timing_ms, "total");
    FrameImage image;
    {
      const StageStopwatch pyramid_watch(estimate.timing_ms, "pyramid");
      image = image_of(frame);
    }
    const bool repeated = previous_ && previous_->image->data == frame.image->data;
    parts_->keeper.refresh();
    for (std::string& line : parts_->keeper.take_warnings()) log_.add(std::move(line));
    if (rejoin_old_map(image, estimate, outcome)) {
      // The old map continues with this frame.
    } else if (state_ == TrackingState::kInitialising) {
      if (!repeated) initialise(image, estimate, outcome);
    } else if (frozen(frame, repeated)) {
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

/// Tracked corners give the better map; descriptors are used where tracking fails.
bool FeatureOdometry::make_first_map(const FrameImage& frame) {
  Map& first = parts_->keeper.empty_map();
  if (!parts_->initialiser.process(frame, orb_, first)) {
    const auto& given_up = parts_->initialiser.given_up();
    if (!given_up) return false;
    parts_->descriptor_initialiser.remember(*given_up, orb_);
    if (!parts_->descriptor_initialiser.process(frame, orb_, first)) return false;
  }
  parts_->initialiser.reset();
  parts_->descriptor_initialiser.reset();
  return true;
}

void FeatureOdometry::initialise(const FrameImage& frame, VoEstimate& estimate, Outcome& outcome) {
  const StageStopwatch stopwatch(estimate.timing_ms, "initialisation");
  if (!make_first_map(frame)) return;
  for (const auto& [id, keyframe] : parts_->keeper.empty_map().keyframes()) {
    motion_.observe(keyframe.t_ns, keyframe.T_camera_vo);
  }
  parts_->keeper.begin();
  find_scale();
  const Keyframe& newest = map().newest();
  T_camera_vo_ = newest.T_camera_vo;
  for (const Observation& seen : newest.observations) {
    outcome.tracked.points.push_back({seen.point, seen.pixel, seen.sigma_px});
  }
  outcome.keyframe = true;
  state_ = TrackingState::kTracking;
}

Pose FeatureOdometry::predicted(std::int64_t t_ns) const {
  return parameters_.rotation_compensation ? motion_.predict(t_ns) : motion_.predict_unturned(t_ns);
}

TrackResult FeatureOdometry::track_map(const FrameImage& frame) const {
  // Try the prediction first; then without the coarse search, which fails on blurred ground; then
  // with a wider coarse search; then as if a turn had just stopped.
  const Tracker& tracker = parts_->tracker;
  TrackResult result = tracker.track(frame.pyramid, predicted(frame.t_ns), 3, map());
  if (!result.tracked && parameters_.low_texture) {
    result = tracker.track(frame.pyramid, predicted(frame.t_ns), 0, map());
  }
  if (!result.tracked) {
    result = tracker.track(frame.pyramid, predicted(frame.t_ns), kPyramidLevels, map());
  }
  if (!result.tracked && parameters_.rotation_compensation) {
    result =
        tracker.track(frame.pyramid, motion_.predict_unturned(frame.t_ns), kPyramidLevels, map());
  }
  return result;
}

void FeatureOdometry::follow(const FrameImage& frame, VoEstimate& estimate, Outcome& outcome) {
  {
    const StageStopwatch stopwatch(estimate.timing_ms, "tracking");
    outcome.tracked = track_map(frame);
  }
  if (!outcome.tracked.tracked) {
    lose();
    return;
  }
  accept(frame, estimate, outcome);
}

void FeatureOdometry::accept(const FrameImage& frame, VoEstimate& estimate, Outcome& outcome) {
  MapKeeper& keeper = parts_->keeper;
  keeper.note_sights(outcome.tracked);
  T_camera_vo_ = outcome.tracked.T_camera_vo;
  if (keeper.wants_keyframe(frame, outcome.tracked)) {
    T_camera_vo_ = keeper.insert_keyframe(frame, outcome.tracked, estimate.timing_ms);
    outcome.keyframe = true;
  }
  keeper.take_timing(estimate.timing_ms);
  motion_.observe(frame.t_ns, T_camera_vo_);
  state_ = TrackingState::kTracking;
}

double most_bytes_per_px(const FeatureParameters& parameters) {
  constexpr double kPyramid = 4.0 / 3.0 + 1.0 / (kBurntCellPx * kBurntCellPx);
  constexpr double kRectifier = 9.0;
  // The present and the previous image, one that is being mapped, and one about to be dropped.
  constexpr int kPassing = 4;
  const MapperOptions mapper;
  const InitialiserOptions tracks;
  const DescriptorInitialiserOptions descriptors;
  // Next to the old map there is a new one, or what it is to be made of.
  const int first_images =
      2 + tracks.max_snapshots + descriptors.references * (1 + descriptors.views);
  const int images = mapper.images_kept + std::max(mapper.images_kept, first_images) + kPassing;
  double levels = 0.0;
  for (int level = 0; level < parameters.levels; ++level) {
    levels += std::pow(parameters.scale_factor, -2.0 * level);
  }
  // Of the corners' levels each of the two extractors has an image, a smoothed one and a mask.
  return images * kPyramid + 2.0 * 3.0 * levels + kRectifier;
}

Result<std::unique_ptr<VoPort>> create_feature_odometry(const FeatureParameters& parameters) {
  const Result<FeatureParameters> checked = feature_parameters_from(values_of(parameters));
  if (!checked) return checked.error();
  return std::unique_ptr<VoPort>(std::make_unique<FeatureOdometry>(parameters));
}

}  // namespace overfly::odometry::feature
