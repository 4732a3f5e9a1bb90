// Rigid transforms, similarities and the aircraft's attitude.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace overfly {

/// Rigid transform T_target_source: p_target = T_target_source * p_source. Metres.
struct Pose {
  Eigen::Quaterniond rotation =
      Eigen::Quaterniond::Identity();                     ///< R_target_source, unit, Hamilton
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();  ///< source's origin in target [m]

  [[nodiscard]] Pose inverse() const;
  [[nodiscard]] Eigen::Matrix4d matrix() const;
};

/// T_a_c = T_a_b * T_b_c.
[[nodiscard]] Pose operator*(const Pose& T_a_b, const Pose& T_b_c);
/// p_a = T_a_b * p_b.
[[nodiscard]] Eigen::Vector3d operator*(const Pose& T_a_b, const Eigen::Vector3d& p_b);

/// Similarity S_target_source: p_target = scale * R * p_source + t.
struct Similarity {
  double scale = 1.0;
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();

  [[nodiscard]] Similarity inverse() const;
};

[[nodiscard]] Eigen::Vector3d operator*(const Similarity& S_a_b, const Eigen::Vector3d& p_b);
/// Pose in a of a frame whose pose in b is known: the position is scaled, the rotation is not.
[[nodiscard]] Pose operator*(const Similarity& S_a_b, const Pose& T_b_c);

/// Interpolates position linearly and rotation along the shorter arc (SLERP), alpha in [0, 1].
[[nodiscard]] Pose interpolate(const Pose& T_a_from, const Pose& T_a_to, double alpha);

/// The geodesic angle between two rotations, in [0, pi] [rad].
[[nodiscard]] double rotation_angle_rad(const Eigen::Quaterniond& a, const Eigen::Quaterniond& b);

/// The rotation by the smallest angle that turns the direction of `from` to that of `to`; lengths
/// do not matter, but must not be 0. Opposite directions are turned about any perpendicular axis.
[[nodiscard]] Eigen::Quaterniond shortest_rotation(const Eigen::Vector3d& from,
                                                   const Eigen::Vector3d& to);

/// Roll, pitch, yaw of the body (forward-right-down) relative to local north-east-down,
/// intrinsic Z-Y-X [rad]. Yaw 0 = north, clockwise positive; roll > 0 = right wing down.
struct RollPitchYaw {
  double roll_rad = 0.0;
  double pitch_rad = 0.0;
  double yaw_rad = 0.0;
};

/// R_world_body (world = east-north-up) of an attitude.
[[nodiscard]] Eigen::Quaterniond R_world_body_from(const RollPitchYaw& attitude);
/// The attitude of R_world_body; roll and yaw in (-pi, pi], pitch in [-pi/2, pi/2].
[[nodiscard]] RollPitchYaw attitude_from(const Eigen::Quaterniond& R_world_body);

/// Nadir mount: the camera looks down (+z_body), and the top of the image points to the nose.
/// Camera x (right) = body y, camera y (image down) = -body x, camera z = body z.
[[nodiscard]] Eigen::Quaterniond R_body_camera_nadir();

/// Wraps an angle to (-pi, pi] [rad].
[[nodiscard]] double wrap_pi(double angle_rad);

inline constexpr double kPi = 3.14159265358979323846;
[[nodiscard]] constexpr double rad_from_deg(double angle_deg) { return angle_deg * (kPi / 180.0); }
[[nodiscard]] constexpr double deg_from_rad(double angle_rad) { return angle_rad * (180.0 / kPi); }

}  // namespace overfly
