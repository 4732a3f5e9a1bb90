// Dryden turbulence against the closed forms of its spectra.
#include "flight/dynamics/turbulence.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <functional>
#include <tuple>
#include <vector>

#include "core/motion/pose.hpp"

namespace overfly::dynamics {
namespace {

constexpr double kFt = 0.3048;
constexpr double kKn = 1852.0 / 3600.0;
constexpr double kSpeed = 25.0;
constexpr double kHeight = 100.0;
constexpr double kSpan = 4.27;

std::vector<Gust> record(double dt_s, int count, std::uint64_t seed, double height_m = kHeight) {
  Turbulence air(TurbulenceLevel::kModerate, kSpan, seed);
  std::vector<Gust> gusts;
  gusts.reserve(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) {
    air.advance(kSpeed, height_m, dt_s);
    gusts.push_back(air.gust());
  }
  return gusts;
}

using Pick = std::function<double(const Gust&)>;
double along(const Gust& g) { return g.velocity_m_s.x(); }
double across(const Gust& g) { return g.velocity_m_s.y(); }
double down(const Gust& g) { return g.velocity_m_s.z(); }

double covariance(const std::vector<Gust>& gusts, const Pick& pick, std::size_t lag) {
  double sum = 0.0;
  for (std::size_t i = 0; i + lag < gusts.size(); ++i) sum += pick(gusts[i]) * pick(gusts[i + lag]);
  return sum / static_cast<double>(gusts.size() - lag);
}

/// Integral of a one-sided spectrum over the spatial frequency, by substitution W = tan(x) / scale.
double variance_of(const std::function<double(double)>& spectrum, double scale_m) {
  constexpr int kParts = 200000;
  double sum = 0.0;
  for (int i = 0; i < kParts; ++i) {
    const double x = (i + 0.5) / kParts * 0.5 * kPi;
    const double w = std::tan(x) / scale_m;
    sum += spectrum(w) / (scale_m * std::pow(std::cos(x), 2)) * (0.5 * kPi / kParts);
  }
  return sum;
}

double transverse_spectrum(double sigma, double length_m, double w) {
  const double x = length_m * w * length_m * w;
  return sigma * sigma * length_m / kPi * (1.0 + 3.0 * x) / ((1.0 + x) * (1.0 + x));
}

TEST(DrydenScales, AreThoseOfTheSpecification) {
  // MIL-F-8785C at 200 ft, W20 = 30 kn: L_w = h, L_u = h / (0.177 + 0.000823 h)^1.2.
  const TurbulenceScales low = dryden_scales(TurbulenceLevel::kModerate, 200.0 * kFt);
  EXPECT_NEAR(low.length_w_m, 200.0 * kFt, 1e-9);
  EXPECT_NEAR(low.length_u_m, 200.0 / std::pow(0.3416, 1.2) * kFt, 1e-9);
  EXPECT_NEAR(low.sigma_w_m_s, 3.0 * kKn, 1e-12);
  EXPECT_NEAR(low.sigma_u_m_s, 3.0 * kKn / std::pow(0.3416, 0.4), 1e-12);
  // At 1000 ft the model is isotropic: 0.177 + 0.823 = 1.
  const TurbulenceScales top = dryden_scales(TurbulenceLevel::kSevere, 1000.0 * kFt);
  EXPECT_NEAR(top.length_u_m, top.length_w_m, 1e-9);
  EXPECT_NEAR(top.sigma_u_m_s, 4.5 * kKn, 1e-9);
  EXPECT_NEAR(dryden_scales(TurbulenceLevel::kLight, 50.0).sigma_w_m_s, 1.5 * kKn, 1e-12);
  // From 2000 ft: 1750 ft, and figure 7 at 3750 ft and 7500 ft.
  for (const auto& [level, sigma_ft_s, higher_ft_s] :
       {std::tuple{TurbulenceLevel::kLight, 7.4, 6.7},
        {TurbulenceLevel::kModerate, 10.6, 10.1},
        {TurbulenceLevel::kSevere, 23.0, 23.6}}) {
    const TurbulenceScales high = dryden_scales(level, 3750.0 * kFt);
    EXPECT_NEAR(high.length_u_m, 1750.0 * kFt, 1e-9);
    EXPECT_NEAR(high.sigma_u_m_s, sigma_ft_s * kFt, 1e-12);
    EXPECT_NEAR(high.sigma_w_m_s, sigma_ft_s * kFt, 1e-12);
    EXPECT_NEAR(dryden_scales(level, 7500.0 * kFt).sigma_u_m_s, higher_ft_s * kFt, 1e-9);
  }
}

TEST(DrydenScales, AreContinuousAndFiniteAtEveryHeight) {
  for (const auto level :
       {TurbulenceLevel::kLight, TurbulenceLevel::kModerate, TurbulenceLevel::kSevere}) {
    for (double height_m = -100.0; height_m < 30000.0; height_m += 1.0) {
      const TurbulenceScales a = dryden_scales(level, height_m);
      const TurbulenceScales b = dryden_scales(level, height_m + 1.0);
      ASSERT_NEAR(a.sigma_u_m_s, b.sigma_u_m_s, 0.05);
      ASSERT_NEAR(a.length_u_m, b.length_u_m, 10.0);
      ASSERT_GT(a.length_w_m, 3.0);
      ASSERT_GE(a.sigma_w_m_s, 0.0);
    }
  }
}

TEST(Turbulence, HasTheCovarianceOfTheSpectraForEveryStep) {
  const TurbulenceScales s = dryden_scales(TurbulenceLevel::kModerate, kHeight);
  const double u2 = s.sigma_u_m_s * s.sigma_u_m_s;
  const double w2 = s.sigma_w_m_s * s.sigma_w_m_s;
  // From far below the time constants (10.5 s and 4 s) to far above.
  for (const double dt_s : {0.5, 4.0, 20.0}) {
    const auto gusts = record(dt_s, 400000, 11);
    for (const std::size_t lag : {0U, 1U, 2U}) {
      const double t_u = dt_s * static_cast<double>(lag) * kSpeed / s.length_u_m;
      const double t_w = dt_s * static_cast<double>(lag) * kSpeed / s.length_w_m;
      // 400 000 samples, correlated over up to 40: four standard deviations are 4 %.
      EXPECT_NEAR(covariance(gusts, along, lag) / u2, std::exp(-t_u), 0.04) << dt_s;
      // The transform of (1 + 3 x^2) / (1 + x^2)^2.
      EXPECT_NEAR(covariance(gusts, across, lag) / u2, std::exp(-t_u) * (1.0 - 0.5 * t_u), 0.04);
      EXPECT_NEAR(covariance(gusts, down, lag) / w2, std::exp(-t_w) * (1.0 - 0.5 * t_w), 0.04);
    }
    double mean = 0.0;
    for (const Gust& gust : gusts) mean += gust.velocity_m_s.x();
    EXPECT_NEAR(mean / 400000.0, 0.0, 0.04 * s.sigma_u_m_s);
  }
}

/// One-sided power spectral density [(m/s)^2 / (rad/s)] by averaged Hann periodograms.
double density_at(const std::vector<Gust>& gusts, const Pick& pick, double dt_s, int bin) {
  constexpr std::size_t kLength = 4096;
  double sum = 0.0;
  std::size_t segments = 0;
  double window2 = 0.0;
  for (std::size_t i = 0; i < kLength; ++i) {
    const double h = 0.5 - 0.5 * std::cos(2.0 * kPi * static_cast<double>(i) / kLength);
    window2 += h * h;
  }
  for (std::size_t start = 0; start + kLength <= gusts.size(); start += kLength / 2, ++segments) {
    std::complex<double> transform = 0.0;
    for (std::size_t i = 0; i < kLength; ++i) {
      const double phase = 2.0 * kPi * bin * static_cast<double>(i) / kLength;
      const double h = 0.5 - 0.5 * std::cos(2.0 * kPi * static_cast<double>(i) / kLength);
      transform += h * pick(gusts[start + i]) * std::polar(1.0, -phase);
    }
    sum += std::norm(transform);
  }
  return sum / static_cast<double>(segments) * dt_s / window2 / kPi;
}

TEST(Turbulence, HasTheSpectraOfTheSpecification) {
  constexpr double kDt = 0.02;
  const auto gusts = record(kDt, 1000000, 3);
  const TurbulenceScales s = dryden_scales(TurbulenceLevel::kModerate, kHeight);
  const double b = kSpan;
  // Bins of 0.0767 rad/s; the highest lies far below the fold at 157 rad/s.
  for (const int bin : {4, 12, 40, 130}) {
    const double omega = 2.0 * kPi * bin / (4096.0 * kDt);
    const double w = omega / kSpeed;
    const double u = s.sigma_u_m_s * s.sigma_u_m_s * 2.0 * s.length_u_m / kPi /
                     (1.0 + std::pow(s.length_u_m * w, 2));
    const double down_w = transverse_spectrum(s.sigma_w_m_s, s.length_w_m, w);
    const double roll = s.sigma_w_m_s * s.sigma_w_m_s / s.length_w_m * 0.8 *
                        std::cbrt(kPi * s.length_w_m / (4.0 * b)) /
                        (1.0 + std::pow(4.0 * b * w / kPi, 2));
    const double pitch = w * w / (1.0 + std::pow(4.0 * b * w / kPi, 2)) * down_w;
    const double yaw = w * w / (1.0 + std::pow(3.0 * b * w / kPi, 2)) *
                       transverse_spectrum(s.sigma_u_m_s, s.length_u_m, w);
    // 487 overlapping segments: one standard deviation is about 6 %. The spectra span factors of
    // 1000, and a wrong time constant or factor of 2 is far outside.
    const auto near = [&](const Pick& pick, double expected) {
      EXPECT_NEAR(density_at(gusts, pick, kDt, bin) * kSpeed / expected, 1.0, 0.22) << bin;
    };
    near(along, u);
    near(across, transverse_spectrum(s.sigma_u_m_s, s.length_u_m, w));
    near(down, down_w);
    near([](const Gust& g) { return g.rate_rad_s.x(); }, roll);
    near([](const Gust& g) { return g.rate_rad_s.y(); }, pitch);
    near([](const Gust& g) { return g.rate_rad_s.z(); }, yaw);
  }
}

TEST(Turbulence, RatesHaveTheVarianceOfTheirSpectra) {
  const TurbulenceScales s = dryden_scales(TurbulenceLevel::kModerate, kHeight);
  const double b = kSpan;
  const auto gusts = record(0.01, 1500000, 5);
  const double roll = variance_of(
      [&](double w) {
        return s.sigma_w_m_s * s.sigma_w_m_s / s.length_w_m * 0.8 *
               std::cbrt(kPi * s.length_w_m / (4.0 * b)) / (1.0 + std::pow(4.0 * b * w / kPi, 2));
      },
      b);
  const double pitch = variance_of(
      [&](double w) {
        return w * w / (1.0 + std::pow(4.0 * b * w / kPi, 2)) *
               transverse_spectrum(s.sigma_w_m_s, s.length_w_m, w);
      },
      b);
  EXPECT_NEAR(covariance(
                  gusts, [](const Gust& g) { return g.rate_rad_s.x(); }, 0) /
                  roll,
              1.0,
              0.04);
  // Gusts that are constant during steps of 0.25 m, and a filter of 5.4 m: 3 % of bias.
  EXPECT_NEAR(covariance(
                  gusts, [](const Gust& g) { return g.rate_rad_s.y(); }, 0) /
                  pitch,
              1.0,
              0.08);
}

TEST(Turbulence, SignsAreThoseOfRotatingAir) {
  // Where the downward gust grows along the way, the air rotates nose up: -q x = dw.
  const auto gusts = record(0.01, 20000, 9);
  double pitch = 0.0, yaw = 0.0;
  for (std::size_t i = 1; i < gusts.size(); ++i) {
    pitch += (down(gusts[i]) - down(gusts[i - 1])) * gusts[i].rate_rad_s.y();
    yaw += (across(gusts[i]) - across(gusts[i - 1])) * gusts[i].rate_rad_s.z();
  }
  EXPECT_LT(pitch, 0.0);
  EXPECT_GT(yaw, 0.0);
}

TEST(Turbulence, IsAFunctionOfItsSeed) {
  const auto a = record(0.0025, 2000, 1);
  const auto b = record(0.0025, 2000, 1);
  const auto c = record(0.0025, 2000, 2);
  for (std::size_t i = 0; i < a.size(); ++i) {
    ASSERT_EQ(a[i].velocity_m_s, b[i].velocity_m_s);
    ASSERT_EQ(a[i].rate_rad_s, b[i].rate_rad_s);
    ASSERT_NE(a[i].velocity_m_s, c[i].velocity_m_s);
  }
}

TEST(Turbulence, StandsStillWithTheAircraft) {
  Turbulence air(TurbulenceLevel::kSevere, kSpan, 4);
  air.advance(0.0, 50.0, 0.01);
  const Gust first = air.gust();
  for (int i = 0; i < 100; ++i) air.advance(0.0, 50.0, 0.01);
  EXPECT_LT((air.gust().velocity_m_s - first.velocity_m_s).norm(), 1e-12);
  EXPECT_GT(first.velocity_m_s.norm(), 0.0);
  EXPECT_EQ(first.rate_rad_s.y(), 0.0);
}

}  // namespace
}  // namespace overfly::dynamics
