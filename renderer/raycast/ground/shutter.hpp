// The camera's pose while each row of an image is exposed.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "renderer/renderer.hpp"

namespace overfly::renderer::raycast {

struct RowPose {
  Eigen::Matrix3d R_world_camera = Eigen::Matrix3d::Identity();
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< world frame [m]

  static RowPose of(const Pose& T_world_camera);
};

/// The poses of all rows at one moment of their exposures.
class ShutterPoses {
 public:
  /// @param offset_ns  from each row's mid exposure
  ShutterPoses(const CameraRequest& request, std::int64_t offset_ns);

  /// @param row  a multiple of 1/2 in [-1/2, height - 1/2]
  [[nodiscard]] const RowPose& at(double row) const {
    return poses_.size() == 1 ? poses_.front() : poses_[static_cast<std::size_t>(2.0 * row + 1.0)];
  }

 private:
  std::vector<RowPose> poses_;  ///< every half row from -1/2 on, or one for all rows
};

}  // namespace overfly::renderer::raycast
