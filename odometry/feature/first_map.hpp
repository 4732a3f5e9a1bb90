// The first map from views whose corners were followed.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "core/camera.hpp"
#include "odometry/feature/bundle.hpp"
#include "odometry/feature/frame_image.hpp"
#include "odometry/feature/map.hpp"
#include "odometry/feature/orb.hpp"

namespace overfly::odometry {

struct FirstMapPoint {
  Corner corner;  ///< in the first view
  int patch_level = 0;
  Eigen::Vector3d p_first = Eigen::Vector3d::Zero();
  Eigen::Vector2d last_pixel = Eigen::Vector2d::Zero();
  std::vector<std::optional<Eigen::Vector2d>> between_pixels;  ///< one for each view between
  /// Of the surface, in the first camera; taken where what is seen is no plane.
  Eigen::Vector3d normal_first = Eigen::Vector3d::UnitZ();
};

struct FirstMapInput {
  const FrameImage* first = nullptr;
  const FrameImage* last = nullptr;
  std::vector<const FrameImage*> between;
  std::vector<FirstMapPoint> points;
  Pose T_last_first;
  bool plane = true;  ///< the points are taken to lie near one until they show that they do not
};

/// All views adjusted together, the ground on the first's optical axis 1 away.
struct FirstMap {
  Bundle bundle;
  double rms_sigma = 0.0;  ///< of all sights, before those that miss were removed
};

/// @return empty when too few points agree
[[nodiscard]] std::optional<FirstMap> solve_first_map(const PinholeCamera& camera,
                                                      const FirstMapInput& input);
/// The first map of the motion that two views allow and all views agree with best: a wrong one fits
/// two views, but not all between them as well.
struct ChosenFirstMap {
  FirstMapInput input;
  FirstMap solved;
};
/// @return empty while none stands out
[[nodiscard]] std::optional<ChosenFirstMap> choose_first_map(const PinholeCamera& camera,
                                                             std::vector<FirstMapInput> inputs);
/// Fills an empty map with the keyframes and points.
void fill_first_map(const PinholeCamera& camera,
                    const FirstMapInput& input,
                    const FirstMap& solved,
                    OrbExtractor& orb,
                    Map& map);

}  // namespace overfly::odometry
