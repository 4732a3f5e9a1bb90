// The first map from views whose corners were followed.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "core/camera.hpp"
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

/// Adjusts all views together, scales the first's median depth to 1 and fills the (empty) map.
/// @return false, with the map left empty, when too few points agree
bool make_first_map(const PinholeCamera& camera,
                    const FirstMapInput& input,
                    OrbExtractor& orb,
                    Map& map);

}  // namespace overfly::odometry
