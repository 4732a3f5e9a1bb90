#include "server/views/images/colour_map.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>

namespace overfly::server {
namespace {

constexpr float kSky = std::numeric_limits<float>::infinity();

DepthImage depth_ramp(float from, float to) {
  DepthImage depth(100, 10, 1);
  for (int y = 0; y < 10; ++y) {
    for (int x = 0; x < 100; ++x) {
      depth.at(x, y) = from + (to - from) * static_cast<float>(x) / 99.0F;
    }
  }
  return depth;
}

std::array<int, 3> rgb(const Image& image, int x, int y) {
  return {image.at(x, y, 0), image.at(x, y, 1), image.at(x, y, 2)};
}

/// CIE luminance of an sRGB colour.
double luminance(const std::array<int, 3>& colour) {
  const auto linear = [](int value) {
    const double v = value / 255.0;
    return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
  };
  return 0.2126 * linear(colour[0]) + 0.7152 * linear(colour[1]) + 0.0722 * linear(colour[2]);
}

TEST(DepthScale, HasRoundEndsAroundTheDepths) {
  const ColourScale scale = depth_scale(depth_ramp(283.0F, 347.0F));
  EXPECT_FALSE(scale.logarithmic);
  EXPECT_EQ(scale.low, 280.0);
  EXPECT_EQ(scale.high, 350.0);
  EXPECT_EQ(depth_scale(depth_ramp(284.0F, 346.0F)), scale) << "a little nearer: the same colours";
}

TEST(DepthScale, IsLogarithmicWhereTheHorizonIsInView) {
  DepthImage depth = depth_ramp(310.0F, 9000.0F);
  depth.at(3, 3) = kSky;
  const ColourScale scale = depth_scale(depth);
  EXPECT_TRUE(scale.logarithmic);
  EXPECT_EQ(scale.low, 200.0);
  EXPECT_EQ(scale.high, 10000.0);
}

TEST(DepthScale, IsEmptyIfEveryPixelSeesTheSky) {
  const DepthImage sky(8, 8, 1, kSky);
  const ColourScale scale = depth_scale(sky);
  EXPECT_EQ(scale, ColourScale{});
  EXPECT_EQ(rgb(coloured_depth(sky, scale), 4, 4), (std::array<int, 3>{118, 118, 122}));
}

TEST(ColouredDepth, GetsDarkerWithDistance) {
  DepthImage depth = depth_ramp(100.0F, 200.0F);
  depth.at(50, 9) = kSky;
  const Image image = coloured_depth(depth, {100.0, 200.0, false});
  EXPECT_EQ(rgb(image, 0, 0), (std::array<int, 3>{250, 237, 161}));
  EXPECT_EQ(rgb(image, 99, 0), (std::array<int, 3>{41, 19, 91}));
  EXPECT_EQ(rgb(image, 50, 9), (std::array<int, 3>{118, 118, 122}));
  for (int x = 5; x < 100; x += 5) {
    EXPECT_LT(luminance(rgb(image, x, 0)), luminance(rgb(image, x - 5, 0))) << x;
  }
}

TEST(ColouredDepth, PlacesTheGeometricMeanInTheMiddleOfALogarithmicScale) {
  const DepthImage middle(1, 1, 1, 1000.0F);
  EXPECT_EQ(rgb(coloured_depth(middle, {100.0, 10000.0, true}), 0, 0),
            rgb(coloured_depth(middle, {500.0, 1500.0, false}), 0, 0));
}

TEST(GreyDifference, KeepsItsSignAndTakesTheLumaOfColours) {
  Image a(2, 1, 1);
  a.data = {10, 250};
  Image b(2, 1, 3);
  b.data = {30, 30, 30, 255, 0, 0};
  const auto difference = grey_difference(a, b);
  EXPECT_EQ(difference.at(0, 0), -20);
  EXPECT_EQ(difference.at(1, 0), 250 - 76) << "luma of red: 0.299 * 255";
}

TEST(DifferenceScale, IsThePowerOfTwoThatNearlyAllAreBelow) {
  ImageBuffer<std::int16_t> difference(100, 10, 1, 3);
  EXPECT_EQ(difference_scale(difference), (ColourScale{-4.0, 4.0, false}));
  for (std::size_t i = 0; i < 50; ++i) difference.data[i] = -20;
  EXPECT_EQ(difference_scale(difference), (ColourScale{-32.0, 32.0, false}));
  for (std::size_t i = 10; i < 50; ++i) difference.data[i] = 1;
  EXPECT_EQ(difference_scale(difference), (ColourScale{-4.0, 4.0, false})) << "of a few pixels";
}

TEST(ColouredDifference, IsBlueBelowAndOrangeAboveZero) {
  ImageBuffer<std::int16_t> difference(3, 1, 1);
  difference.data = {-100, 0, 100};
  const Image image = coloured_difference(difference, {-16.0, 16.0, false});
  EXPECT_EQ(rgb(image, 0, 0), (std::array<int, 3>{128, 195, 255}));
  EXPECT_LT(luminance(rgb(image, 1, 0)), 0.01);
  EXPECT_EQ(rgb(image, 2, 0), (std::array<int, 3>{255, 166, 85}));
}

}  // namespace
}  // namespace overfly::server
