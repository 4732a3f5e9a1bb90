// Projects world points into an image whose rows are exposed one after another.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "renderer/renderer.hpp"

namespace overfly::renderer {

/// A point's position in an image, and its depth in the camera at that row.
struct ProjectedPoint {
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
  double depth_m = 0.0;  ///< along the optical axis
};

/// Projects points of the world into the image of one request. Immutable: const = thread-safe.
///
/// Rolling shutter: the row that sees the point is found by iteration, row -> pose of that row ->
/// projection -> row, which converges while the image moves less than one row per row time.
class RowProjector {
 public:
  explicit RowProjector(const CameraRequest& request);

  /// @return empty if the point is not in front of the camera or outside the lens, or if the row is
  /// not found
  [[nodiscard]] std::optional<ProjectedPoint> project(const Eigen::Vector3d& p_world) const;
  /// T_world_camera while a row is exposed.
  [[nodiscard]] const Pose& T_world_camera(int row) const;
  /// True if the pixel's centre lies in the image, [0, width - 1] x [0, height - 1].
  [[nodiscard]] bool inside(const Eigen::Vector2d& pixel) const;

 private:
  struct RowPose {
    Pose T_world_camera;
    Eigen::Matrix3d R_camera_world;
    Eigen::Vector3d centre_world;
  };
  [[nodiscard]] std::optional<ProjectedPoint> project_from(const RowPose& pose,
                                                           const Eigen::Vector3d& p_world) const;

  CameraModel camera_;
  std::vector<RowPose> rows_;  ///< only one if all rows are exposed at once
};

}  // namespace overfly::renderer
