// Computes the first map from views whose corners were tracked.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "core/camera/camera.hpp"
#include "odometry/adjustment/bundle.hpp"
#include "odometry/feature/map/map.hpp"
#include "odometry/feature/orb.hpp"
#include "odometry/image/frame_image.hpp"

namespace overfly::odometry::feature {

struct FirstMapPoint {
  Corner corner;  ///< in the first view
  int patch_level = 0;
  Eigen::Vector3d p_first = Eigen::Vector3d::Zero();
  Eigen::Vector2d last_pixel = Eigen::Vector2d::Zero();
  std::vector<std::optional<Eigen::Vector2d>> between_pixels;  ///< one for each view between
  /// Surface normal in the first camera; used if the scene is not planar.
  Eigen::Vector3d normal_first = Eigen::Vector3d::UnitZ();
};

struct FirstMapInput {
  const FrameImage* first = nullptr;
  const FrameImage* last = nullptr;
  std::vector<const FrameImage*> between;
  std::vector<FirstMapPoint> points;
  Pose T_last_first;
  bool plane = true;  ///< the scene counts as planar until the points show otherwise
};

/// All views, adjusted together. The depth of the ground on the first view's optical axis is 1.
struct FirstMap {
  Bundle bundle;
  double rms_sigma = 0.0;  ///< of all observations, before outlier removal
};

/// @return empty if too few points agree
[[nodiscard]] std::optional<FirstMap> solve_first_map(const PinholeCamera& camera,
                                                      const FirstMapInput& input);
/// The first map for the motion that best fits all views. Two views can allow several motions; a
/// wrong one does not fit the views between them as well.
struct ChosenFirstMap {
  FirstMapInput input;
  FirstMap solved;
};
/// @return empty if no motion is clearly better than the others
[[nodiscard]] std::optional<ChosenFirstMap> choose_first_map(const PinholeCamera& camera,
                                                             std::vector<FirstMapInput> inputs);
/// Adds the keyframes and points to an empty map.
void fill_first_map(const PinholeCamera& camera,
                    const FirstMapInput& input,
                    const FirstMap& solved,
                    OrbExtractor& orb,
                    Map& map);

}  // namespace overfly::odometry::feature
