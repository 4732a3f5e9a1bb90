// What flash, dirt, drops and darkness do to the light.
#include "sensor/image_faults.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/motion/pose.hpp"
#include "tests/sensor/flat_field.hpp"

namespace overfly::sensor {
namespace {

using testing::flat_field;

constexpr int kFaultyWidth = 320;
constexpr int kFaultyHeight = 240;

RadianceImage spoiled(const ImageFault& fault, RadianceImage image) {
  apply_fault(fault, image);
  return image;
}

/// Rises by 0.001 a column.
RadianceImage slope() {
  RadianceImage image(kFaultyWidth, kFaultyHeight, 1);
  for (int y = 0; y < kFaultyHeight; ++y) {
    for (int x = 0; x < kFaultyWidth; ++x) image.at(x, y) = 0.1F + 0.001F * static_cast<float>(x);
  }
  return image;
}

TEST(ImageFaults, NamesAndKindsAreOneToOne) {
  for (const auto kind : {ImageFaultKind::kSaturation,
                          ImageFaultKind::kDirt,
                          ImageFaultKind::kWaterDrop,
                          ImageFaultKind::kBlackout}) {
    EXPECT_EQ(image_fault_kind_from(to_string(kind)), kind);
  }
  EXPECT_FALSE(image_fault_kind_from("rain"));
}

TEST(ImageFaults, BlackoutTakesItsShareOfTheLight) {
  for (const double strength : {0.25, 1.0}) {
    ImageFault fault;
    fault.strength = strength;
    for (const float value : spoiled(fault, flat_field(64, 48, 0.4F, 3)).data) {
      ASSERT_NEAR(value, 0.4 * (1.0 - strength), 1e-7);
    }
  }
}

TEST(ImageFaults, SaturationWithoutRadiusAddsTheSameEverywhere) {
  const ImageFault fault{ImageFaultKind::kSaturation, 2.5, 0.0, 0, 1};
  for (const float value : spoiled(fault, flat_field(64, 48, 0.4F)).data) {
    ASSERT_NEAR(value, 2.9F, 1e-6F);
  }
}

TEST(ImageFaults, GlareFallsOffAsAGaussianAroundItsPlace) {
  const ImageFault fault{ImageFaultKind::kSaturation, 8.0, 25.0, 0, 11};
  const RadianceImage glare = spoiled(fault, flat_field(kFaultyWidth, kFaultyHeight, 0.0F));
  const auto peak = std::max_element(glare.data.begin(), glare.data.end());
  const auto at = static_cast<int>(peak - glare.data.begin());
  const int x0 = at % kFaultyWidth;
  const int y0 = at / kFaultyWidth;
  EXPECT_NEAR(*peak, 8.0, 0.01) << "the place is at most half a pixel from this one";
  // ln(peak / value) = r^2 / (2 sigma^2): the middle by a parabola, then the width.
  const auto log_at = [&](int x, int y) { return std::log(static_cast<double>(glare.at(x, y))); };
  const int step = x0 + 20 < kFaultyWidth && x0 >= 20 ? 1 : 0;
  ASSERT_EQ(step, 1) << "this seed's place is too near to the edge for the test";
  const double curvature = log_at(x0 + 20, y0) + log_at(x0 - 20, y0) - 2.0 * log_at(x0, y0);
  EXPECT_NEAR(std::sqrt(-400.0 / curvature), 25.0, 0.01);
}

TEST(ImageFaults, FlashSaturatesTheSensor) {
  SensorModel model;
  model.enabled = true;
  const auto sensor = testing::sensor_of(model, testing::small_camera(kFaultyWidth, kFaultyHeight));
  const RadianceImage light = slope();
  EXPECT_EQ(sensor->expose(light, 0).saturated_fraction, 0.0);
  const ImageFault fault{ImageFaultKind::kSaturation, 5.0, 0.0, 0, 1};
  const SensorImage flashed = sensor->expose(spoiled(fault, light), 1);
  EXPECT_EQ(flashed.saturated_fraction, 1.0);
  EXPECT_EQ(flashed.image.at(7, 9), 255);
}

TEST(ImageFaults, DirtOnlyDarkensAndStaysInItsPlace) {
  const ImageFault fault{ImageFaultKind::kDirt, 0.6, 12.0, 8, 3};
  const RadianceImage first = spoiled(fault, flat_field(kFaultyWidth, kFaultyHeight, 0.5F));
  const RadianceImage brighter = spoiled(fault, flat_field(kFaultyWidth, kFaultyHeight, 0.8F));
  std::size_t touched = 0;
  float darkest = 1.0F;
  for (std::size_t i = 0; i < first.data.size(); ++i) {
    ASSERT_LE(first.data[i], 0.5F);
    ASSERT_NEAR(first.data[i] / 0.5F, brighter.data[i] / 0.8F, 1e-6F) << "the same transmission";
    touched += first.data[i] < 0.5F ? 1 : 0;
    darkest = std::min(darkest, first.data[i] / 0.5F);
  }
  // Eight discs of radius 12 * (0.5 to 1.5), some of them cut by the edge or upon another.
  EXPECT_GT(touched, 8.0 * kPi * 36.0 * 0.5);
  EXPECT_LT(touched, 8.0 * kPi * 324.0);
  EXPECT_LT(darkest, 0.7F);
  const ImageFault other{ImageFaultKind::kDirt, 0.6, 12.0, 8, 4};
  EXPECT_NE(spoiled(other, flat_field(kFaultyWidth, kFaultyHeight, 0.5F)).data, first.data);
}

TEST(ImageFaults, ADropShowsATurnedImageInsideItsRimAndNothingOutside) {
  const ImageFault fault{ImageFaultKind::kWaterDrop, 1.0, 30.0, 1, 58};
  const RadianceImage before = slope();
  const RadianceImage after = spoiled(fault, before);
  double sum_x = 0.0;
  double sum_y = 0.0;
  std::size_t touched = 0;
  for (int y = 0; y < kFaultyHeight; ++y) {
    for (int x = 0; x < kFaultyWidth; ++x) {
      if (after.at(x, y) == before.at(x, y)) continue;
      sum_x += x;
      sum_y += y;
      ++touched;
    }
  }
  const int x0 = static_cast<int>(std::lround(sum_x / static_cast<double>(touched)));
  const int y0 = static_cast<int>(std::lround(sum_y / static_cast<double>(touched)));
  EXPECT_NEAR(static_cast<double>(touched), kPi * 900.0, 0.1 * kPi * 900.0);
  ASSERT_GT(x0, 100) << "this seed's place is too near to the edge for the test";
  ASSERT_LT(x0, kFaultyWidth - 100);
  // The ground rises by 0.001 a pixel; a drop three times as wide turned by 180 deg falls by 0.003.
  const double fall = (after.at(x0 + 10, y0) - after.at(x0 - 10, y0)) / 20.0;
  EXPECT_NEAR(fall, -0.003, 2e-4);
  EXPECT_EQ(after.at(x0 + 32, y0), before.at(x0 + 32, y0));
}

TEST(ImageFaults, FaultsOutsideTheirLimitsAreNamed) {
  const auto message = [](const ImageFault& fault) {
    const Status status = fault.validate();
    return status ? std::string("accepted") : status.error().message;
  };
  EXPECT_EQ(message({}), "accepted");
  EXPECT_EQ(message({ImageFaultKind::kSaturation, 50.0, 0.0, 0, 1}), "accepted");
  EXPECT_NE(message({ImageFaultKind::kBlackout, 1.5, 0.0, 0, 1}).find("strength = 1.5"),
            std::string::npos);
  EXPECT_NE(message({ImageFaultKind::kDirt, 0.5, 0.0, 0, 1}).find("radius_px = 0"),
            std::string::npos);
  EXPECT_NE(message({ImageFaultKind::kWaterDrop, 0.5, 5.0, 1001, 1}).find("count = 1001"),
            std::string::npos);
}

}  // namespace
}  // namespace overfly::sensor
