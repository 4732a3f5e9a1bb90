#include "core/motion/pose.hpp"

#include <algorithm>
#include <cmath>

namespace overfly {

Pose Pose::inverse() const {
  const Eigen::Quaterniond inverse_rotation = rotation.conjugate();
  return {inverse_rotation, -(inverse_rotation * translation)};
}

Eigen::Matrix4d Pose::matrix() const {
  Eigen::Matrix4d m = Eigen::Matrix4d::Identity();
  m.topLeftCorner<3, 3>() = rotation.toRotationMatrix();
  m.topRightCorner<3, 1>() = translation;
  return m;
}

Pose operator*(const Pose& T_a_b, const Pose& T_b_c) {
  // Renormalise: rounding errors accumulate over thousands of products.
  return {(T_a_b.rotation * T_b_c.rotation).normalized(),
          T_a_b.rotation * T_b_c.translation + T_a_b.translation};
}

Eigen::Vector3d operator*(const Pose& T_a_b, const Eigen::Vector3d& p_b) {
  return T_a_b.rotation * p_b + T_a_b.translation;
}

Similarity Similarity::inverse() const {
  const Eigen::Quaterniond inverse_rotation = rotation.conjugate();
  return {1.0 / scale, inverse_rotation, -(inverse_rotation * translation) / scale};
}

Eigen::Vector3d operator*(const Similarity& S_a_b, const Eigen::Vector3d& p_b) {
  return S_a_b.scale * (S_a_b.rotation * p_b) + S_a_b.translation;
}

Pose operator*(const Similarity& S_a_b, const Pose& T_b_c) {
  return {(S_a_b.rotation * T_b_c.rotation).normalized(), S_a_b * T_b_c.translation};
}

Pose interpolate(const Pose& T_a_from, const Pose& T_a_to, double alpha) {
  return {T_a_from.rotation.slerp(alpha, T_a_to.rotation).normalized(),
          T_a_from.translation + alpha * (T_a_to.translation - T_a_from.translation)};
}

double rotation_angle_rad(const Eigen::Quaterniond& a, const Eigen::Quaterniond& b) {
  // atan2 of the vector and scalar parts keeps full precision near 0 and near pi, unlike acos.
  const Eigen::Quaterniond difference = a.conjugate() * b;
  return 2.0 * std::atan2(difference.vec().norm(), std::abs(difference.w()));
}

namespace {

/// Between unit vectors less than a right angle apart: with the unit vector m half way between
/// them, the rotation is the quaternion (a . m, a x m).
Eigen::Quaterniond small_rotation(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  const Eigen::Vector3d m = (a + b).normalized();
  const Eigen::Vector3d v = a.cross(m);
  return Eigen::Quaterniond(a.dot(m), v.x(), v.y(), v.z()).normalized();
}

}  // namespace

Eigen::Quaterniond shortest_rotation(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  const Eigen::Vector3d a = from.normalized();
  const Eigen::Vector3d b = to.normalized();
  if (a.dot(b) >= 0.0) return small_rotation(a, b);
  // Half a turn about an axis perpendicular to both takes a to -a, from where it is not far.
  Eigen::Vector3d axis = a.cross(b);
  if (axis.norm() < 1e-8) axis = a.unitOrthogonal();
  axis = (axis - a * a.dot(axis)).normalized();
  return (small_rotation(-a, b) * Eigen::Quaterniond(0.0, axis.x(), axis.y(), axis.z()))
      .normalized();
}

namespace {

/// R_world_ned: north-east-down axes expressed in east-north-up.
Eigen::Matrix3d R_world_ned() {
  Eigen::Matrix3d R;
  R << 0, 1, 0, 1, 0, 0, 0, 0, -1;
  return R;
}

}  // namespace

Eigen::Quaterniond R_world_body_from(const RollPitchYaw& attitude) {
  const Eigen::Quaterniond R_ned_body =
      Eigen::AngleAxisd(attitude.yaw_rad, Eigen::Vector3d::UnitZ()) *
      Eigen::AngleAxisd(attitude.pitch_rad, Eigen::Vector3d::UnitY()) *
      Eigen::AngleAxisd(attitude.roll_rad, Eigen::Vector3d::UnitX());
  return (Eigen::Quaterniond(R_world_ned()) * R_ned_body).normalized();
}

RollPitchYaw attitude_from(const Eigen::Quaterniond& R_world_body) {
  const Eigen::Matrix3d R_ned_body = R_world_ned().transpose() * R_world_body.toRotationMatrix();
  RollPitchYaw attitude;
  attitude.roll_rad = std::atan2(R_ned_body(2, 1), R_ned_body(2, 2));
  attitude.pitch_rad = std::asin(std::clamp(-R_ned_body(2, 0), -1.0, 1.0));
  attitude.yaw_rad = std::atan2(R_ned_body(1, 0), R_ned_body(0, 0));
  return attitude;
}

Eigen::Quaterniond R_body_camera_nadir() {
  Eigen::Matrix3d R;
  R << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  return Eigen::Quaterniond(R);
}

double wrap_pi(double angle_rad) {
  const double wrapped = std::remainder(angle_rad, 2.0 * kPi);
  return wrapped <= -kPi ? kPi : wrapped;
}

}  // namespace overfly
