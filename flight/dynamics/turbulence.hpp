// Dryden turbulence after MIL-F-8785C, seeded.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>

#include "flight/normal_noise.hpp"

namespace overfly::dynamics {

/// Wind at 20 ft above ground (W20) of 15, 30 and 45 kn; above 2000 ft, intensities that are
/// exceeded with probability 1e-2, 1e-3 and 1e-5.
enum class TurbulenceLevel { kLight, kModerate, kSevere };

/// Length scales [m] and root-mean-square velocities [m/s]. Those of v equal those of u.
struct TurbulenceScales {
  double length_u_m = 0.0;
  double length_w_m = 0.0;
  double sigma_u_m_s = 0.0;
  double sigma_w_m_s = 0.0;
};

/// MIL-F-8785C, sec. 3.7: the low-altitude model up to 1000 ft (less than 10 ft counts as 10 ft),
/// the medium/high-altitude model with figure 7 from 2000 ft (isotropic, 1750 ft), and linear in
/// the height between them.
[[nodiscard]] TurbulenceScales dryden_scales(TurbulenceLevel level, double height_agl_m);

/// Motion of the air, in axes forward (along the horizontal airspeed), right, down.
struct Gust {
  Eigen::Vector3d velocity_m_s = Eigen::Vector3d::Zero();
  /// Rotation of the air that the change of the gust along and across the aircraft amounts to.
  Eigen::Vector3d rate_rad_s = Eigen::Vector3d::Zero();
};

/// The gusts that an aircraft meets on its way through a frozen field of turbulence.
///
/// u, v, w and p have the spectra of MIL-F-8785C, sec. 3.7, in the form
///   u: sigma^2 2 L / pi / (1 + (L W)^2),  v, w: sigma^2 L / pi (1 + 3 (L W)^2) / (1 + (L W)^2)^2,
///   p: sigma_w^2 / L_w 0.8 (pi L_w / (4 b))^(1/3) / (1 + (4 b W / pi)^2),   W [rad/m], one-sided.
/// Each is a linear filter of white noise, discretised exactly: the samples have the covariance of
/// the continuous process for every step. q = -dw/dx and r = dv/dx follow by the specification's
/// filters (time constants 4 b / (pi V) and 3 b / (pi V)), exact for gusts that are constant during
/// a step, as the aircraft meets them. u, v, w and p start in their stationary distribution, q and
/// r at zero.
class Turbulence {
 public:
  /// @param span_m  wing span b > 0
  Turbulence(TurbulenceLevel level, double span_m, std::uint64_t seed);

  /// Zero before the first advance.
  [[nodiscard]] const Gust& gust() const { return gust_; }
  /// Moves on by airspeed_m_s * dt_s through the field.
  /// @pre both >= 0
  void advance(double airspeed_m_s, double height_agl_m, double dt_s);

 private:
  /// A process of variance 1 with the spectrum of v and w.
  struct Transverse {
    double first = 0.0;   // the white noise behind one lag
    double second = 0.0;  // behind two
    [[nodiscard]] double value() const;
  };

  void advance_transverse(Transverse& process, double lags, double kept);
  void set_velocities(const TurbulenceScales& scales);

  TurbulenceLevel level_;
  double span_m_;
  flight::NormalNoise noise_;
  double along_ = 0.0;  // u and p with variance 1
  double roll_ = 0.0;
  Transverse side_;
  Transverse down_;
  double lagged_side_m_s_ = 0.0;
  double lagged_down_m_s_ = 0.0;
  bool started_ = false;
  Gust gust_;
};

}  // namespace overfly::dynamics
