// Auto-exposure against steps of the light.
#include <gtest/gtest.h>

#include <cmath>
#include <tuple>

#include "core/motion/pose.hpp"
#include "tests/sensor/flat_field.hpp"

namespace overfly::sensor {
namespace {

using testing::sensor_of;
using testing::small_camera;

constexpr int kMeteredWidth = 160;
constexpr int kMeteredHeight = 120;

SensorModel automatic_sensor(const AutoExposure& automatic) {
  SensorModel model;
  model.enabled = true;
  model.shot_noise = true;
  model.read_noise_e = 8.0;
  model.exposure_s = 1e-3;
  model.electrons_per_s = 1e7;
  model.auto_exposure = automatic;
  return model;
}

/// Fields and roofs: radiances spread as those of aerial photographs, by a factor of 1.8 about a
/// mean of 0.15, times the light.
RadianceImage ground(double light) {
  RadianceImage image(kMeteredWidth, kMeteredHeight, 1);
  for (std::size_t i = 0; i < image.data.size(); ++i) {
    const double phase = static_cast<double>(i * 2654435761U % 1000U) / 1000.0;
    const double stops = 1.2 * std::sin(2.0 * kPi * phase);
    image.data[i] = static_cast<float>(0.135 * light * std::exp2(stops));
  }
  return image;
}

/// Linear level that the target grey stands for.
double target_level(const SensorModel& model) {
  return model.response.inverse(model.auto_exposure->target_mean);
}

/// Runs frames at one light. @return the levels
std::vector<double> run(Sensor& sensor, double light, int frames, std::int64_t& frame) {
  std::vector<double> levels;
  levels.reserve(static_cast<std::size_t>(frames));
  const RadianceImage image = ground(light);
  for (int i = 0; i < frames; ++i) levels.push_back(sensor.expose(image, frame++).mean_level);
  return levels;
}

class AutoExposureStep : public ::testing::TestWithParam<std::tuple<int, int, bool>> {};

TEST_P(AutoExposureStep, SettlesInTheStatedFramesWithoutOscillation) {
  const auto [stops, settle_frames, linear] = GetParam();
  AutoExposure automatic;
  automatic.settle_frames = settle_frames;
  if (linear) automatic.target_mean = 0.3;
  SensorModel model = automatic_sensor(automatic);
  if (linear) model.response = ResponseCurve::linear();
  const auto sensor = sensor_of(model, small_camera(kMeteredWidth, kMeteredHeight));
  std::int64_t frame = 0;
  const double target = target_level(model);
  run(*sensor, 1.0, 3 * settle_frames, frame);
  EXPECT_NEAR(run(*sensor, 1.0, 1, frame)[0] / target, 1.0, 0.02);
  // levels[0] is taken with the old setting: the first frame that shows the step.
  const auto levels = run(*sensor, std::exp2(stops), 3 * settle_frames, frame);
  for (std::size_t i = settle_frames; i < levels.size(); ++i) {
    EXPECT_NEAR(levels[i] / target, 1.0, 0.05) << "frame " << i << " after the step";
  }
  int crossings = 0;
  for (std::size_t i = 1; i < levels.size(); ++i) {
    // Within 2 % noise and whole nanoseconds decide the side.
    if (std::abs(levels[i] / target - 1.0) < 0.02) continue;
    crossings += (levels[i] > target) != (levels[i - 1] > target) ? 1 : 0;
  }
  EXPECT_LE(crossings, 1);
}

INSTANTIATE_TEST_SUITE_P(Steps,
                         AutoExposureStep,
                         ::testing::Combine(::testing::Values(-3, -2, -1, 1, 2, 3),
                                            ::testing::Values(4, 8, 20),
                                            ::testing::Bool()));

TEST(AutoExposure, PrefersExposureToGain) {
  AutoExposure automatic;
  automatic.max_exposure_s = 4e-3;
  automatic.max_gain = 4.0;
  const auto sensor =
      sensor_of(automatic_sensor(automatic), small_camera(kMeteredWidth, kMeteredHeight));
  std::int64_t frame = 0;
  for (const double light : {4.0, 1.0, 0.4, 0.2, 0.1, 0.02}) {
    run(*sensor, light, 40, frame);
    const ExposureSetting setting = sensor->next_setting();
    EXPECT_TRUE(setting.gain == 1.0 || setting.exposure_ns == 4'000'000) << light;
  }
  EXPECT_DOUBLE_EQ(sensor->next_setting().gain, 4.0) << "too dark: both at their ends";
  run(*sensor, 1000.0, 60, frame);
  EXPECT_EQ(sensor->next_setting().exposure_ns, 20'000) << "too bright: the shortest";
}

TEST(AutoExposure, TheRecordedSettingIsTheOneThatWasUsed) {
  const auto sensor = sensor_of(automatic_sensor({}), small_camera(kMeteredWidth, kMeteredHeight));
  for (std::int64_t frame = 0; frame < 10; ++frame) {
    const ExposureSetting next = sensor->next_setting();
    const SensorImage made = sensor->expose(ground(3.0), frame);
    EXPECT_EQ(made.setting.exposure_ns, next.exposure_ns);
    EXPECT_EQ(made.setting.gain, next.gain);
  }
}

TEST(AutoExposure, ComesBackFromDarknessAndFromGlare) {
  const SensorModel model = automatic_sensor({});
  const auto sensor = sensor_of(model, small_camera(kMeteredWidth, kMeteredHeight));
  std::int64_t frame = 0;
  run(*sensor, 0.0, 30, frame);
  EXPECT_GT(sensor->next_setting().gain, 1.0);
  run(*sensor, 1.0, 40, frame);
  EXPECT_NEAR(run(*sensor, 1.0, 1, frame)[0] / target_level(model), 1.0, 0.03);
  run(*sensor, 1e4, 30, frame);
  run(*sensor, 1.0, 40, frame);
  EXPECT_NEAR(run(*sensor, 1.0, 1, frame)[0] / target_level(model), 1.0, 0.03);
}

TEST(AutoExposure, IsBlindToTheBlackLevel) {
  SensorModel model = automatic_sensor({});
  model.black_level_dn = 10.0;
  const auto sensor = sensor_of(model, small_camera(kMeteredWidth, kMeteredHeight));
  std::int64_t frame = 0;
  run(*sensor, 1.0, 40, frame);
  const double black = 10.0 / 255.0;
  const double level = (run(*sensor, 1.0, 1, frame)[0] - black) / (1.0 - black);
  EXPECT_NEAR(level / target_level(model), 1.0, 0.03);
}

TEST(AutoExposure, FixedExposureStaysFixed) {
  SensorModel model = automatic_sensor({});
  model.auto_exposure.reset();
  const auto sensor = sensor_of(model, small_camera(kMeteredWidth, kMeteredHeight));
  std::int64_t frame = 0;
  run(*sensor, 8.0, 5, frame);
  EXPECT_EQ(sensor->next_setting().exposure_ns, 1'000'000);
  EXPECT_EQ(sensor->next_setting().gain, 1.0);
}

}  // namespace
}  // namespace overfly::sensor
