// Predicts the camera's pose in the next frame.
#pragma once

#include <algorithm>
#include <cstdint>

#include "core/motion/pose.hpp"
#include "odometry/geometry/lie.hpp"

namespace overfly::odometry {

/// Constant velocity in `vo` and constant angular rate in the camera.
class MotionModel {
 public:
  /// Adds a known pose; the velocity is computed from it and the previous pose.
  void observe(std::int64_t t_ns, const Pose& T_camera_vo) {
    const Pose T_vo_camera = T_camera_vo.inverse();
    if (poses_ > 0 && t_ns > t_ns_) {
      const double dt_s = static_cast<double>(t_ns - t_ns_) * 1e-9;
      velocity_ = (T_vo_camera.translation - T_vo_camera_.translation) / dt_s;
      rate_ = log_so3(T_vo_camera_.rotation.inverse() * T_vo_camera.rotation) / dt_s;
    }
    t_ns_ = t_ns;
    T_vo_camera_ = T_vo_camera;
    ++poses_;
  }
  /// Predicts T_camera_vo at a time, extrapolating at most `max_s`.
  [[nodiscard]] Pose predict(std::int64_t t_ns, double max_s = 2.0) const {
    const double dt_s = std::min(max_s, static_cast<double>(t_ns - t_ns_) * 1e-9);
    const Pose T_vo_camera{(T_vo_camera_.rotation * exp_so3(rate_ * dt_s)).normalized(),
                           T_vo_camera_.translation + velocity_ * dt_s};
    return T_vo_camera.inverse();
  }
  /// As above, but keeps the last attitude.
  [[nodiscard]] Pose predict_unturned(std::int64_t t_ns, double max_s = 2.0) const {
    const double dt_s = std::min(max_s, static_cast<double>(t_ns - t_ns_) * 1e-9);
    return Pose{T_vo_camera_.rotation, T_vo_camera_.translation + velocity_ * dt_s}.inverse();
  }
  [[nodiscard]] double speed() const { return velocity_.norm(); }
  [[nodiscard]] double rate_rad_s() const { return rate_.norm(); }
  void reset() { *this = MotionModel(); }

 private:
  std::int64_t t_ns_ = 0;
  int poses_ = 0;
  Pose T_vo_camera_;
  Eigen::Vector3d velocity_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d rate_ = Eigen::Vector3d::Zero();
};

}  // namespace overfly::odometry
