#pragma once

#include <Eigen/Geometry>

namespace Sophus {

class SE3 {
 public:
  SE3() : rotation_(Eigen::Quaterniond::Identity()), translation_(Eigen::Vector3d::Zero()) {}
  SE3(const Eigen::Quaterniond& rotation, const Eigen::Vector3d& translation)
      : rotation_(rotation), translation_(translation) {}
  SE3 inverse() const {
    return SE3(rotation_.conjugate(), -(rotation_.conjugate() * translation_));
  }
  Eigen::Vector3d operator*(const Eigen::Vector3d& p) const { return rotation_ * p + translation_; }
  const Eigen::Vector3d& translation() const { return translation_; }
  const Eigen::Quaterniond& unit_quaternion() const { return rotation_; }

 private:
  Eigen::Quaterniond rotation_;
  Eigen::Vector3d translation_;
};

}  // namespace Sophus
