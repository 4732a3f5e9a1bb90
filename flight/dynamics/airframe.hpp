// A fixed-wing airframe as values: mass, aerodynamic coefficients, propulsion, actuators.
#pragma once

#include <algorithm>
#include <string>

namespace overfly::dynamics {

/// Moments of inertia about the centre of mass, body axes (forward-right-down) [kg m^2]. The
/// airframe is symmetric: xy and yz are zero.
struct Inertia {
  double xx = 0.0;
  double yy = 0.0;
  double zz = 0.0;
  double xz = 0.0;  ///< integral of x z dm (Beard & McLain, sec. 3.3: the matrix holds -xz)
};

struct Wing {
  double area_m2 = 0.0;
  double span_m = 0.0;
  double chord_m = 0.0;  ///< mean aerodynamic chord
};

/// Lift coefficient, per radian.
struct LiftCoefficients {
  double zero = 0.0;  ///< at zero angle of attack
  double alpha = 0.0;
  double pitch_rate = 0.0;  ///< of q c / (2 V)
  double elevator = 0.0;
};

struct DragCoefficients {
  double parasite = 0.0;
  double oswald = 0.0;    ///< span efficiency of the induced drag
  double elevator = 0.0;  ///< of the elevator's absolute deflection, per radian
};

/// Where the wing stalls (Beard & McLain, eq. 4.10).
struct StallShape {
  double alpha_rad = 0.0;  ///< the middle of the change to a flat plate
  double sharpness = 0.0;  ///< the book's M, per radian
};

/// Pitching moment coefficient, per radian.
struct PitchCoefficients {
  double zero = 0.0;
  double alpha = 0.0;
  double pitch_rate = 0.0;  ///< of q c / (2 V)
  double elevator = 0.0;
};

/// One of side force, rolling moment and yawing moment, per radian.
struct LateralCoefficients {
  double beta = 0.0;
  double roll_rate = 0.0;  ///< of p b / (2 V)
  double yaw_rate = 0.0;   ///< of r b / (2 V)
  double aileron = 0.0;
  double rudder = 0.0;
};

/// Thrust or torque coefficient over the advance ratio J = V / (n D):
/// zero + linear J + quadratic J^2.
struct PropellerCurve {
  double zero = 0.0;
  double linear = 0.0;
  double quadratic = 0.0;
};

/// A direct-current motor with a fixed-pitch propeller on the body's x axis.
struct Propulsion {
  double diameter_m = 0.0;
  PropellerCurve thrust;                ///< T = rho n^2 D^4 C_T(J)
  PropellerCurve torque;                ///< Q = rho n^2 D^5 C_Q(J)
  double motor_constant_v_s_rad = 0.0;  ///< voltage per speed = torque per current
  double motor_resistance_ohm = 0.0;
  double no_load_current_a = 0.0;
  double battery_v = 0.0;  ///< at full throttle
};

/// A control surface: first-order lag behind its command, with limits of rate and deflection.
struct SurfaceLimits {
  double min_rad = 0.0;
  double max_rad = 0.0;
  double rate_rad_s = 0.0;
  double lag_s = 0.0;  ///< time constant

  /// The larger deflection, of which the autopilot's commands are shares.
  [[nodiscard]] double range_rad() const { return std::max(-min_rad, max_rad); }
};

struct ThrottleLimits {
  double rate_1_s = 0.0;
  double lag_s = 0.0;
};

/// Signs of the controls: elevator > 0 pitches down, aileron > 0 rolls right, rudder > 0 yaws left
/// (each trailing edge down or left; Beard & McLain, sec. 4.2).
struct Airframe {
  std::string name;
  std::string source;  ///< where the numbers come from
  double mass_kg = 0.0;
  Inertia inertia;
  Wing wing;
  LiftCoefficients lift;
  DragCoefficients drag;
  StallShape stall;
  PitchCoefficients pitch;
  LateralCoefficients side, roll, yaw;
  Propulsion propulsion;
  SurfaceLimits elevator, aileron, rudder;
  ThrottleLimits throttle;

  [[nodiscard]] double aspect_ratio() const { return wing.span_m * wing.span_m / wing.area_m2; }
};

}  // namespace overfly::dynamics
