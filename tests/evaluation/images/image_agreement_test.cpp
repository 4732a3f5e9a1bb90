#include "evaluation/images/image_agreement.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace overfly::evaluation {
namespace {

/// A sum of waves of all directions and lengths from 4 to 64 px: the exact image for any shift.
double pattern_at(double x, double y) {
  constexpr int kWaves = 40;
  double value = 0.0;
  for (int i = 0; i < kWaves; ++i) {
    const double angle = 2.39996 * i;
    const double length_px = 4.0 * std::pow(16.0, static_cast<double>(i) / kWaves);
    value += std::sin(2.0 * EIGEN_PI * (x * std::cos(angle) + y * std::sin(angle)) / length_px +
                      1.7 * i * i);
  }
  return 128.0 + 11.0 * value;
}

/// @param offset  of the content: right, down [px]
Image pattern_image(const Eigen::Vector2d& offset, double gain = 1.0, double bias = 0.0) {
  Image image(112, 84, 1);
  for (int y = 0; y < image.height_px; ++y) {
    for (int x = 0; x < image.width_px; ++x) {
      const double value = gain * pattern_at(x - offset.x(), y - offset.y()) + bias;
      image.at(x, y) = static_cast<std::uint8_t>(std::clamp(std::lround(value), 0L, 255L));
    }
  }
  return image;
}

TEST(ImageAgreement, OfEqualImagesIsPerfect) {
  const Image image = pattern_image({0.0, 0.0});
  const auto agreement = compare_images(image, image);
  ASSERT_TRUE(agreement.ok());
  EXPECT_LT(agreement->offset_px.value().norm(), 1e-3);
  EXPECT_NEAR(agreement->correlation.value_or(0.0), 1.0, 1e-12);
  EXPECT_NEAR(agreement->correlation_aligned.value_or(0.0), 1.0, 1e-3);
  EXPECT_EQ(agreement->corners_real, agreement->corners_virtual);
}

TEST(ImageAgreement, MeasuresTheOffsetOfTheRealImage) {
  const Eigen::Vector2d offsets[] = {{7.0, -4.0}, {-3.4, 2.6}, {0.3, 0.5}, {20.0, 9.0}};
  for (const Eigen::Vector2d& offset : offsets) {
    const auto agreement = compare_images(pattern_image(offset), pattern_image({0.0, 0.0}));
    ASSERT_TRUE(agreement.ok());
    // Grey levels are whole numbers, and the image is sampled bilinearly.
    EXPECT_LT((agreement->offset_px.value() - offset).norm(), 0.02)
        << agreement->offset_px->transpose() << " instead of " << offset.transpose();
    EXPECT_GT(agreement->correlation_aligned.value_or(0.0), 0.95);
    EXPECT_LT(*agreement->correlation, *agreement->correlation_aligned);
  }
}

TEST(ImageAgreement, DoesNotDependOnBrightnessAndContrast) {
  const auto agreement =
      compare_images(pattern_image({5.0, 3.0}, 0.5, 40.0), pattern_image({0.0, 0.0}));
  ASSERT_TRUE(agreement.ok());
  EXPECT_LT((agreement->offset_px.value() - Eigen::Vector2d(5.0, 3.0)).norm(), 0.02);
  EXPECT_GT(agreement->correlation_aligned.value_or(0.0), 0.95);
}

TEST(ImageAgreement, OfUniformImagesIsUnknown) {
  const auto agreement = compare_images(Image(64, 64, 1, 7), pattern_image({0.0, 0.0}));
  EXPECT_FALSE(agreement.ok());  // another size
  const auto uniform = compare_images(Image(112, 84, 1, 7), pattern_image({0.0, 0.0}));
  ASSERT_TRUE(uniform.ok());
  EXPECT_FALSE(uniform->correlation.has_value());
  EXPECT_FALSE(uniform->offset_px.has_value());
  EXPECT_FALSE(uniform->peak.has_value());
  EXPECT_EQ(uniform->corners_real, 0);
}

}  // namespace
}  // namespace overfly::evaluation
