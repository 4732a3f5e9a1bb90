// Linear models of an aircraft around a steady flight, and their natural modes.
#pragma once

#include <Eigen/Core>
#include <complex>
#include <optional>

#include "flight/dynamics/airframe.hpp"
#include "flight/dynamics/environment.hpp"
#include "flight/dynamics/trim.hpp"

namespace overfly::dynamics {

/// d/dt x = A x + B u for small deviations from a trim [m/s, rad, rad/s].
struct LinearModel {
  Eigen::Matrix4d A_lon;              ///< of u, w, q, pitch angle
  Eigen::Matrix<double, 4, 2> B_lon;  ///< to elevator, throttle
  Eigen::Matrix4d A_lat;              ///< of v, p, r, roll angle
  Eigen::Matrix<double, 4, 2> B_lat;  ///< to aileron, rudder
};

/// Differentiates the equations of motion by central differences. In a turn the two models are
/// coupled; they are exact for straight flight.
[[nodiscard]] LinearModel linearise(const Airframe& airframe,
                                    const Environment& environment,
                                    const Trim& trim);

/// A pair of eigenvalues, s^2 + 2 zeta omega s + omega^2. Two real ones have |zeta| >= 1. The
/// frequency is 0 if one of them grows and the other decays.
struct PairMode {
  std::complex<double> first, second;
  double frequency_rad_s = 0.0;  ///< undamped
  double damping = 0.0;          ///< zeta; negative if it grows
};

/// A real eigenvalue [1/s]: decays with the time constant -1 / rate, doubles in ln 2 / rate.
struct RealMode {
  double rate_1_s = 0.0;
};

/// Short period and phugoid are the two larger and the two smaller eigenvalues of A_lon. Those of
/// A_lat are the Dutch roll (the faster oscillation), the roll mode (the faster real one) and the
/// spiral; a mode that has merged with another is absent.
struct Modes {
  PairMode short_period;
  PairMode phugoid;
  std::optional<PairMode> dutch_roll;
  std::optional<RealMode> roll;
  std::optional<RealMode> spiral;
};

[[nodiscard]] Modes modes(const LinearModel& model);

}  // namespace overfly::dynamics
