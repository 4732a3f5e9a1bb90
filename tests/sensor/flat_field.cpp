#include "tests/sensor/flat_field.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>

#include "core/motion/pose.hpp"

namespace overfly::testing {

CameraModel small_camera(int width_px, int height_px) {
  return PinholeCamera::from_fov(width_px, height_px, rad_from_deg(80.0), FovAxis::kHorizontal)
      .value();
}

RadianceImage flat_field(int width_px, int height_px, float radiance, int channels) {
  return {width_px, height_px, channels, radiance};
}

std::unique_ptr<sensor::Sensor> sensor_of(const sensor::SensorModel& model,
                                          const CameraModel& camera,
                                          std::uint64_t seed,
                                          sensor::VectorUnits units) {
  auto sensor = sensor::Sensor::create(model, camera, seed, units);
  EXPECT_TRUE(sensor.ok()) << sensor.error().message;
  return std::move(*sensor);
}

sensor::SensorModel counting_sensor() {
  sensor::SensorModel model;
  model.enabled = true;
  model.bits = 16;
  model.response = sensor::ResponseCurve::linear();
  model.exposure_s = 1e-3;
  model.electrons_per_s = 65535.0 / 1e-3;
  model.gain_dn_per_e = 1.0;
  return model;
}

Moments moments_of(const std::vector<double>& values) {
  Moments moments;
  moments.count = values.size();
  const auto n = static_cast<double>(values.size());
  for (const double value : values) moments.mean += value / n;
  double third = 0.0;
  double fourth = 0.0;
  for (const double value : values) {
    const double d = value - moments.mean;
    moments.variance += d * d / (n - 1.0);
    third += d * d * d / n;
    fourth += d * d * d * d / n;
  }
  const double sigma = std::sqrt(moments.variance);
  moments.skewness = third / (sigma * sigma * sigma);
  moments.excess_kurtosis = fourth / (moments.variance * moments.variance) - 3.0;
  return moments;
}

double correlation(const std::vector<double>& a, const std::vector<double>& b) {
  const Moments of_a = moments_of(a);
  const Moments of_b = moments_of(b);
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - of_a.mean) * (b[i] - of_b.mean);
  return sum / (static_cast<double>(a.size()) * std::sqrt(of_a.variance * of_b.variance));
}

std::vector<double> values_of(const Image16& image) {
  return {image.data.begin(), image.data.end()};
}
std::vector<double> values_of(const Image& image) { return {image.data.begin(), image.data.end()}; }

}  // namespace overfly::testing
