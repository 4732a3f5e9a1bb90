#include "odometry/feature/start/first_map.hpp"

#include <algorithm>
#include <utility>

#include "odometry/adjustment/bundle.hpp"
#include "odometry/adjustment/pose_optimiser.hpp"

namespace overfly::odometry::feature {
namespace {

constexpr int kMinFirstPoints = 60;
constexpr double kOutlierSigmas = 6.0;
/// Of two motions over all views the better one's residual must be less than this fraction of the
/// other's. With thousands of observations residuals are comparable to a few hundredths; ratios of
/// 0.33 to 0.68 were measured in flight.
constexpr double kMostAlikeResidual = 0.7;

/// Views in time order: first, between, last.
std::vector<const FrameImage*> views_of(const FirstMapInput& input) {
  std::vector<const FrameImage*> views{input.first};
  views.insert(views.end(), input.between.begin(), input.between.end());
  views.push_back(input.last);
  return views;
}

std::vector<std::optional<Eigen::Vector2d>> pixels_of(const FirstMapPoint& point) {
  std::vector<std::optional<Eigen::Vector2d>> pixels{point.corner.pixel};
  pixels.insert(pixels.end(), point.between_pixels.begin(), point.between_pixels.end());
  pixels.emplace_back(point.last_pixel);
  return pixels;
}

/// Pose of an intermediate view, from the points of the two-view solution.
Pose pose_between(const PinholeCamera& camera,
                  const FirstMapInput& input,
                  std::size_t between,
                  const Pose& start) {
  std::vector<PoseObservation> observations;
  for (const FirstMapPoint& point : input.points) {
    const auto& pixel = point.between_pixels[between];
    if (pixel) observations.push_back({point.p_first, *pixel, 1.0});
  }
  return optimise_pose(camera, start, observations).T_camera_vo;
}

Bundle bundle_of(const PinholeCamera& camera, const FirstMapInput& input) {
  Bundle bundle;
  bundle.cameras.push_back({Pose{}, true});
  Pose T_view_first;
  for (std::size_t i = 0; i < input.between.size(); ++i) {
    T_view_first = pose_between(camera, input, i, T_view_first);
    bundle.cameras.push_back({T_view_first, false});
  }
  bundle.cameras.push_back({input.T_last_first, false});
  for (const FirstMapPoint& point : input.points) {
    const int id = static_cast<int>(bundle.points_vo.size());
    bundle.points_vo.push_back(point.p_first);
    const auto pixels = pixels_of(point);
    for (std::size_t view = 0; view < pixels.size(); ++view) {
      if (!pixels[view]) continue;
      bundle.sights.push_back(
          {static_cast<int>(view), id, *pixels[view], sigma_px_of(point.patch_level)});
    }
  }
  return bundle;
}

/// Removes outlier observations; returns the number of points that keep two or more.
int remove_outliers(const PinholeCamera& camera, Bundle& bundle) {
  struct Seen {
    bool first = false;  ///< observed in the first view, which contains the patch
    int views = 0;
    [[nodiscard]] bool enough() const { return first && views >= 2; }
  };
  std::vector<Seen> seen(bundle.points_vo.size());
  std::erase_if(bundle.sights, [&](const Bundle::Sight& sight) {
    const auto pixel =
        camera.project(bundle.cameras[static_cast<std::size_t>(sight.camera)].T_camera_vo *
                       bundle.points_vo[static_cast<std::size_t>(sight.point)]);
    return !pixel || (*pixel - sight.pixel).norm() > kOutlierSigmas * sight.sigma_px;
  });
  for (const Bundle::Sight& sight : bundle.sights) {
    Seen& point = seen[static_cast<std::size_t>(sight.point)];
    if (sight.camera == 0) point.first = true;
    ++point.views;
  }
  std::erase_if(bundle.sights, [&](const Bundle::Sight& sight) {
    return !seen[static_cast<std::size_t>(sight.point)].enough();
  });
  return static_cast<int>(
      std::count_if(seen.begin(), seen.end(), [](const Seen& point) { return point.enough(); }));
}

void normalise_scale(Bundle& bundle) {
  const auto depth = axis_depth(Pose{}, bundle.points_vo);
  if (!depth) return;
  for (Eigen::Vector3d& point : bundle.points_vo) point /= *depth;
  for (Bundle::Camera& camera : bundle.cameras) camera.T_camera_vo.translation /= *depth;
}

}  // namespace

void fill_first_map(const PinholeCamera& camera,
                    const FirstMapInput& input,
                    const FirstMap& solved,
                    OrbExtractor& orb,
                    Map& map) {
  const Bundle& bundle = solved.bundle;
  std::vector<int> keyframes;
  const auto views = views_of(input);
  for (std::size_t view = 0; view < views.size(); ++view) {
    Keyframe keyframe;
    keyframe.frame = views[view]->index;
    keyframe.t_ns = views[view]->t_ns;
    keyframe.pyramid = views[view]->pyramid;
    keyframe.T_camera_vo = bundle.cameras[view].T_camera_vo;
    keyframe.plane.holds = input.plane;
    keyframes.push_back(map.add_keyframe(std::move(keyframe)).id);
  }
  orb.load(input.first->pyramid.level(0));
  std::vector<int> ids(bundle.points_vo.size(), -1);
  for (const Bundle::Sight& sight : bundle.sights) {
    const auto index = static_cast<std::size_t>(sight.point);
    Keyframe& keyframe = map.keyframe(keyframes[static_cast<std::size_t>(sight.camera)]);
    if (ids[index] < 0) {
      const FirstMapPoint& source = input.points[index];
      MapPoint point;
      point.position_vo = bundle.points_vo[index];
      point.source_keyframe = keyframes.front();
      point.source_pixel = source.corner.pixel;
      point.patch_level = source.patch_level;
      point.descriptor = orb.describe(source.corner);
      point.normal_vo = source.normal_first;  // the first camera is the origin
      ids[index] = map.add_point(std::move(point)).id;
    }
    map.add_observation(keyframe, {ids[index], sight.pixel, sight.sigma_px});
  }
  for (auto& [id, keyframe] : map.keyframes()) fit_plane(camera, map, keyframe);
  for (MapPoint& point : map.points()) {
    const Keyframe& source = map.keyframe(point.source_keyframe);
    if (source.plane.holds) set_normal(camera, source, point);
  }
}

std::optional<ChosenFirstMap> choose_first_map(const PinholeCamera& camera,
                                               std::vector<FirstMapInput> inputs) {
  std::vector<ChosenFirstMap> hypotheses;
  for (FirstMapInput& input : inputs) {
    auto solved = solve_first_map(camera, input);
    if (solved) hypotheses.push_back({std::move(input), std::move(*solved)});
  }
  if (hypotheses.empty()) return std::nullopt;
  std::sort(hypotheses.begin(), hypotheses.end(), [](const auto& a, const auto& b) {
    return a.solved.rms_sigma < b.solved.rms_sigma;
  });
  const bool told_apart =
      hypotheses.size() == 1 ||
      hypotheses[0].solved.rms_sigma < kMostAlikeResidual * hypotheses[1].solved.rms_sigma;
  if (!told_apart) return std::nullopt;
  return std::move(hypotheses.front());
}

std::optional<FirstMap> solve_first_map(const PinholeCamera& camera, const FirstMapInput& input) {
  FirstMap solved{bundle_of(camera, input)};
  Bundle& bundle = solved.bundle;
  BundleOptions options;
  options.max_iterations = 10;
  solved.rms_sigma = adjust(camera, bundle, options);
  if (remove_outliers(camera, bundle) < kMinFirstPoints) return std::nullopt;
  adjust(camera, bundle, options);
  if (remove_outliers(camera, bundle) < kMinFirstPoints) return std::nullopt;
  // Only points that kept their observations determine the scale.
  std::vector<std::uint8_t> kept(bundle.points_vo.size(), 0);
  for (const Bundle::Sight& sight : bundle.sights) kept[static_cast<std::size_t>(sight.point)] = 1;
  for (std::size_t i = 0; i < kept.size(); ++i) {
    if (kept[i] == 0) bundle.points_vo[i] = Eigen::Vector3d(0.0, 0.0, -1.0);
  }
  normalise_scale(bundle);
  return solved;
}

}  // namespace overfly::odometry::feature
