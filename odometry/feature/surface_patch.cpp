#include "odometry/feature/surface_patch.hpp"

#include <array>
#include <cmath>

#include "odometry/feature/tracker.hpp"

namespace overfly::odometry::feature {
namespace {

constexpr float kMinSurfaceCorrelation = 0.8F;
/// Agreement beyond which no other plane is tried.
constexpr float kGoodCorrelation = 0.93F;
/// Cosine between normal and ray: planes seen nearly edge-on distort the patch too much.
constexpr double kMinCosine = 0.12;

/// Aligns coarse to fine; the result of the finest level counts.
std::optional<PatchMatch> align_over(const PinholeCamera& camera,
                                     const SurfacePoint& point,
                                     const Pose& T_view_source,
                                     const Eigen::Vector3d& normal_source,
                                     const Pyramid& view,
                                     int coarser) {
  const Eigen::Vector3d p_view = T_view_source * point.p_source;
  const auto expected = camera.project(p_view);
  if (!expected) return std::nullopt;
  const PatchWarp warp =
      warp_of(camera, T_view_source.inverse(), p_view, T_view_source.rotation * normal_source);
  Eigen::Vector2d pixel = *expected;
  std::optional<PatchMatch> match;
  for (int level = point.patch_level + coarser; level >= point.patch_level; --level) {
    if (level >= view.level_count()) continue;
    const auto patch = make_template(*point.source, point.pixel, warp, level);
    match = patch ? align_patch(view, *patch, pixel) : std::nullopt;
    if (match && match->correlation < kMinSurfaceCorrelation) match.reset();
    if (match) pixel = match->pixel;
  }
  return match;
}

}  // namespace

std::optional<SurfaceMatch> align_on_surface(const PinholeCamera& camera,
                                             const SurfacePoint& point,
                                             const Pose& T_view_source,
                                             const Pyramid& view,
                                             int coarser) {
  const std::array<Eigen::Vector3d, 3> normals{
      Eigen::Vector3d::UnitZ(), Eigen::Vector3d::UnitX(), Eigen::Vector3d::UnitY()};
  std::optional<SurfaceMatch> best;
  for (const Eigen::Vector3d& normal : normals) {
    if (std::abs(normal.dot(point.p_source)) < kMinCosine * point.p_source.norm()) continue;
    const auto match = align_over(camera, point, T_view_source, normal, view, coarser);
    if (!match || (best && match->correlation <= best->match.correlation)) continue;
    best = SurfaceMatch{*match, normal};
    if (match->correlation > kGoodCorrelation) break;
  }
  return best;
}

}  // namespace overfly::odometry::feature
