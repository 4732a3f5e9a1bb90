#include "flight/dynamics/turbulence.hpp"

#include <algorithm>
#include <cmath>

#include "core/motion/pose.hpp"

namespace overfly::dynamics {
namespace {

constexpr double kMPerFt = 0.3048;
constexpr double kMSPerKn = 1852.0 / 3600.0;

/// MIL-F-8785C, figure 7: root-mean-square gusts [ft/s] over the height [ft], for each level.
struct HighIntensity {
  double height_ft;
  std::array<double, 3> sigma_ft_s;
};
constexpr std::array<HighIntensity, 10> kHighIntensity{{{500.0, {6.6, 8.6, 15.6}},
                                                        {1750.0, {6.9, 9.6, 17.6}},
                                                        {3750.0, {7.4, 10.6, 23.0}},
                                                        {7500.0, {6.7, 10.1, 23.6}},
                                                        {15000.0, {4.6, 8.0, 22.1}},
                                                        {25000.0, {2.7, 6.6, 20.0}},
                                                        {35000.0, {0.4, 5.0, 16.0}},
                                                        {45000.0, {0.0, 4.2, 15.1}},
                                                        {55000.0, {0.0, 2.7, 12.1}},
                                                        {65000.0, {0.0, 0.0, 7.9}}}};

double high_sigma_ft_s(std::size_t level, double height_ft) {
  const auto above = std::find_if(
      kHighIntensity.begin() + 1, kHighIntensity.end() - 1, [&](const HighIntensity& row) {
        return row.height_ft >= height_ft;
      });
  const HighIntensity& low = *(above - 1);
  const double share =
      std::clamp((height_ft - low.height_ft) / (above->height_ft - low.height_ft), 0.0, 1.0);
  return low.sigma_ft_s[level] + share * (above->sigma_ft_s[level] - low.sigma_ft_s[level]);
}

TurbulenceScales low_scales(std::size_t level, double height_ft) {
  constexpr std::array<double, 3> kWind20FtKn{15.0, 30.0, 45.0};
  const double base = 0.177 + 0.000823 * height_ft;
  TurbulenceScales scales;
  scales.length_w_m = kMPerFt * height_ft;
  const double root = std::pow(base, 0.4);
  scales.length_u_m = kMPerFt * height_ft / (root * root * root);
  scales.sigma_w_m_s = 0.1 * kMSPerKn * kWind20FtKn[level];
  scales.sigma_u_m_s = scales.sigma_w_m_s / root;
  return scales;
}

TurbulenceScales high_scales(std::size_t level, double height_ft) {
  const double sigma_m_s = kMPerFt * high_sigma_ft_s(level, height_ft);
  return {1750.0 * kMPerFt, 1750.0 * kMPerFt, sigma_m_s, sigma_m_s};
}

/// 1 / n; the series of the integrals below has no more terms.
constexpr auto kInverse = [] {
  std::array<double, 28> inverse{};
  for (std::size_t n = 1; n < inverse.size(); ++n) inverse[n] = 1.0 / static_cast<double>(n);
  return inverse;
}();

/// Integrals of x^k exp(-2 x) from 0 to d, k = 0, 1, 2.
struct DecayIntegrals {
  double k0, k1, k2;
};

DecayIntegrals decay_integrals(double d) {
  if (d > 0.5) {
    const double e = std::exp(-2.0 * d);
    return {0.5 * (1.0 - e),
            0.25 * (1.0 - e * (1.0 + 2.0 * d)),
            0.25 * (1.0 - e * (1.0 + 2.0 * d + 2.0 * d * d))};
  }
  // The closed forms cancel for small d: sum of d^(n + k + 1) (-2)^n / n! / (n + k + 1).
  DecayIntegrals sum{0.0, 0.0, 0.0};
  double term = d;
  for (std::size_t n = 0; n + 3 < kInverse.size() && std::abs(term) > 1e-18 * d; ++n) {
    sum.k0 += term * kInverse[n + 1];
    sum.k1 += term * kInverse[n + 2];
    sum.k2 += term * kInverse[n + 3];
    term *= -2.0 * d * kInverse[n + 1];
  }
  sum.k1 *= d;
  sum.k2 *= d * d;
  return sum;
}

/// Advances a first-order process of variance 1. @param change  exp(-d) - 1 of its d time constants
void advance_first_order(double& value, double change, double noise) {
  value += change * value + std::sqrt(-change * (2.0 + change)) * noise;
}

}  // namespace

TurbulenceScales dryden_scales(TurbulenceLevel level, double height_agl_m) {
  constexpr double kLowFt = 1000.0;
  constexpr double kHighFt = 2000.0;
  const auto row = static_cast<std::size_t>(level);
  const double height_ft = std::max(10.0, height_agl_m / kMPerFt);
  if (height_ft <= kLowFt) return low_scales(row, height_ft);
  if (height_ft >= kHighFt) return high_scales(row, height_ft);
  const TurbulenceScales low = low_scales(row, kLowFt);
  const TurbulenceScales high = high_scales(row, kHighFt);
  const double share = (height_ft - kLowFt) / (kHighFt - kLowFt);
  const auto mixed = [&](double a, double b) { return a + share * (b - a); };
  return {mixed(low.length_u_m, high.length_u_m),
          mixed(low.length_w_m, high.length_w_m),
          mixed(low.sigma_u_m_s, high.sigma_u_m_s),
          mixed(low.sigma_w_m_s, high.sigma_w_m_s)};
}

// The transverse filter (1 + sqrt(3) T s) / (1 + T s)^2 is sqrt(3) / (1 + T s) +
// (1 - sqrt(3)) / (1 + T s)^2: a sum of one lag and two lags of the same noise.
double Turbulence::Transverse::value() const {
  const double root3 = std::sqrt(3.0);
  return root3 * first + (1.0 - root3) * second;
}

/// @param lags  step over time constant, d
/// @param kept  exp(-d)
/// The states move by exp(-d) [1 0; d 1]; the noise of the
/// step has the covariance of the integrals of exp(-2 x) [1 x; x x^2].
void Turbulence::advance_transverse(Transverse& process, double lags, double kept) {
  const auto [first_noise, second_noise] = noise_.draw_pair();
  process.second = kept * (process.second + lags * process.first);
  process.first *= kept;
  if (lags <= 0.0) return;
  const DecayIntegrals q = decay_integrals(lags);
  const double l11 = std::sqrt(q.k0);
  const double l21 = q.k1 / l11;
  const double l22 = std::sqrt(std::max(0.0, q.k2 - l21 * l21));
  process.first += l11 * first_noise;
  process.second += l21 * first_noise + l22 * second_noise;
}

Turbulence::Turbulence(TurbulenceLevel level, double span_m, std::uint64_t seed)
    : level_(level), span_m_(span_m), noise_(seed) {
  const auto [along, roll] = noise_.draw_pair();
  along_ = along;
  roll_ = roll;
  // Stationary covariance [1/2 1/4; 1/4 1/4].
  for (Transverse* process : {&side_, &down_}) {
    const double root = std::sqrt(0.125);
    const auto [first, second] = noise_.draw_pair();
    process->first = 2.0 * root * first;
    process->second = 0.5 * process->first + root * second;
  }
}

void Turbulence::set_velocities(const TurbulenceScales& scales) {
  gust_.velocity_m_s = {scales.sigma_u_m_s * along_,
                        scales.sigma_u_m_s * side_.value(),
                        scales.sigma_w_m_s * down_.value()};
  // The integral of p's spectrum.
  const double variance = scales.sigma_w_m_s * scales.sigma_w_m_s / scales.length_w_m * 0.8 *
                          std::cbrt(kPi * scales.length_w_m / (4.0 * span_m_)) * kPi * kPi /
                          (8.0 * span_m_);
  gust_.rate_rad_s.x() = std::sqrt(variance) * roll_;
}

void Turbulence::advance(double airspeed_m_s, double height_agl_m, double dt_s) {
  const TurbulenceScales scales = dryden_scales(level_, height_agl_m);
  const double way_m = airspeed_m_s * dt_s;
  const double pitch_length_m = 4.0 * span_m_ / kPi;
  const double yaw_length_m = 3.0 * span_m_ / kPi;
  if (!started_) {
    started_ = true;
    set_velocities(scales);
    lagged_side_m_s_ = gust_.velocity_m_s.y();
    lagged_down_m_s_ = gust_.velocity_m_s.z();
  }
  const double lags_u = way_m / scales.length_u_m;
  const double lags_w = way_m / scales.length_w_m;
  const double change_u = std::expm1(-lags_u);
  const double change_pitch = std::expm1(-way_m / pitch_length_m);
  const double change_yaw = std::expm1(-way_m / yaw_length_m);
  // While the gust of the last step was met, the lags moved towards it.
  lagged_down_m_s_ += (lagged_down_m_s_ - gust_.velocity_m_s.z()) * change_pitch;
  lagged_side_m_s_ += (lagged_side_m_s_ - gust_.velocity_m_s.y()) * change_yaw;
  const auto [along_noise, roll_noise] = noise_.draw_pair();
  advance_first_order(along_, change_u, along_noise);
  advance_first_order(roll_, change_pitch, roll_noise);
  advance_transverse(side_, lags_u, 1.0 + change_u);
  advance_transverse(down_, lags_w, std::exp(-lags_w));
  set_velocities(scales);
  // s / (V + length s) of a gust is its difference to the lag, over the length.
  gust_.rate_rad_s.y() = -(gust_.velocity_m_s.z() - lagged_down_m_s_) / pitch_length_m;
  gust_.rate_rad_s.z() = (gust_.velocity_m_s.y() - lagged_side_m_s_) / yaw_length_m;
}

}  // namespace overfly::dynamics
