#include "odometry/feature/orb.hpp"

#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>

#include "tests/odometry/synthetic_flight.hpp"

namespace overfly::odometry::feature {
namespace {

cv::Mat textured() {
  const auto ground = testing::SyntheticGround::procedural(2, 512, 1.0, 0.0);
  const PinholeCamera camera{640, 480, 350.0, 350.0, 319.5, 239.5};
  static const Image image = ground.render(
      camera, {R_world_body_from({}) * R_body_camera_nadir(), {0.0, 0.0, 350.0}}, 0.0, 1);
  return {480, 640, CV_8U, const_cast<std::uint8_t*>(image.data.data())};
}

TEST(OrbExtractor, SpreadsCornersOverImageAndScales) {
  FeatureParameters parameters;
  parameters.features = 1000;
  OrbExtractor orb(parameters);
  const std::vector<Corner> corners = orb.detect(textured());
  EXPECT_GT(corners.size(), 700U);
  EXPECT_LE(corners.size(), 1004U);  // each level's share is rounded
  int quarters[2][2] = {};
  int coarse = 0;
  for (const Corner& corner : corners) {
    ++quarters[corner.pixel.y() > 240.0 ? 1 : 0][corner.pixel.x() > 320.0 ? 1 : 0];
    coarse += corner.scale_level > 3 ? 1 : 0;
  }
  for (const auto& row : quarters) {
    for (const int count : row) EXPECT_GT(count, static_cast<int>(corners.size()) / 8);
  }
  EXPECT_GT(coarse, 100);
}

TEST(OrbExtractor, LooksOnlyNearMarkedCells) {
  OrbExtractor orb(FeatureParameters{});
  CellGrid wanted = CellGrid::over(640, 480, 48);
  wanted.marked[wanted.index({320.0, 240.0})] = 1;
  const std::vector<Corner> corners = orb.detect(textured(), &wanted);
  ASSERT_FALSE(corners.empty());
  for (const Corner& corner : corners) {
    // One marked cell of 80 px and whole detection cells of up to 32 px * 1.2^7 around it.
    EXPECT_LT((corner.pixel - Eigen::Vector2d(320.0, 240.0)).lpNorm<Eigen::Infinity>(),
              80.0 + 116.0);
  }
}

TEST(OrbExtractor, DescribesATurnedImageAlike) {
  OrbExtractor orb(FeatureParameters{});
  const cv::Mat image = textured();
  cv::Mat turned;
  cv::rotate(image, turned, cv::ROTATE_90_CLOCKWISE);
  const std::vector<Corner> corners = orb.detect(image);
  std::vector<Descriptor> upright;
  std::vector<Corner> fine;
  for (const Corner& corner : corners) {
    if (corner.scale_level != 0) continue;
    fine.push_back(corner);
    upright.push_back(orb.describe(corner));
  }
  orb.load(turned);
  ASSERT_GT(fine.size(), 50U);
  double same = 0.0;
  double other = 0.0;
  for (std::size_t i = 0; i < fine.size(); ++i) {
    Corner corner = fine[i];
    corner.level_pixel = {479 - fine[i].level_pixel.y(), fine[i].level_pixel.x()};
    const Descriptor descriptor = orb.describe(corner);
    same += hamming_distance(upright[i], descriptor);
    other += hamming_distance(upright[(i + 7) % fine.size()], descriptor);
  }
  EXPECT_LT(same / static_cast<double>(fine.size()), 20.0);
  EXPECT_GT(other / static_cast<double>(fine.size()), 80.0);
}

TEST(OrbExtractor, FindsNothingOnBlackOrTinyImages) {
  OrbExtractor orb(FeatureParameters{});
  EXPECT_TRUE(orb.detect(cv::Mat::zeros(480, 640, CV_8U)).empty());
  EXPECT_TRUE(orb.detect(cv::Mat::zeros(30, 30, CV_8U)).empty());
}

TEST(HammingDistance, CountsDifferingBits) {
  EXPECT_EQ(hamming_distance({1, 0, 0, 0}, {0, 3, 0, ~std::uint64_t{0}}), 67);
  constexpr std::uint64_t kAll = ~std::uint64_t{0};
  EXPECT_EQ(hamming_distance({0, 0, 0, 0}, {kAll, kAll, kAll, kAll}), 256);
  EXPECT_EQ(hamming_distance({kAll, 5, 0, 1}, {kAll, 5, 0, 1}), 0);
}

TEST(CellGrid, MarksWhatABoxTouches) {
  CellGrid grid = CellGrid::over(640, 480, 48);  // cells of 80 px
  EXPECT_FALSE(grid.any_marked({0.0, 0.0}, {640.0, 480.0}));
  grid.marked[grid.index({81.0, 0.0})] = 1;
  EXPECT_TRUE(grid.any_marked({0.0, 0.0}, {80.5, 10.0}));
  EXPECT_FALSE(grid.any_marked({0.0, 0.0}, {79.0, 10.0}));
  EXPECT_TRUE(grid.any_marked({-50.0, -50.0}, {9999.0, 9999.0}));
}

}  // namespace
}  // namespace overfly::odometry::feature
