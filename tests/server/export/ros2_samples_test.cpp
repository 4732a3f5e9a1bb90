// What the messages of samples say of values that a sensor does not give.
#include "server/ros2/ros2_samples.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <limits>

namespace overfly::server {
namespace {

/// The end of a sensor_msgs/msg/NavSatFix.
struct FixCovariance {
  std::array<double, 9> values{};
  int type = -1;
};

FixCovariance fix_covariance(const GpsSample& sample) {
  SensorSamples samples;
  samples.gps.push_back(sample);
  FixCovariance covariance;
  const Status status =
      with_each_ros2_sample(samples, 0, [&](const Ros2SampleMessage& message) -> Status {
        if (message.topic != "/sensors/gps/fix") return {};
        const std::uint8_t* const type = &message.data.back();
        std::memcpy(
            covariance.values.data(), type - sizeof(covariance.values), sizeof(covariance.values));
        covariance.type = *type;
        return {};
      });
  EXPECT_TRUE(status);
  return covariance;
}

TEST(Ros2Samples, AFixOfKnownAccuracyHasItsVariances) {
  GpsSample sample;
  sample.horizontal_accuracy_m = 2.0;
  sample.vertical_accuracy_m = 3.0;
  const FixCovariance known = fix_covariance(sample);
  EXPECT_EQ(known.type, 2);  // COVARIANCE_TYPE_DIAGONAL_KNOWN
  EXPECT_EQ(known.values, (std::array<double, 9>{4, 0, 0, 0, 4, 0, 0, 0, 9}));
}

TEST(Ros2Samples, AFixOfUnknownAccuracyHasNoCovariance) {
  constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
  constexpr std::array<std::array<double, 2>, 3> kAccuracies{
      {{kUnknown, kUnknown}, {kUnknown, 3.0}, {2.0, kUnknown}}};
  for (const auto& [horizontal_m, vertical_m] : kAccuracies) {
    GpsSample sample;
    sample.horizontal_accuracy_m = horizontal_m;
    sample.vertical_accuracy_m = vertical_m;
    const FixCovariance unknown = fix_covariance(sample);
    EXPECT_EQ(unknown.type, 0);  // COVARIANCE_TYPE_UNKNOWN
    EXPECT_EQ(unknown.values, (std::array<double, 9>{}));
  }
}

}  // namespace
}  // namespace overfly::server
