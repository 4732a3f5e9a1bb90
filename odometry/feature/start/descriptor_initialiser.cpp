#include "odometry/feature/start/descriptor_initialiser.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "odometry/adjustment/pose_optimiser.hpp"
#include "odometry/feature/surface_patch.hpp"

namespace overfly::odometry::feature {
namespace {

/// Search radius around a corner's predicted position, as a fraction of the image's width.
constexpr double kSearchShare = 0.12;
/// Median displacement below which a reference is still up to date, as a fraction of the focal
/// length.
constexpr double kStillShare = 0.02;
/// Noise of a corner matched by descriptors, at the finest level [px].
constexpr double kMatchSigmaPx = 1.5;
/// Points with less parallax have too uncertain a depth for the map.
constexpr double kLeastPointParallaxRad = 0.012;
/// Maximum offset of a patch from the position that the motion predicts, at the patch's level [px].
constexpr double kMaxRefinementPx = 5.0;

/// Minimum parallax, in multiples of a corner's noise.
constexpr double kParallaxSigmas = 8.0;
constexpr int kMostMisses = 5;

/// Median of each coordinate; zero for an empty set.
Eigen::Vector2d median_offset(const std::vector<Eigen::Vector2d>& values) {
  Eigen::Vector2d median = Eigen::Vector2d::Zero();
  if (values.empty()) return median;
  const auto middle = static_cast<std::ptrdiff_t>(values.size() / 2);
  std::vector<double> sorted(values.size());
  for (int axis = 0; axis < 2; ++axis) {
    std::transform(values.begin(), values.end(), sorted.begin(), [axis](const Eigen::Vector2d& v) {
      return v[axis];
    });
    std::nth_element(sorted.begin(), sorted.begin() + middle, sorted.end());
    median[axis] = sorted[static_cast<std::size_t>(middle)];
  }
  return median;
}

double seconds_between(const FrameImage& a, const FrameImage& b) {
  return static_cast<double>(b.t_ns - a.t_ns) * 1e-9;
}

}  // namespace

DescriptorInitialiser::DescriptorInitialiser(const PinholeCamera& camera,
                                             const DescriptorInitialiserOptions& options)
    : camera_(camera), options_(options) {}

bool DescriptorInitialiser::process(const FrameImage& frame, OrbExtractor& orb, Map& map) {
  const DescribedCorners now = describe_image(frame.pyramid.level(0), orb);
  // The search for a motion takes long where there is none to be found, as over noise.
  const bool one_only = tries_ >= options_.full_tries;
  const std::size_t turn =
      references_.empty() ? 0 : static_cast<std::size_t>(tries_) % references_.size();
  for (std::size_t i = 0; i < references_.size(); ++i) {
    if (!compare(references_[i], frame, now, !one_only || i == turn, orb, map)) continue;
    reset();
    return true;
  }
  if (!references_.empty()) ++tries_;
  keep(frame, now);
  return false;
}

void DescriptorInitialiser::reset() {
  references_.clear();
  tries_ = 0;
}

DescriptorInitialiser::Pixels DescriptorInitialiser::match(const Reference& reference,
                                                           const DescribedCorners& now) const {
  MatcherOptions options;
  options.radius_px = kSearchShare * camera_.width_px;
  const auto matches = match_corners(reference.described, now, reference.last, options);
  Pixels pixels(matches.size());
  for (std::size_t i = 0; i < matches.size(); ++i) {
    if (matches[i]) pixels[i] = now.corners[*matches[i]].pixel;
  }
  return pixels;
}

/// Tries to create the map from a reference and this frame, if `try_motion`; otherwise stores the
/// frame as a view.
bool DescriptorInitialiser::compare(Reference& reference,
                                    const FrameImage& frame,
                                    const DescribedCorners& now,
                                    bool try_motion,
                                    OrbExtractor& orb,
                                    Map& map) const {
  View view{frame, match(reference, now)};
  std::vector<std::size_t> matched;
  std::vector<Eigen::Vector2d> steps;
  for (std::size_t i = 0; i < view.pixels.size(); ++i) {
    if (!view.pixels[i]) continue;
    matched.push_back(i);
    steps.emplace_back(*view.pixels[i] - reference.last[i]);
  }
  // Assume that corners not found moved like the others.
  const Eigen::Vector2d usual = median_offset(steps);
  for (std::size_t i = 0; i < view.pixels.size(); ++i) {
    reference.last[i] = view.pixels[i] ? *view.pixels[i] : reference.last[i] + usual;
  }
  if (static_cast<int>(matched.size()) < options_.min_matches) {
    ++reference.misses;
    return false;
  }
  reference.misses = 0;
  std::vector<FirstMapInput> inputs;
  if (try_motion) {
    const double waited_s = seconds_between(reference.frame, frame);
    for (const TwoViewReconstruction& motion : motions(reference, view.pixels, matched, waited_s)) {
      FirstMapInput input = input_of(reference, view, matched, motion);
      if (spread(input)) inputs.push_back(std::move(input));
    }
  }
  if (const auto chosen = choose_first_map(camera_, std::move(inputs))) {
    fill_first_map(camera_, chosen->input, chosen->solved, orb, map);
    return true;
  }
  reference.views.push_back(std::move(view));
  if (static_cast<int>(reference.views.size()) > options_.views) {
    for (std::size_t i = 0; i < reference.views.size(); ++i) {
      reference.views.erase(reference.views.begin() + static_cast<std::ptrdiff_t>(i));
    }
  }
  return false;
}

std::vector<TwoViewReconstruction> DescriptorInitialiser::motions(
    const Reference& reference,
    const Pixels& pixels,
    const std::vector<std::size_t>& matched,
    double waited_s) const {
  std::vector<Eigen::Vector2d> from;
  std::vector<Eigen::Vector2d> to;
  for (const std::size_t i : matched) {
    from.push_back(reference.described.corners[i].pixel);
    to.push_back(*pixels[i]);
  }
  TwoViewOptions options;
  options.sigma_px = kMatchSigmaPx;
  options.min_points = options_.min_points;
  options.min_good_share = 0.4;
  options.parallax_share = 0.33;
  const double told_apart_rad = kParallaxSigmas * kMatchSigmaPx / camera_.fx_px;
  options.min_parallax_rad = std::max(
      told_apart_rad,
      waited_s > options_.patience_s ? options_.least_parallax_rad : options_.min_parallax_rad);
  options.consider_plane = options_.planar_start;
  options.five_point = true;
  options.seed = options_.seed;
  return reconstruct_two_view(camera_, from, to, options);
}

/// The motion's points, with their pixels in all views refined by patch alignment.
FirstMapInput DescriptorInitialiser::input_of(const Reference& reference,
                                              const View& last,
                                              const std::vector<std::size_t>& matched,
                                              const TwoViewReconstruction& motion) const {
  FirstMapInput input;
  input.first = &reference.frame;
  input.last = &last.frame;
  input.T_last_first = motion.T_second_first;
  input.plane = motion.planar;
  std::vector<Pose> T_view_first;
  Pose start;
  for (const View& view : reference.views) {
    std::vector<PoseObservation> observations;
    for (std::size_t m = 0; m < matched.size(); ++m) {
      const auto& pixel = view.pixels[matched[m]];
      if (motion.good[m] != 0 && pixel) {
        observations.push_back({motion.points_first[m], *pixel, kMatchSigmaPx});
      }
    }
    const PoseFit fit = optimise_pose(camera_, start, observations);
    if (fit.inliers < options_.min_points / 2) continue;
    start = fit.T_camera_vo;
    T_view_first.push_back(start);
    input.between.push_back(&view.frame);
  }
  for (std::size_t m = 0; m < matched.size(); ++m) {
    if (motion.good[m] == 0 || motion.parallaxes_rad[m] < kLeastPointParallaxRad) continue;
    const Corner& corner = reference.described.corners[matched[m]];
    if (reference.frame.pyramid.burnt_at(corner.pixel)) continue;
    const auto level = textured_level(reference.frame.pyramid,
                                      corner.pixel,
                                      patch_level_of(corner.scale_level, options_.scale_factor),
                                      options_.coarsest_patch_level);
    if (!level) continue;
    const SurfacePoint point{
        &reference.frame.pyramid, corner.pixel, motion.points_first[m], *level};
    const auto found = [&](const Pose& T, const FrameImage& frame) -> std::optional<SurfaceMatch> {
      const auto match = align_on_surface(camera_, point, T, frame.pyramid, 1);
      const auto expected = camera_.project(T * point.p_source);
      if (!match || !expected ||
          (match->match.pixel - *expected).norm() > std::ldexp(kMaxRefinementPx, *level)) {
        return std::nullopt;
      }
      return match;
    };
    const auto in_last = found(motion.T_second_first, last.frame);
    if (!in_last) continue;
    FirstMapPoint& first = input.points.emplace_back();
    first.corner = corner;
    first.patch_level = *level;
    first.p_first = point.p_source;
    first.last_pixel = in_last->match.pixel;
    first.normal_first = in_last->normal_source;
    for (std::size_t v = 0; v < T_view_first.size(); ++v) {
      const auto between = found(T_view_first[v], *input.between[v]);
      first.between_pixels.push_back(between ? std::optional(between->match.pixel) : std::nullopt);
    }
  }
  return input;
}

bool DescriptorInitialiser::spread(const FirstMapInput& input) const {
  if (static_cast<int>(input.points.size()) < options_.min_points) return false;
  CellGrid grid = CellGrid::over(camera_.width_px, camera_.height_px, options_.cells);
  for (const FirstMapPoint& point : input.points) grid.marked[grid.index(point.last_pixel)] = 1;
  return std::count(grid.marked.begin(), grid.marked.end(), 1) >= options_.min_cells;
}

/// Makes the frame a reference if the newest is far enough away, and drops references that were not
/// matched for some time.
void DescriptorInitialiser::keep(const FrameImage& frame, const DescribedCorners& now) {
  std::erase_if(references_,
                [](const Reference& reference) { return reference.misses > kMostMisses; });
  if (!references_.empty() && references_.back().misses == 0) {
    const Reference& newest = references_.back();
    if (seconds_between(newest.frame, frame) < options_.reference_s) return;
    std::vector<Eigen::Vector2d> motion_px;
    for (std::size_t i = 0; i < newest.last.size(); ++i) {
      motion_px.emplace_back((newest.last[i] - newest.described.corners[i].pixel).cwiseAbs());
    }
    if (median_offset(motion_px).norm() < kStillShare * camera_.fx_px) return;
  }
  add_reference(frame, now);
}

void DescriptorInitialiser::remember(const FrameImage& frame, OrbExtractor& orb) {
  if (references_.empty()) add_reference(frame, describe_image(frame.pyramid.level(0), orb));
}

void DescriptorInitialiser::add_reference(const FrameImage& frame, const DescribedCorners& now) {
  if (static_cast<int>(now.corners.size()) < options_.min_matches) return;
  Reference& made = references_.emplace_back();
  made.frame = frame;
  made.described = now;
  for (const Corner& corner : now.corners) made.last.push_back(corner.pixel);
  if (static_cast<int>(references_.size()) > options_.references) references_.pop_front();
}

}  // namespace overfly::odometry::feature
