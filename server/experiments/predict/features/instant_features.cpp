#include "server/experiments/predict/features/instant_features.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "server/experiments/predict/features/image_features.hpp"
#include "server/experiments/predict/features/view_features.hpp"
#include "server/missions/camera_view.hpp"

namespace overfly::server::predict {
namespace {

/// Corners stand out by this threshold of FAST [grey levels], or by so many standard deviations of
/// the noise.
constexpr int kCornerThreshold = 7;
constexpr double kCornerNoise = 4.0;
/// Templates with less contrast are not searched for [grey levels, standard deviations of noise].
constexpr double kLeastContrast = 3.0;
constexpr double kContrastNoise = 2.0;
constexpr int kSearchRadiusPx = 20;

double middle_of(std::vector<double> values) {
  if (values.empty()) return 0.0;
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

void add_image_features(const PatchShot& shot, Features& features) {
  const int threshold =
      std::max(kCornerThreshold, static_cast<int>(std::ceil(kCornerNoise * shot.noise_grey)));
  const double contrast = std::max(kLeastContrast, kContrastNoise * shot.noise_grey);
  std::vector<double> densities;
  std::vector<double> similarities;
  int bare = 0;
  for (const Image& patch : shot.patches) {
    const double density =
        1000.0 * count_corners(patch, threshold) / static_cast<double>(patch.data.size());
    densities.push_back(density);
    bare += density < 1.0 ? 1 : 0;
    if (const auto similarity =
            self_similarity(patch, fitting_radius_px(patch, kSearchRadiusPx), contrast)) {
      similarities.push_back(*similarity);
    }
  }
  features.corners_per_kpx = middle_of(densities);
  features.self_similarity = middle_of(similarities);
  if (!shot.patches.empty()) {
    features.bare_share = static_cast<double>(bare) / static_cast<double>(shot.patches.size());
  }
}

}  // namespace

Features features_of(const CameraModel& camera,
                     const PatchShot& shot,
                     std::int64_t t_ns,
                     const ViewPoses& poses,
                     const terrain::TileSource& tiles,
                     const std::optional<double>& sun_elevation_deg) {
  Features features;
  features.texels_per_pixel = shot.texels_per_pixel;
  features.noise_grey = shot.noise_grey;
  features.void_share = shot.void_share;
  features.sun_elevation_deg = sun_elevation_deg;
  features.image_width_px = camera.pinhole().width_px;
  features.image_kpx = 1e-3 * camera.pinhole().width_px * camera.pinhole().height_px;
  add_image_features(shot, features);
  const CameraView view = view_of(camera, poses.now, tiles);
  features.relief = relief_over_height(view);
  const PixelMotion motion = motion_of(camera, view, poses.next_frame);
  features.rotation_px = motion.rotation_px;
  features.translation_px = motion.translation_px;
  features.overlap = overlap_with(camera, view, poses.later);
  if (shot.exposure_ns > 0) {
    const std::int64_t half_ns = shot.exposure_ns / 2;
    const CameraView opened = view_of(camera, shot.T_world_camera.at(t_ns - half_ns), tiles);
    features.blur_px = image_motion_px(camera, opened, shot.T_world_camera.at(t_ns + half_ns));
  }
  return features;
}

}  // namespace overfly::server::predict
