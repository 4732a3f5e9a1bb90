// Features of images that are known: corners, noise, patterns that repeat.
#include "server/experiments/predict/features/image_features.hpp"

#include <gtest/gtest.h>

#include <random>

#include "tests/support/synthetic_world.hpp"

namespace overfly::server::predict {
namespace {

/// Gaussian noise around grey 128.
Image noise_image(int side_px, double sigma, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal(128.0, sigma);
  Image image(side_px, side_px, 1);
  for (auto& value : image.data) {
    value = static_cast<std::uint8_t>(std::clamp(normal(random), 0.0, 255.0));
  }
  return image;
}

Image ramp_image(int side_px) {
  Image image(side_px, side_px, 1);
  for (int y = 0; y < side_px; ++y) {
    for (int x = 0; x < side_px; ++x) image.at(x, y) = static_cast<std::uint8_t>(x + y / 2);
  }
  return image;
}

/// A dark square of `side_px` whose upper left pixel is at (left_px, left_px).
void paint_square(Image& image, int left_px, int side_px) {
  for (int y = left_px; y < left_px + side_px; ++y) {
    for (int x = left_px; x < left_px + side_px; ++x) image.at(x, y) = 40;
  }
}

TEST(ImageFeatures, ASquareHasFourCorners) {
  Image image(64, 64, 1, 200);
  EXPECT_EQ(count_corners(image, 20), 0);
  paint_square(image, 20, 20);
  EXPECT_EQ(count_corners(image, 20), 4);
  EXPECT_EQ(count_corners(image, 159), 4);
  EXPECT_EQ(count_corners(image, 160), 0) << "the contrast is 160";
}

TEST(ImageFeatures, EdgesAndRampsAreNoCorners) {
  EXPECT_EQ(count_corners(ramp_image(64), 2), 0);
  Image edge(64, 64, 1, 200);
  for (int y = 0; y < 64; ++y) {
    for (int x = 0; x < 30; ++x) edge.at(x, y) = 40;
  }
  EXPECT_EQ(count_corners(edge, 20), 0);
}

TEST(ImageFeatures, SmallImagesHaveNoCorners) {
  EXPECT_EQ(count_corners(Image(6, 6, 1, 10), 1), 0);
  EXPECT_EQ(count_corners(Image(), 1), 0);
}

TEST(ImageFeatures, ACheckerboardRepeats) {
  const Image board = overfly::testing::checkerboard_image(96, 96, 9);
  const auto similarity = self_similarity(board, 20, 3.0);
  ASSERT_TRUE(similarity.has_value());
  EXPECT_NEAR(*similarity, 1.0, 1e-9);
}

TEST(ImageFeatures, NoiseDoesNotRepeat) {
  const auto similarity = self_similarity(noise_image(96, 30.0, 1), 20, 3.0);
  ASSERT_TRUE(similarity.has_value());
  // The largest of 1500 correlations of 169 independent pixels: about 3.2 / sqrt(169).
  EXPECT_GT(*similarity, 0.1);
  EXPECT_LT(*similarity, 0.4);
}

TEST(ImageFeatures, APatternThatRepeatsOutsideTheSearchIsUnique) {
  // Noise with a period of 40 px.
  const Image tile = noise_image(40, 30.0, 2);
  Image repeated(140, 140, 1);
  for (int y = 0; y < 140; ++y) {
    for (int x = 0; x < 140; ++x) repeated.at(x, y) = tile.at(x % 40, y % 40);
  }
  EXPECT_LT(self_similarity(repeated, 30, 3.0).value(), 0.5);
  EXPECT_NEAR(self_similarity(repeated, 45, 3.0).value(), 1.0, 1e-9);
}

TEST(ImageFeatures, SimilarityNeedsContrastAndRoom) {
  EXPECT_EQ(self_similarity(Image(96, 96, 1, 77), 20, 3.0), 1.0) << "all places are alike";
  EXPECT_EQ(self_similarity(noise_image(96, 1.0, 3), 20, 3.0), 1.0) << "less than the contrast";
  EXPECT_FALSE(self_similarity(noise_image(52, 30.0, 3), 20, 3.0)) << "smaller than the search";
  EXPECT_TRUE(self_similarity(noise_image(53, 30.0, 3), 20, 3.0));
  EXPECT_EQ(fitting_radius_px(noise_image(53, 30.0, 3), 20), 20);
  EXPECT_EQ(fitting_radius_px(noise_image(49, 30.0, 3), 20), 18);
  EXPECT_LT(fitting_radius_px(noise_image(14, 30.0, 3), 20), 1);
}

TEST(ImageFeatures, NoiseIsMeasuredFromTwoImages) {
  EXPECT_NEAR(noise_of(noise_image(128, 5.0, 1), noise_image(128, 5.0, 2)), 5.0, 0.15);
  const Image image = noise_image(128, 5.0, 1);
  EXPECT_EQ(noise_of(image, image), 0.0);
  EXPECT_EQ(noise_of(Image(), Image()), 0.0);
}

}  // namespace
}  // namespace overfly::server::predict
