// Bilinear samples of the patches that are aligned, with vector instructions where the machine has
// them.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <opencv2/core.hpp>

namespace overfly::odometry {

inline constexpr int kPatchSize = 12;
inline constexpr int kPatchArea = kPatchSize * kPatchSize;
/// Side of a patch with one sample around it, for gradients.
inline constexpr int kBorderSide = kPatchSize + 2;

/// Samples of a line, with some that are not used, so that whole vectors are computed.
inline constexpr int kSampleLine = (kBorderSide + 7) / 8 * 8;
/// Row-major lines of kBorderSide samples, and room for the unused ones of the last line.
using BorderPatch =
    std::array<float,
               static_cast<std::size_t>(kBorderSide) * kBorderSide + kSampleLine - kBorderSide>;

/// The offset d from a patch's centre lies in the image at centre + A d / (1 + g.d).
struct SampledWarp {
  Eigen::Vector2f centre;  ///< pixel
  Eigen::Matrix2f A;
  Eigen::Vector2f g;
};

/// The functions of one instruction set; all give the same bits.
struct PatchSampler {
  const char* name;
  /// Samples the patch with its border. @pre all its samples are inside the CV_8U image, rounding
  /// aside, and the depth 1 + g.d is positive up to 2 px right of it
  void (*warped)(const cv::Mat& image, const SampledWarp& warp, BorderPatch& out);
  /// Samples the patch whose first sample is at (x, y). @pre it is inside the CV_8U image
  /// @param out  kPatchArea values, row-major
  void (*shifted)(const cv::Mat& image, float x, float y, float* out);
};

/// The plain functions.
[[nodiscard]] const PatchSampler& plain_patch_sampler();
/// The fastest ones that this machine supports.
[[nodiscard]] const PatchSampler& best_patch_sampler();

}  // namespace overfly::odometry
