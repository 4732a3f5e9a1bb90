#include "flight/dynamics/modes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "core/algebra/decompositions.hpp"
#include "flight/dynamics/steady_motion.hpp"

namespace overfly::dynamics {
namespace {

using Complex = std::complex<double>;

/// u, w, q, pitch angle; v, p, r, roll angle.
using Deviation = Eigen::Matrix<double, 8, 1>;

FlightPoint displaced(const Trim& trim, const Deviation& x, const Eigen::Vector4d& controls) {
  FlightPoint point;
  point.v_body_m_s = trim.v_body_m_s() + Eigen::Vector3d(x(0), x(4), x(1));
  point.omega_body_rad_s = trim.omega_body_rad_s() + Eigen::Vector3d(x(5), x(2), x(6));
  point.pitch_rad = trim.pitch_rad + x(3);
  point.roll_rad = trim.roll_rad + x(7);
  point.controls = {trim.controls.elevator_rad + controls(0),
                    trim.controls.aileron_rad + controls(2),
                    trim.controls.rudder_rad + controls(3),
                    trim.controls.throttle + controls(1)};
  return point;
}

std::array<Complex, 4> eigenvalues_by_size(const Eigen::Matrix4d& A) {
  std::array<Complex, 4> values = eigenvalues(A);
  // Conjugates stay neighbours: they are equal in size and in real part.
  std::sort(values.begin(), values.end(), [](const Complex& a, const Complex& b) {
    return std::abs(a) != std::abs(b) ? std::abs(a) > std::abs(b) : a.imag() > b.imag();
  });
  return values;
}

PairMode pair_of(const Complex& first, const Complex& second) {
  PairMode mode{first, second, 0.0, 0.0};
  const double product = (first * second).real();
  if (product <= 0.0) return mode;
  mode.frequency_rad_s = std::sqrt(product);
  mode.damping = -0.5 * (first + second).real() / mode.frequency_rad_s;
  return mode;
}

}  // namespace

LinearModel linearise(const Airframe& airframe, const Environment& environment, const Trim& trim) {
  constexpr double kStep = 1e-5;
  const double density = environment.density_kg_m3(trim.up_m);
  const auto rates = [&](const Deviation& x, const Eigen::Vector4d& controls) {
    const FlightPointMotion motion =
        motion_at(airframe, environment.gravity_m_s2, density, displaced(trim, x, controls));
    Deviation f;
    f << motion.acceleration_m_s2.x(), motion.acceleration_m_s2.z(),
        motion.angular_acceleration_rad_s2.y(), motion.pitch_rate_rad_s,
        motion.acceleration_m_s2.y(), motion.angular_acceleration_rad_s2.x(),
        motion.angular_acceleration_rad_s2.z(), motion.roll_rate_rad_s;
    return f;
  };
  Eigen::Matrix<double, 8, 8> A;
  for (int i = 0; i < 8; ++i) {
    const Deviation step = kStep * Deviation::Unit(i);
    A.col(i) = (rates(step, Eigen::Vector4d::Zero()) - rates(-step, Eigen::Vector4d::Zero())) /
               (2.0 * kStep);
  }
  Eigen::Matrix<double, 8, 4> B;
  for (int i = 0; i < 4; ++i) {
    const Eigen::Vector4d step = kStep * Eigen::Vector4d::Unit(i);
    B.col(i) = (rates(Deviation::Zero(), step) - rates(Deviation::Zero(), -step)) / (2.0 * kStep);
  }
  return {A.topLeftCorner<4, 4>(),
          B.topLeftCorner<4, 2>(),
          A.bottomRightCorner<4, 4>(),
          B.bottomRightCorner<4, 2>()};
}

Modes modes(const LinearModel& model) {
  Modes modes;
  const std::array<Complex, 4> lon = eigenvalues_by_size(model.A_lon);
  modes.short_period = pair_of(lon[0], lon[1]);
  modes.phugoid = pair_of(lon[2], lon[3]);
  std::vector<Complex> oscillating;
  std::vector<double> real;
  for (const Complex& value : eigenvalues_by_size(model.A_lat)) {
    if (value.imag() == 0.0) {
      real.push_back(value.real());
    } else {
      oscillating.push_back(value);
    }
  }
  if (oscillating.size() >= 2) modes.dutch_roll = pair_of(oscillating[0], oscillating[1]);
  if (real.size() == 2) {
    modes.roll = RealMode{real[0]};
    modes.spiral = RealMode{real[1]};
  }
  return modes;
}

}  // namespace overfly::dynamics
