// The samples of patches: against a closed form, and the same bits from every instruction set.
#include "odometry/image/patch_samples.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include "tests/odometry/random_image.hpp"

namespace overfly::odometry {
namespace {

using testing::random_image;

/// Whether all samples of the warp lie in the image.
bool inside(const SampledWarp& warp, const cv::Mat& image) {
  constexpr float kReach = 0.5F * (kBorderSide - 1);
  for (const float u : {-kReach, kReach}) {
    for (const float v : {-kReach, kReach}) {
      const Eigen::Vector2f d(u, v);
      const Eigen::Vector2f p = warp.centre + warp.A * d / (1.0F + warp.g.dot(d));
      if (!(p.minCoeff() > 0.0F && p.x() < static_cast<float>(image.cols - 1) &&
            p.y() < static_cast<float>(image.rows - 1))) {
        return false;
      }
    }
  }
  return true;
}

TEST(PatchSamples, AWarpOfARampIsExact) {
  cv::Mat ramp(60, 70, CV_8U);
  for (int y = 0; y < ramp.rows; ++y) {
    for (int x = 0; x < ramp.cols; ++x) {
      ramp.at<std::uint8_t>(y, x) = static_cast<std::uint8_t>(2 * x + y);
    }
  }
  SampledWarp warp;
  warp.centre = {31.25F, 28.5F};
  warp.A << 1.25F, -0.5F, 0.25F, 0.75F;
  warp.g = {0.01F, -0.02F};
  ASSERT_TRUE(inside(warp, ramp));
  for (const PatchSampler* sampler : {&plain_patch_sampler(), &best_patch_sampler()}) {
    BorderPatch samples;
    sampler->warped(ramp, warp, samples);
    for (int row = 0; row < kBorderSide; ++row) {
      for (int column = 0; column < kBorderSide; ++column) {
        const Eigen::Vector2d d(column - 6.5, row - 6.5);
        const Eigen::Vector2d p = warp.centre.cast<double>() +
                                  warp.A.cast<double>() * d / (1.0 + warp.g.cast<double>().dot(d));
        EXPECT_NEAR(samples[row * kBorderSide + column], 2.0 * p.x() + p.y(), 1e-3)
            << sampler->name << " " << row << " " << column;
      }
    }
    std::vector<float> shifted(kPatchArea);
    sampler->shifted(ramp, 5.375F, 9.75F, shifted.data());
    for (int i = 0; i < kPatchArea; ++i) {
      EXPECT_NEAR(shifted[i], 2.0 * (5.375 + i % kPatchSize) + 9.75 + i / kPatchSize, 1e-4);
    }
  }
}

TEST(PatchSamples, EveryInstructionSetGivesTheSameBits) {
  if (&best_patch_sampler() == &plain_patch_sampler()) {
    GTEST_SKIP() << "this machine has no AVX2";
  }
  const cv::Mat image = random_image(97, 83, 5);
  std::mt19937 generator(7);
  std::uniform_real_distribution<float> share(0.0F, 1.0F);
  int compared = 0;
  for (int i = 0; i < 20000; ++i) {
    SampledWarp warp;
    warp.centre = {97.0F * share(generator), 83.0F * share(generator)};
    const float angle = 7.0F * share(generator);
    const float scale = 0.4F + 2.0F * share(generator);
    warp.A << scale * std::cos(angle), -std::sin(angle), std::sin(angle), std::cos(angle);
    warp.g = {0.06F * (share(generator) - 0.5F), 0.06F * (share(generator) - 0.5F)};
    if (!inside(warp, image)) continue;
    ++compared;
    BorderPatch plain, best;
    plain_patch_sampler().warped(image, warp, plain);
    best_patch_sampler().warped(image, warp, best);
    for (int k = 0; k < kBorderSide * kBorderSide; ++k) ASSERT_EQ(plain[k], best[k]) << k;
    const float x = (97.0F - kPatchSize - 1.0F) * share(generator);
    const float y = (83.0F - kPatchSize - 1.0F) * share(generator);
    std::vector<float> plain_shift(kPatchArea), best_shift(kPatchArea);
    plain_patch_sampler().shifted(image, x, y, plain_shift.data());
    best_patch_sampler().shifted(image, x, y, best_shift.data());
    ASSERT_EQ(plain_shift, best_shift);
  }
  EXPECT_GT(compared, 2000);
}

TEST(PatchSamples, NothingIsReadBeyondTheImage) {
  // The patch fills an image of its own size: the last row has no byte behind it.
  for (const PatchSampler* sampler : {&plain_patch_sampler(), &best_patch_sampler()}) {
    std::vector<std::uint8_t> bytes((kBorderSide + 1) * (kBorderSide + 1), 9);
    const cv::Mat image(kBorderSide + 1, kBorderSide + 1, CV_8U, bytes.data());
    SampledWarp warp;
    warp.centre = Eigen::Vector2f::Constant(0.5F * kBorderSide + 0.499F);
    warp.A.setIdentity();
    warp.g.setZero();
    BorderPatch samples;
    sampler->warped(image, warp, samples);
    for (int k = 0; k < kBorderSide * kBorderSide; ++k) EXPECT_FLOAT_EQ(samples[k], 9.0F);
    std::vector<std::uint8_t> exact((kPatchSize + 1) * (kPatchSize + 1), 7);
    const cv::Mat small(kPatchSize + 1, kPatchSize + 1, CV_8U, exact.data());
    std::vector<float> shifted(kPatchArea);
    sampler->shifted(small, 0.25F, 0.5F, shifted.data());
    for (const float value : shifted) EXPECT_FLOAT_EQ(value, 7.0F);
  }
}

}  // namespace
}  // namespace overfly::odometry
