#include "odometry/feature/tracker.hpp"

#include <algorithm>
#include <cmath>

#include "odometry/image/patch_aligner.hpp"

namespace overfly::odometry::feature {
namespace {

constexpr double kBorderPx = 8.0;
constexpr int kCoarseMinMatches = 12;
/// Tracking fails if fewer than one in this many searched points agrees. In scenes that are not
/// planar more points are occluded and not found.
constexpr int kSearchedPerInlier = 3;
constexpr int kSearchedPerInlierInScene = 6;

}  // namespace

/// A point of the local map, with what selects it side by side.
struct Tracker::LocalPoint {
  Eigen::Vector3d position_vo;
  const MapPoint* point;
  std::size_t keyframes;  ///< number of keyframes that observe it
};

struct Tracker::Projection {
  const MapPoint* point = nullptr;
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
};

Tracker::Tracker(const PinholeCamera& camera, const TrackerOptions& options)
    : camera_(camera), options_(options) {}

PatchWarp warp_of(const PinholeCamera& camera,
                  const Pose& T_source_camera,
                  const Eigen::Vector3d& p,
                  const Eigen::Vector3d& n) {
  // The plane n.X = n.p in the view: H_source_other = K (R + t n^T / n.p) K^-1 (Hartley and
  // Zisserman 2003, result 13.1), here for steps of one pixel around the point.
  const Eigen::Matrix3d G = T_source_camera.rotation.toRotationMatrix() +
                            T_source_camera.translation * n.transpose() / n.dot(p);
  const Eigen::Vector3d q = G * (p / p.z());
  const Eigen::Vector2d step(1.0 / (q.z() * camera.fx_px), 1.0 / (q.z() * camera.fy_px));
  PatchWarp warp;
  warp.g_per_px = G.block<1, 2>(2, 0).transpose().cwiseProduct(step);
  warp.A_source_other =
      Eigen::Vector2d(camera.fx_px, camera.fy_px).asDiagonal() *
      (G.topLeftCorner<2, 2>() * step.asDiagonal() - q.hnormalized() * warp.g_per_px.transpose());
  return warp;
}

PatchWarp warp_of(const PinholeCamera& camera,
                  const Pose& T_camera_vo,
                  const Keyframe& source,
                  const MapPoint& point) {
  return warp_of(camera,
                 source.T_camera_vo * T_camera_vo.inverse(),
                 T_camera_vo * point.position_vo,
                 T_camera_vo.rotation * point.normal_vo);
}

std::vector<Tracker::LocalPoint> Tracker::local_points(const Map& map) const {
  const int oldest = map.newest().id - options_.local_keyframes;
  std::vector<LocalPoint> local;
  local.reserve(map.points().size());
  for (const MapPoint& point : map.points()) {
    if (point.keyframes.back() < oldest) continue;
    local.push_back({point.position_vo, &point, point.keyframes.size()});
  }
  return local;
}

/// One point of the local map for each cell of the image, the best observed first.
std::vector<Tracker::Projection> Tracker::project(const Pyramid& image,
                                                  const Pose& T_camera_vo,
                                                  const std::vector<LocalPoint>& local) const {
  const CellGrid grid = CellGrid::over(camera_.width_px, camera_.height_px, options_.max_points);
  std::vector<Projection> cells(grid.marked.size());
  const Eigen::Matrix3d R = T_camera_vo.rotation.toRotationMatrix();
  std::vector<std::size_t> keyframes(cells.size());
  for (const LocalPoint& candidate : local) {
    const auto pixel = camera_.project(R * candidate.position_vo + T_camera_vo.translation);
    if (!pixel || pixel->x() < kBorderPx || pixel->y() < kBorderPx ||
        pixel->x() > camera_.width_px - 1 - kBorderPx ||
        pixel->y() > camera_.height_px - 1 - kBorderPx) {
      continue;
    }
    if (!options_.seen.empty() &&
        options_.seen.at<std::uint8_t>(static_cast<int>(pixel->y()),
                                       static_cast<int>(pixel->x())) == 0) {
      continue;
    }
    if (image.burnt_at(*pixel)) continue;
    const std::size_t cell = grid.index(*pixel);
    // On a tie later points win: their patch is from a more similar view.
    if (candidate.keyframes < keyframes[cell]) continue;
    keyframes[cell] = candidate.keyframes;
    cells[cell] = {candidate.point, *pixel};
  }
  std::erase_if(cells, [](const Projection& cell) { return cell.point == nullptr; });
  return cells;
}

bool Tracker::align_coarsely(const Pyramid& image,
                             const std::vector<Projection>& projections,
                             int coarse_level,
                             const Map& map,
                             Pose& T_camera_vo) const {
  const std::size_t stride = std::max<std::size_t>(
      1, projections.size() / static_cast<std::size_t>(options_.coarse_points));
  bool found = coarse_level < 1;
  for (int level = std::min(coarse_level, image.level_count() - 1); level >= 1; --level) {
    std::vector<PoseObservation> observations;
    for (std::size_t i = level % stride; i < projections.size(); i += stride) {
      const MapPoint& point = *projections[i].point;
      const auto start = camera_.project(T_camera_vo * point.position_vo);
      if (!start) continue;
      const Keyframe& source = map.keyframe(point.source_keyframe);
      const auto patch = make_template(
          source.pyramid, point.source_pixel, warp_of(camera_, T_camera_vo, source, point), level);
      if (!patch) continue;
      const auto match = align_patch(image, *patch, *start);
      if (!match || match->correlation < options_.min_correlation) continue;
      observations.push_back({point.position_vo, match->pixel, std::ldexp(0.4, level)});
    }
    const PoseFit fit = optimise_pose(camera_, T_camera_vo, observations);
    found =
        fit.inliers >= kCoarseMinMatches && 2 * fit.inliers > static_cast<int>(observations.size());
    if (found) T_camera_vo = fit.T_camera_vo;
  }
  return found;
}

TrackResult Tracker::track(const Pyramid& image,
                           const Pose& T_predicted,
                           int coarse_level,
                           const Map& map) const {
  TrackResult result;
  result.T_camera_vo = T_predicted;
  const std::vector<LocalPoint> local = local_points(map);
  if (!align_coarsely(
          image, project(image, T_predicted, local), coarse_level, map, result.T_camera_vo)) {
    return result;
  }
  std::vector<PoseObservation> observations;
  std::vector<int> ids;
  const std::vector<Projection> projections = project(image, result.T_camera_vo, local);
  for (std::size_t i = 0; i < projections.size(); ++i) {
    if (i + 1 < projections.size()) {
      const MapPoint& next = *projections[i + 1].point;
      fetch_patch(map.keyframe(next.source_keyframe).pyramid, next.source_pixel, next.patch_level);
      fetch_patch(image, projections[i + 1].pixel, next.patch_level);
    }
    const Projection& projection = projections[i];
    const MapPoint& point = *projection.point;
    const Keyframe& source = map.keyframe(point.source_keyframe);
    const auto patch = make_template(source.pyramid,
                                     point.source_pixel,
                                     warp_of(camera_, result.T_camera_vo, source, point),
                                     point.patch_level);
    if (!patch) continue;
    ++result.searched;
    const auto match = align_patch(image, *patch, projection.pixel);
    if (!match || match->correlation < options_.min_correlation) {
      result.missed.push_back(point.id);
      continue;
    }
    observations.push_back({point.position_vo, match->pixel, sigma_px_of(point.patch_level)});
    ids.push_back(point.id);
  }
  const PoseFit fit = optimise_pose(camera_, result.T_camera_vo, observations);
  result.T_camera_vo = fit.T_camera_vo;
  result.rms_px = fit.rms_px;
  for (std::size_t i = 0; i < ids.size(); ++i) {
    auto& list = fit.inlier[i] != 0 ? result.points : result.outliers;
    list.push_back({ids[i], observations[i].pixel, observations[i].sigma_px});
  }
  const int share = map.newest().plane.holds ? kSearchedPerInlier : kSearchedPerInlierInScene;
  result.tracked = fit.inliers >= options_.min_inliers && share * fit.inliers > result.searched;
  return result;
}

}  // namespace overfly::odometry::feature
