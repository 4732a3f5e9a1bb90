#pragma once

#include <Eigen/Geometry>

namespace dso {

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
  Eigen::Vector3d& translation() { return translation_; }
  const Eigen::Quaterniond& unit_quaternion() const { return rotation_; }
  Eigen::Matrix4d matrix() const {
    Eigen::Matrix4d T = Eigen::Matrix4d::Identity();
    T.topLeftCorner<3, 3>() = rotation_.toRotationMatrix();
    T.topRightCorner<3, 1>() = translation_;
    return T;
  }

 private:
  Eigen::Quaterniond rotation_;
  Eigen::Vector3d translation_;
};

class FrameShell {
 public:
  EIGEN_MAKE_ALIGNED_OPERATOR_NEW
  int incoming_id = 0;
  SE3 camToWorld;
  bool poseValid = true;
};

}  // namespace dso
