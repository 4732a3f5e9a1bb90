// The first map from views whose corners were followed.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "core/camera.hpp"
#include "odometry/feature/bundle.hpp"
#include "odometry/feature/map.hpp"
#include "odometry/feature/orb.hpp"

namespace overfly::odometry {

struct FrameImage;

struct FirstMapPoint {
  Corner corner;  ///< in the first view
  int patch_level = 0;
  Eigen::Vector3d p_first = Eigen::Vector3d::Zero();
  Eigen::Vector2d last_pixel = Eigen::Vector2d::Zero();
  std::vector<std::optional<Eigen::Vector2d>> between_pixels;  ///< one for each view between
};

struct FirstMapInput {
  const FrameImage* first = nullptr;
  const FrameImage* last = nullptr;
  std::vector<const FrameImage*> between;
  std::vector<FirstMapPoint> points;
  Pose T_last_first;
};

/// All views adjusted together, the ground on the first's optical axis 1 away.
struct FirstMap {
  Bundle bundle;
  double rms_sigma = 0.0;  ///< of all sights, before those that miss were removed
};

/// @return empty when too few points agree
[[nodiscard]] std::optional<FirstMap> solve_first_map(const PinholeCamera& camera,
                                                      const FirstMapInput& input);
/// Fills an empty map with the keyframes and points.
void fill_first_map(const PinholeCamera& camera,
                    const FirstMapInput& input,
                    const FirstMap& solved,
                    OrbExtractor& orb,
                    Map& map);

}  // namespace overfly::odometry
