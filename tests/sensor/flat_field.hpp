// Even light and the statistics of what a sensor makes of it.
#pragma once

#include <memory>
#include <vector>

#include "sensor/sensor.hpp"

namespace overfly::testing {

[[nodiscard]] CameraModel small_camera(int width_px, int height_px);
[[nodiscard]] RadianceImage flat_field(int width_px,
                                       int height_px,
                                       float radiance,
                                       int channels = 1);

/// Fails the test when the sensor cannot be made.
[[nodiscard]] std::unique_ptr<sensor::Sensor> sensor_of(
    const sensor::SensorModel& model,
    const CameraModel& camera,
    std::uint64_t seed = 1,
    sensor::VectorUnits units = sensor::VectorUnits::kBest);

/// A sensor for measuring: 16 bit, linear, no stage; one number is one electron, and radiance 1
/// leaves 65535 of them in a millisecond.
[[nodiscard]] sensor::SensorModel counting_sensor();

struct Moments {
  double mean = 0.0;
  double variance = 0.0;
  double skewness = 0.0;
  double excess_kurtosis = 0.0;
  std::size_t count = 0;
};

[[nodiscard]] Moments moments_of(const std::vector<double>& values);
/// Of two series of equal length.
[[nodiscard]] double correlation(const std::vector<double>& a, const std::vector<double>& b);

[[nodiscard]] std::vector<double> values_of(const Image16& image);
[[nodiscard]] std::vector<double> values_of(const Image& image);

}  // namespace overfly::testing
