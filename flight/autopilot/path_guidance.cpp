#include "flight/autopilot/path_guidance.hpp"

#include <algorithm>
#include <cmath>

#include "core/motion/pose.hpp"

namespace overfly::autopilot {
namespace {

/// Below this ground speed the direction of flight is not known [m/s].
constexpr double kSlowest = 0.5;

double heading_of(const Eigen::Vector2d& east_north) {
  return std::atan2(east_north.x(), east_north.y());
}

/// Component to the right of a unit vector.
double right_of(const Eigen::Vector2d& direction, const Eigen::Vector2d& vector) {
  return direction.y() * vector.x() - direction.x() * vector.y();
}

}  // namespace

PathGuidance::PathGuidance(const Parameters& parameters)
    : period_s_(parameters.navl1_period), damping_(parameters.navl1_damping) {}

void PathGuidance::set_parameters(const Parameters& parameters) {
  period_s_ = parameters.navl1_period;
  damping_ = parameters.navl1_damping;
}

double PathGuidance::lead_m(double speed_m_s) const {
  return damping_ * period_s_ * std::max(speed_m_s, kSlowest) / kPi;
}

double PathGuidance::towards(const Eigen::Vector2d& direction,
                             const Eigen::Vector2d& velocity_m_s) {
  const double speed = std::max(velocity_m_s.norm(), kSlowest);
  double angle = wrap_pi(heading_of(direction) - heading_of(velocity_m_s));
  // Straight behind, the turn that has begun goes on: its side must not change with noise.
  constexpr double kAmbiguous = rad_from_deg(150.0);
  if (std::abs(angle) > kAmbiguous && angle * last_angle_rad_ < 0.0 &&
      std::abs(last_angle_rad_) > kAmbiguous) {
    angle = -angle;
  }
  last_angle_rad_ = angle;
  const double bounded = std::clamp(angle, -0.5 * kPi, 0.5 * kPi);
  return 4.0 * damping_ * damping_ * speed * speed / lead_m(speed) * std::sin(bounded);
}

double PathGuidance::along_line(const Eigen::Vector2d& from_m,
                                const Eigen::Vector2d& to_m,
                                const Eigen::Vector2d& position_m,
                                const Eigen::Vector2d& velocity_m_s) {
  const double lead = lead_m(velocity_m_s.norm());
  const Eigen::Vector2d line = to_m - from_m;
  if (line.norm() < 1.0) return towards(to_m - position_m, velocity_m_s);
  const Eigen::Vector2d along = line.normalized();
  const double right_m = right_of(along, position_m - from_m);
  // The point L1 away on the line; from farther off, an approach at 45 deg.
  const double across = std::min(std::abs(right_m), lead * std::sqrt(0.5));
  const double ahead = std::sqrt(lead * lead - across * across);
  const Eigen::Vector2d to_right(along.y(), -along.x());
  return towards(along * ahead - to_right * std::copysign(across, right_m), velocity_m_s);
}

double PathGuidance::around_circle(const Eigen::Vector2d& centre_m,
                                   double radius_m,
                                   const Eigen::Vector2d& position_m,
                                   const Eigen::Vector2d& velocity_m_s) {
  const double radius = std::abs(radius_m);
  const double side = radius_m > 0.0 ? 1.0 : -1.0;
  const Eigen::Vector2d from_centre = position_m - centre_m;
  const double distance = from_centre.norm();
  const double speed = velocity_m_s.norm();
  if (distance > radius + lead_m(speed)) {
    // The tangent on whose point of contact the circle is met in its own direction.
    const double opening = std::asin(radius / distance);
    const double heading = heading_of(-from_centre) - side * opening;
    return towards({std::sin(heading), std::cos(heading)}, velocity_m_s);
  }
  const Eigen::Vector2d out =
      distance > 1e-3 ? Eigen::Vector2d(from_centre / distance) : Eigen::Vector2d(0.0, 1.0);
  const double omega = 2.0 * kPi / period_s_;
  const double error_m = distance - radius;
  const double error_m_s = out.dot(velocity_m_s);
  // Clockwise flight moves to the right of the direction outwards.
  const double around_m_s = std::max(0.0, side * right_of(out, velocity_m_s));
  const double centripetal = around_m_s * around_m_s / std::max(0.5 * radius, distance);
  return side * (centripetal + omega * omega * error_m + 2.0 * damping_ * omega * error_m_s);
}

}  // namespace overfly::autopilot
