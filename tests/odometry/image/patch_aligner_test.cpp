#include "odometry/image/patch_aligner.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

namespace overfly::odometry {
namespace {

/// A smooth pattern that can be sampled anywhere, through a homography, with gain and offset;
/// features grow with `size`.
Pyramid image_through(const Eigen::Matrix3d& H_pattern_image,
                      double gain,
                      double offset,
                      double size = 1.0) {
  auto image = std::make_shared<Image>(256, 256, 1);
  for (int y = 0; y < 256; ++y) {
    for (int x = 0; x < 256; ++x) {
      const Eigen::Vector2d p = (H_pattern_image * Eigen::Vector3d(x, y, 1.0)).hnormalized() / size;
      const double value = 120.0 + 40.0 * std::sin(0.31 * p.x() + 0.1 * p.y()) +
                           40.0 * std::cos(0.27 * p.y() - 0.12 * p.x());
      image->at(x, y) =
          static_cast<std::uint8_t>(std::clamp(gain * value + offset + 0.5, 0.0, 255.0));
    }
  }
  return build_pyramid(image);
}

Pyramid image_of(const Eigen::Matrix2d& A, const Eigen::Vector2d& b, double gain, double offset) {
  Eigen::Matrix3d H = Eigen::Matrix3d::Identity();
  H.topLeftCorner<2, 2>() = A;
  H.topRightCorner<2, 1>() = b;
  return image_through(H, gain, offset);
}

const Eigen::Matrix2d kIdentity = Eigen::Matrix2d::Identity();

TEST(PatchAligner, FindsASubPixelShift) {
  const Pyramid source = image_of(kIdentity, {0.0, 0.0}, 1.0, 0.0);
  const Pyramid shifted = image_of(kIdentity, {-1.37, 0.62}, 1.0, 0.0);
  for (int level = 0; level < 2; ++level) {
    const auto patch = make_template(source, {120.0, 130.0}, {}, level);
    ASSERT_TRUE(patch);
    const auto match = align_patch(shifted, *patch, {120.0, 130.0});
    ASSERT_TRUE(match);
    EXPECT_GT(match->correlation, 0.99F);
    // The pattern's pixel (120, 130) is at (120 + 1.37, 130 - 0.62); grey levels are rounded.
    EXPECT_LT((match->pixel - Eigen::Vector2d(121.37, 129.38)).norm(), 0.03 * (1 << level));
  }
}

TEST(PatchAligner, FollowsATurnedAndBrighterView) {
  const double angle = 0.4;
  Eigen::Matrix2d A;  // source pixel by view pixel
  A << std::cos(angle), -std::sin(angle), std::sin(angle), std::cos(angle);
  const Pyramid source = image_of(kIdentity, {0.0, 0.0}, 1.0, 0.0);
  const Pyramid view = image_of(A, {30.0, -20.0}, 0.7, 25.0);
  const Eigen::Vector2d expected(140.0, 110.0);
  const auto patch =
      make_template(source, A * expected + Eigen::Vector2d(30.0, -20.0), {A, {0.0, 0.0}}, 0);
  ASSERT_TRUE(patch);
  const auto match = align_patch(view, *patch, expected + Eigen::Vector2d(1.0, -1.2));
  ASSERT_TRUE(match);
  EXPECT_LT((match->pixel - expected).norm(), 0.04);
}

TEST(PatchAligner, FollowsAnObliqueView) {
  // A wide patch of ground that recedes: an affine warp would miss by half a pixel of its level.
  Eigen::Matrix3d H;
  H << 1.0, 0.05, -10.0, 0.0, 1.25, -30.0, 0.0, 2e-3, 0.75;
  const Pyramid source = image_of(kIdentity, {0.0, 0.0}, 1.0, 0.0);
  const Pyramid view = image_through(H, 1.0, 0.0);
  const Eigen::Vector2d expected(130.0, 120.0);
  const Eigen::Vector2d middle = (H * expected.homogeneous()).hnormalized();
  const auto patch = make_template(source, middle, warp_around(H, expected), 2);
  ASSERT_TRUE(patch);
  const auto match = align_patch(view, *patch, expected + Eigen::Vector2d(2.0, -1.5));
  ASSERT_TRUE(match);
  EXPECT_GT(match->correlation, 0.98F);
  EXPECT_LT((match->pixel - expected).norm(), 0.1);
  const PatchWarp affine{warp_around(H, expected).A_source_other, {0.0, 0.0}};
  const auto crooked = make_template(source, middle, affine, 2);
  ASSERT_TRUE(crooked);
  const auto missed = align_patch(view, *crooked, expected);
  EXPECT_TRUE(!missed || (missed->pixel - expected).norm() > 0.2);
}

TEST(TexturedLevel, IsFineForFineAndCoarseForBlurredGround) {
  const Eigen::Matrix3d I = Eigen::Matrix3d::Identity();
  const Pyramid sharp = image_through(I, 1.0, 0.0, 0.4);
  EXPECT_EQ(textured_level(sharp, {128.0, 128.0}, 0, 3), 0);
  EXPECT_EQ(textured_level(sharp, {128.0, 128.0}, 1, 3), 1);
  const Pyramid blurred = image_through(I, 1.0, 0.0, 3.0);
  EXPECT_EQ(textured_level(blurred, {128.0, 128.0}, 0, 3), 2);
  EXPECT_EQ(textured_level(blurred, {128.0, 128.0}, 0, 1), 1);
  // A fine patch sees too little of a pattern with less contrast.
  EXPECT_FALSE(textured_level(image_through(I, 0.3, 60.0, 8.0), {128.0, 128.0}, 0, 0));
  const Pyramid flat = build_pyramid(std::make_shared<Image>(256, 256, 1, std::uint8_t{90}));
  EXPECT_FALSE(textured_level(flat, {128.0, 128.0}, 0, 3));
}

TEST(PatchAligner, RefusesGroundWithoutTexture) {
  const Pyramid flat = build_pyramid(std::make_shared<Image>(256, 256, 1, std::uint8_t{90}));
  EXPECT_FALSE(make_template(flat, {128.0, 128.0}, {}, 0));
}

TEST(PatchAligner, RefusesPatchesThatLeaveTheImage) {
  const Pyramid image = image_of(kIdentity, {0.0, 0.0}, 1.0, 0.0);
  EXPECT_FALSE(make_template(image, {4.0, 128.0}, {}, 0));
  const auto patch = make_template(image, {128.0, 128.0}, {}, 0);
  ASSERT_TRUE(patch);
  EXPECT_FALSE(align_patch(image, *patch, {251.0, 128.0}));
  EXPECT_FALSE(align_patch(image, *patch, {std::nan(""), 128.0}));
}

TEST(Pyramid, LevelsShareTheirFirstPixel) {
  const Pyramid image = image_of(kIdentity, {0.0, 0.0}, 1.0, 0.0);
  ASSERT_EQ(image.level_count(), 4);  // 256, 128, 64, 32
  // A slow pattern survives halving, so that pixel (x, y) of level 1 is near (2 x, 2 y).
  const Pyramid slow = image_of(0.1 * kIdentity, {0.0, 0.0}, 1.0, 0.0);
  for (int i = 10; i < 110; i += 9) {
    EXPECT_NEAR(
        slow.level(1).at<std::uint8_t>(i, i), slow.level(0).at<std::uint8_t>(2 * i, 2 * i), 1);
  }
}

}  // namespace
}  // namespace overfly::odometry
