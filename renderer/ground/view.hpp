// A pinhole view placed in the world, shared by culling, meshing and drawing.
#pragma once

#include <Eigen/Core>
#include <array>

#include "core/camera/camera.hpp"
#include "core/motion/pose.hpp"

namespace overfly::renderer {

struct View {
  PinholeCamera camera;
  Eigen::Vector3d position_world = Eigen::Vector3d::Zero();  ///< optical centre [m]
  Eigen::Matrix3d R_camera_world = Eigen::Matrix3d::Identity();

  static View from(const PinholeCamera& camera, const Pose& T_world_camera);

  /// p_camera of a world point. The camera is subtracted in double precision, so that the result
  /// fits floats at any distance from the origin.
  [[nodiscard]] Eigen::Vector3d camera_from_world(const Eigen::Vector3d& p_world) const {
    return R_camera_world * (p_world - position_world);
  }

  /// Bits of the sides (left, right, top, bottom, behind) beyond which a camera-frame point lies.
  /// Points that share a bit lie outside the image together with all points between them.
  [[nodiscard]] unsigned outcode(const Eigen::Vector3d& p_camera) const;

  /// Inward normals of the four side planes through the optical centre, world frame.
  [[nodiscard]] std::array<Eigen::Vector3d, 4> side_normals_world() const;

  /// d(pixel) of a small displacement of a camera-frame point with z > 0 [px per m].
  [[nodiscard]] Eigen::Vector2d pixel_rate(const Eigen::Vector3d& p_camera,
                                           const Eigen::Vector3d& displacement_camera) const;
};

}  // namespace overfly::renderer
