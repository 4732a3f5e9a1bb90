// The linear camera model of EMVA 1288 (release 4.0, section 2): the variance of the digital
// numbers over their mean is K, and the intercept is the dark noise.
#include <gtest/gtest.h>

#include <cmath>
#include <tuple>

#include "tests/sensor/flat_field.hpp"

namespace overfly::sensor {
namespace {

using testing::flat_field;
using testing::Moments;
using testing::moments_of;
using testing::sensor_of;
using testing::small_camera;
using testing::values_of;

constexpr int kTransferWidth = 512;
constexpr int kTransferHeight = 384;

SensorModel noisy_sensor(int bits, double gain_dn_per_e, double read_noise_e) {
  SensorModel model;
  model.enabled = true;
  model.bits = bits;
  model.response = ResponseCurve::linear();
  model.exposure_s = 1e-3;
  model.electrons_per_s = 2e7;  // 20000 e at radiance 1
  model.shot_noise = true;
  model.read_noise_e = read_noise_e;
  model.gain_dn_per_e = gain_dn_per_e;
  return model;
}

struct TransferPoint {
  double mean = 0.0;
  double variance = 0.0;  ///< temporal
};

/// From two frames of the same light.
TransferPoint transfer_point(Sensor& sensor, const RadianceImage& light, std::int64_t frame) {
  const auto numbers = [&](std::int64_t of_frame) {
    const SensorImage made = sensor.expose(light, of_frame);
    return made.image16.empty() ? values_of(made.image) : values_of(made.image16);
  };
  const std::vector<double> a = numbers(frame);
  std::vector<double> difference = numbers(frame + 1);
  for (std::size_t i = 0; i < a.size(); ++i) difference[i] -= a[i];
  return {moments_of(a).mean, 0.5 * moments_of(difference).variance};
}

struct Line {
  double slope = 0.0;
  double slope_sigma = 0.0;  ///< of the estimate
  double intercept = 0.0;
  double intercept_sigma = 0.0;
};

/// Weighted least squares: a variance from n differences is known to sqrt(2 / n) of itself.
Line fitted(const std::vector<TransferPoint>& points) {
  double w = 0.0;
  double wx = 0.0;
  double wy = 0.0;
  double wxx = 0.0;
  double wxy = 0.0;
  for (const auto& [x, y] : points) {
    const double sigma = y * std::sqrt(2.0 / (kTransferWidth * kTransferHeight));
    const double weight = 1.0 / (sigma * sigma);
    w += weight;
    wx += weight * x;
    wy += weight * y;
    wxx += weight * x * x;
    wxy += weight * x * y;
  }
  const double determinant = w * wxx - wx * wx;
  Line line;
  line.slope = (w * wxy - wx * wy) / determinant;
  line.slope_sigma = std::sqrt(w / determinant);
  line.intercept = (wy - line.slope * wx) / w;
  line.intercept_sigma = std::sqrt(wxx / determinant);
  return line;
}

class PhotonTransfer : public ::testing::TestWithParam<std::tuple<int, double, double>> {};

TEST_P(PhotonTransfer, SlopeIsTheGainAndInterceptTheDarkNoise) {
  const auto [bits, gain, read_noise_e] = GetParam();
  SensorModel model = noisy_sensor(bits, gain, read_noise_e);
  // Keeps the darkest points' noise away from zero, where it would be clipped.
  model.black_level_dn = 8.0 * gain * read_noise_e;
  std::vector<TransferPoint> points;
  const double full_scale_e = ((1 << bits) - 1 - model.black_level_dn) / gain;
  std::int64_t frame = 0;
  for (const double exposure_s : {0.25e-3, 0.5e-3, 1e-3, 2e-3}) {
    model.exposure_s = exposure_s;
    const auto sensor = sensor_of(model, small_camera(kTransferWidth, kTransferHeight));
    for (const double share : {0.0, 0.002, 0.01, 0.05, 0.2, 0.6}) {
      const auto radiance =
          static_cast<float>(share * full_scale_e / (model.electrons_per_s * exposure_s));
      points.push_back(
          transfer_point(*sensor, flat_field(kTransferWidth, kTransferHeight, radiance), frame));
      points.back().mean -= model.black_level_dn;
      // Quantisation and gain are unbiased: the mean is known to sigma / sqrt(n).
      EXPECT_NEAR(points.back().mean,
                  share * full_scale_e * gain,
                  5.0 * std::sqrt(points.back().variance / (kTransferWidth * kTransferHeight)) +
                      1e-6 * (1 << bits))
          << share;
      frame += 2;
    }
  }
  const Line line = fitted(points);
  EXPECT_NEAR(line.slope, gain, 4.0 * line.slope_sigma);
  EXPECT_LT(line.slope_sigma, 2e-3 * gain);
  // Rounding to whole numbers adds 1/12 (EMVA 1288, equation 9).
  const double dark_variance = gain * gain * read_noise_e * read_noise_e + 1.0 / 12.0;
  EXPECT_NEAR(line.intercept, dark_variance, 4.0 * line.intercept_sigma);
  EXPECT_LT(line.intercept_sigma, 1e-2 * dark_variance);
}

INSTANTIATE_TEST_SUITE_P(DepthsGainsAndReadNoises,
                         PhotonTransfer,
                         ::testing::Values(std::tuple{8, 0.05, 20.0},
                                           std::tuple{10, 0.1, 10.0},
                                           std::tuple{12, 0.25, 8.0},
                                           std::tuple{12, 1.0, 3.0},
                                           std::tuple{16, 2.0, 2.0},
                                           std::tuple{16, 4.0, 15.0}));

TEST(PhotonTransferOfChain, DoublingTheExposureDoublesTheNumbers) {
  SensorModel model = noisy_sensor(12, 0.2, 4.0);
  const RadianceImage light = flat_field(kTransferWidth, kTransferHeight, 0.2F);
  double before = 0.0;
  for (const double exposure_s : {0.25e-3, 0.5e-3, 1e-3, 2e-3}) {
    model.exposure_s = exposure_s;
    const SensorImage made =
        sensor_of(model, small_camera(kTransferWidth, kTransferHeight))->expose(light, 4);
    const double mean = moments_of(values_of(made.image16)).mean;
    EXPECT_EQ(made.setting.exposure_ns, std::llround(exposure_s * 1e9));
    // 200 e with a standard deviation of 15 over 2e5 pixels: the mean is known to 2e-4.
    if (before > 0.0) {
      EXPECT_NEAR(mean / before, 2.0, 2e-3);
    }
    before = mean;
  }
}

TEST(PhotonTransferOfChain, ShotNoiseIsClippedAtTheFullWell) {
  SensorModel model = noisy_sensor(16, 4.0, 0.0);
  model.full_well_e = 8000.0;
  const auto sensor = sensor_of(model, small_camera(kTransferWidth, kTransferHeight));
  const SensorImage below = sensor->expose(flat_field(kTransferWidth, kTransferHeight, 0.2F), 0);
  EXPECT_EQ(below.saturated_fraction, 0.0);
  const SensorImage at_the_edge =
      sensor->expose(flat_field(kTransferWidth, kTransferHeight, 0.4F), 0);
  EXPECT_NEAR(at_the_edge.saturated_fraction, 0.5, 0.01);
  const SensorImage above = sensor->expose(flat_field(kTransferWidth, kTransferHeight, 0.8F), 0);
  EXPECT_EQ(above.saturated_fraction, 1.0);
  for (const std::uint16_t number : above.image16.data) ASSERT_EQ(number, 32000);
  model.read_noise_e = 5.0;
  const SensorImage read = sensor_of(model, small_camera(kTransferWidth, kTransferHeight))
                               ->expose(flat_field(kTransferWidth, kTransferHeight, 0.8F), 0);
  EXPECT_EQ(read.saturated_fraction, 1.0);
  const Moments m = moments_of(values_of(read.image16));
  EXPECT_NEAR(std::sqrt(m.variance), 20.0, 0.3) << "the read noise comes after the well";
}

TEST(PhotonTransferOfChain, PatternsStayWithTheSensorAndFollowTheirModel) {
  SensorModel model = noisy_sensor(16, 1.0, 0.0);
  model.shot_noise = false;
  model.prnu = 0.02;
  model.dsnu_e = 30.0;
  const CameraModel camera = small_camera(kTransferWidth, kTransferHeight);
  const auto sensor = sensor_of(model, camera, 4);
  const auto bright =
      values_of(sensor->expose(flat_field(kTransferWidth, kTransferHeight, 0.5F), 0).image16);
  const auto again =
      values_of(sensor->expose(flat_field(kTransferWidth, kTransferHeight, 0.5F), 1).image16);
  EXPECT_EQ(bright, again);
  // 10000 e: EMVA 1288's sigma^2 = DSNU^2 + (PRNU mu)^2.
  EXPECT_NEAR(std::sqrt(moments_of(bright).variance), std::hypot(30.0, 0.02 * 10000.0), 1.5);
  const auto other = sensor_of(model, camera, 5);
  const auto elsewhere =
      values_of(other->expose(flat_field(kTransferWidth, kTransferHeight, 0.5F), 0).image16);
  EXPECT_NEAR(testing::correlation(bright, elsewhere),
              0.0,
              5.0 / std::sqrt(kTransferWidth * kTransferHeight));
}

}  // namespace
}  // namespace overfly::sensor
