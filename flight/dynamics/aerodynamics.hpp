// Aerodynamic and propulsive forces on an airframe.
#pragma once

#include <Eigen/Core>

#include "flight/dynamics/actuators.hpp"
#include "flight/dynamics/airframe.hpp"
#include "flight/dynamics/rigid_body.hpp"

namespace overfly::dynamics {

/// Lift and drag coefficient at an angle of attack in (-pi, pi], without elevator and pitch rate.
struct LiftDrag {
  double lift = 0.0;
  double drag = 0.0;
};

/// Lift: the linear coefficient, blended into that of a flat plate, 2 sign(a) sin^2 a cos a, by a
/// sigmoid around the stall (Beard & McLain, eq. 4.9 and 4.10). Drag: parasite plus induced drag of
/// the linear lift (eq. 4.11), blended into parasite + 2 |sin a|^3, the drag of the same plate
/// (both are the components of a normal force of 2 sin^2 a).
[[nodiscard]] LiftDrag lift_drag(const Airframe& airframe, double alpha_rad);

/// Force and moment of the air without the propeller (Beard & McLain, eq. 4.18 to 4.20).
///
/// With u, v, w the velocity through the air in body and V its norm. Differences to the book, all
/// without effect at zero sideslip and below the stall, make the model smooth at every attitude
/// and speed, including zero:
/// - Lift, drag and pitching moment use the velocity in the plane of symmetry, u^2 + w^2, instead
///   of V^2: the cosine rule of a swept flow.
/// - sin(beta) = v / V stands for beta.
/// - Rates enter as rho V S b^2 C_lp p / 4, without a division by V.
/// - Above the stall the static pitching moment becomes C_m_alpha sin(alpha), which is zero when
///   flying backwards.
/// - The elevator's drag counts its absolute deflection.
/// @param v_air_body_m_s      velocity of body relative to the air, expressed in body
/// @param omega_air_body_rad_s  rate of body relative to the air, expressed in body
[[nodiscard]] Wrench aerodynamic_wrench(const Airframe& airframe,
                                        const Eigen::Vector3d& v_air_body_m_s,
                                        const Eigen::Vector3d& omega_air_body_rad_s,
                                        const Controls& positions,
                                        double density_kg_m3);

struct PropellerState {
  double thrust_n = 0.0;
  double torque_nm = 0.0;  ///< of the air on the propeller's shaft, >= 0 while it is driven
  double speed_rad_s = 0.0;
};

/// Thrust of the propeller at the speed at which the motor's torque equals the propeller's (Beard &
/// McLain, supplement of 2020, sec. 4.3; the motor follows the throttle at once, its lag is that of
/// the throttle). A motor without enough voltage to overcome its friction stands still. In reverse
/// flow (u < 0) the quadratic terms change sign with u, so that a propeller always brakes.
/// @param forward_m_s  velocity through the air along the body's x axis
[[nodiscard]] PropellerState propeller(const Propulsion& propulsion,
                                       double forward_m_s,
                                       double throttle,
                                       double density_kg_m3);

/// Everything the air does: aerodynamic_wrench, thrust, and the propeller's reaction torque about
/// -x (it turns clockwise seen from behind).
[[nodiscard]] Wrench air_wrench(const Airframe& airframe,
                                const Eigen::Vector3d& v_air_body_m_s,
                                const Eigen::Vector3d& omega_air_body_rad_s,
                                const Controls& positions,
                                double density_kg_m3);

/// Largest lift coefficient below the flat-plate range, and its angle of attack.
struct StallPoint {
  double lift = 0.0;
  double alpha_rad = 0.0;
};
[[nodiscard]] StallPoint stall_point(const Airframe& airframe);

}  // namespace overfly::dynamics
