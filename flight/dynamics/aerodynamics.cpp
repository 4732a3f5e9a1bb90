#include "flight/dynamics/aerodynamics.hpp"

#include <algorithm>
#include <cmath>

#include "core/motion/pose.hpp"

namespace overfly::dynamics {
namespace {

double logistic(double x) { return 1.0 / (1.0 + std::exp(-x)); }

/// Share of the flat plate (Beard & McLain, eq. 4.10), written with logistic functions, which do
/// not overflow: a + b - a b is the book's quotient.
double stalled_share(const StallShape& stall, double alpha_rad) {
  const double a = logistic(stall.sharpness * (alpha_rad - stall.alpha_rad));
  const double b = logistic(-stall.sharpness * (alpha_rad + stall.alpha_rad));
  return a + b - a * b;
}

/// Coefficients at an angle of attack, given with its sine and cosine.
struct AlphaCoefficients {
  double lift;
  double drag;
  double pitch;
};

AlphaCoefficients at_alpha(const Airframe& airframe, double alpha_rad, double sine, double cosine) {
  const double share = stalled_share(airframe.stall, alpha_rad);
  const double linear_lift = airframe.lift.zero + airframe.lift.alpha * alpha_rad;
  const double induced =
      linear_lift * linear_lift / (kPi * airframe.drag.oswald * airframe.aspect_ratio());
  const double plate = 2.0 * std::abs(sine) * sine;  // the normal force, with its sign
  return {(1.0 - share) * linear_lift + share * plate * cosine,
          airframe.drag.parasite + (1.0 - share) * induced + share * plate * sine,
          (1.0 - share) * (airframe.pitch.zero + airframe.pitch.alpha * alpha_rad) +
              share * airframe.pitch.alpha * sine};
}

double coefficient(const LateralCoefficients& c, double sin_beta, const Controls& positions) {
  return c.beta * sin_beta + c.aileron * positions.aileron_rad + c.rudder * positions.rudder_rad;
}

}  // namespace

LiftDrag lift_drag(const Airframe& airframe, double alpha_rad) {
  const AlphaCoefficients c =
      at_alpha(airframe, alpha_rad, std::sin(alpha_rad), std::cos(alpha_rad));
  return {c.lift, c.drag};
}

Wrench aerodynamic_wrench(const Airframe& airframe,
                          const Eigen::Vector3d& v_air_body_m_s,
                          const Eigen::Vector3d& omega_air_body_rad_s,
                          const Controls& positions,
                          double density_kg_m3) {
  const double u = v_air_body_m_s.x();
  const double v = v_air_body_m_s.y();
  const double w = v_air_body_m_s.z();
  const double plane = std::sqrt(u * u + w * w);
  const double speed = std::sqrt(plane * plane + v * v);
  const double cosine = plane > 0.0 ? u / plane : 1.0;
  const double sine = plane > 0.0 ? w / plane : 0.0;
  const AlphaCoefficients c = at_alpha(airframe, std::atan2(w, u), sine, cosine);

  const double area = airframe.wing.area_m2;
  const double span = airframe.wing.span_m;
  const double chord = airframe.wing.chord_m;
  const double half = 0.5 * density_kg_m3 * area;
  const double pressure = half * plane * plane;       // N, dynamic pressure times area
  const double rate = 0.5 * half * plane;             // times chord: of the pitch rate
  const double q = omega_air_body_rad_s.y() * chord;  // m/s
  const double lift = pressure * (c.lift + airframe.lift.elevator * positions.elevator_rad) +
                      rate * airframe.lift.pitch_rate * q;
  const double drag =
      pressure * (c.drag + airframe.drag.elevator * std::abs(positions.elevator_rad));
  const double pitch = pressure * (c.pitch + airframe.pitch.elevator * positions.elevator_rad) +
                       rate * airframe.pitch.pitch_rate * q;

  const double sin_beta = speed > 0.0 ? v / speed : 0.0;
  const double side_pressure = half * speed * speed;
  const double p = 0.5 * half * speed * span * omega_air_body_rad_s.x();
  const double r = 0.5 * half * speed * span * omega_air_body_rad_s.z();
  const auto lateral = [&](const LateralCoefficients& k) {
    return side_pressure * coefficient(k, sin_beta, positions) + k.roll_rate * p + k.yaw_rate * r;
  };

  Wrench wrench;
  wrench.force_n = {
      lift * sine - drag * cosine, lateral(airframe.side), -lift * cosine - drag * sine};
  wrench.moment_nm = {span * lateral(airframe.roll), chord * pitch, span * lateral(airframe.yaw)};
  return wrench;
}

PropellerState propeller(const Propulsion& propulsion,
                         double forward_m_s,
                         double throttle,
                         double density_kg_m3) {
  constexpr double kPerRad = 0.5 / kPi;  // turns
  const double d = propulsion.diameter_m;
  const double k = propulsion.motor_constant_v_s_rad;
  const double conductance = 1.0 / propulsion.motor_resistance_ohm;
  const double square = forward_m_s * std::abs(forward_m_s);
  const double disc = density_kg_m3 * d * d;  // kg/m
  const PropellerCurve& torque = propulsion.torque;
  const PropellerCurve& thrust = propulsion.thrust;
  // Torque of the propeller minus that of the motor, quadratic in n D.
  const double a = disc * d * torque.zero;
  const double b = disc * d * torque.linear * forward_m_s + k * k * conductance / (kPerRad * d);
  const double c =
      disc * d * torque.quadratic * square -
      k * (throttle * propulsion.battery_v * conductance - propulsion.no_load_current_a);
  double tip = 0.0;  // n D, m/s
  if (c < 0.0) {
    const double root = std::sqrt(b * b - 4.0 * a * c);
    tip = b > 0.0 ? -2.0 * c / (b + root) : (root - b) / (2.0 * a);
  }
  PropellerState state;
  state.speed_rad_s = tip / (kPerRad * d);
  state.thrust_n = disc * (thrust.zero * tip * tip + thrust.linear * tip * forward_m_s +
                           thrust.quadratic * square);
  state.torque_nm =
      disc * d *
      (torque.zero * tip * tip + torque.linear * tip * forward_m_s + torque.quadratic * square);
  return state;
}

Wrench air_wrench(const Airframe& airframe,
                  const Eigen::Vector3d& v_air_body_m_s,
                  const Eigen::Vector3d& omega_air_body_rad_s,
                  const Controls& positions,
                  double density_kg_m3) {
  Wrench wrench =
      aerodynamic_wrench(airframe, v_air_body_m_s, omega_air_body_rad_s, positions, density_kg_m3);
  const PropellerState driven =
      propeller(airframe.propulsion, v_air_body_m_s.x(), positions.throttle, density_kg_m3);
  wrench.force_n.x() += driven.thrust_n;
  wrench.moment_nm.x() -= driven.torque_nm;
  return wrench;
}

StallPoint stall_point(const Airframe& airframe) {
  constexpr int kSteps = 2000;
  StallPoint best;
  for (int i = 0; i <= kSteps; ++i) {
    const double alpha = airframe.stall.alpha_rad * i / kSteps;
    const double lift = lift_drag(airframe, alpha).lift;
    if (lift > best.lift) best = {lift, alpha};
  }
  return best;
}

}  // namespace overfly::dynamics
