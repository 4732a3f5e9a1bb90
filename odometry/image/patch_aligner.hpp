// Aligns a patch in another image to a few hundredths of a pixel.
#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <optional>

#include "odometry/image/patch_samples.hpp"
#include "odometry/image/pyramid.hpp"

namespace overfly::odometry {

using PatchVector = Eigen::Matrix<float, kPatchArea, 1>;  ///< row-major patch

/// Maps offsets on the plane around a patch's centre from the searching view to the source view:
/// the offset d [px] becomes A d / (1 + g.d). The second term matters for ground seen obliquely and
/// for coarse levels, whose patches are wide.
struct PatchWarp {
  Eigen::Matrix2d A_source_other = Eigen::Matrix2d::Identity();
  Eigen::Vector2d g_per_px = Eigen::Vector2d::Zero();
};

/// The warp of a homography around a pixel of the other view.
[[nodiscard]] PatchWarp warp_around(const Eigen::Matrix3d& H_source_other,
                                    const Eigen::Vector2d& other_pixel);

/// A patch as predicted for the searched image, with precomputed values for one alignment step. All
/// at one pyramid level.
struct PatchTemplate {
  // NOLINTNEXTLINE(modernize-use-equals-default): emplace() would set all vectors to zero first.
  PatchTemplate() {}

  int level = 0;
  PatchVector value;  ///< mean removed
  PatchVector gradient_x;
  PatchVector gradient_y;
  Eigen::Matrix2f inverse_hessian;
  Eigen::Vector2f gradient_value;  ///< sum of gradient times value
  float energy = 0.0F;             ///< sum of squared values
  float least_eigenvalue = 0.0F;   ///< of the Hessian
};

/// Pyramid level at which a corner of a scale level is tracked.
[[nodiscard]] int patch_level_of(int scale_level, double scale_factor);

/// The level in [finest, coarsest] at which the patch around a pixel localises best; empty if no
/// level has enough texture. Blurred ground is tracked at coarse levels.
///
/// Method: the variance of the position is that of the image divided by the smallest eigenvalue of
/// the gradients' normal matrix (Forstner and Gulch 1987).
[[nodiscard]] std::optional<int> textured_level(const Pyramid& image,
                                                const Eigen::Vector2d& pixel,
                                                int finest,
                                                int coarsest);

struct PatchMatch {
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();  ///< full-resolution pixel
  float correlation = 0.0F;                         ///< normalised, in [-1, 1]
};

/// Asks for the cache lines of the patch around a pixel, so that the processor does not wait for
/// them when the patch is sampled a little later. The rows of an image are far apart.
/// @param pixel  full resolution; outside the image nothing is done
void fetch_patch(const Pyramid& image, const Eigen::Vector2d& pixel, int level);

/// Samples the patch around `source_pixel` (full resolution), warped into the other view.
///
/// @param level  pyramid level of the search in the other view
/// @return empty if the patch leaves the image, is too distorted or has too little texture
std::optional<PatchTemplate> make_template(const Pyramid& source,
                                           const Eigen::Vector2d& source_pixel,
                                           const PatchWarp& warp,
                                           int level);

/// Aligns the patch with the image, starting at `start_pixel`.
///
/// Method: inverse compositional Lucas-Kanade with translation only (Baker and Matthews 2004,
/// section 3.2, DOI 10.1023/B:VISI.0000011205.11775.fd), mean and contrast normalised.
/// @param start_pixel  start of the search, full resolution
/// @return empty if the search leaves the image or does not converge
std::optional<PatchMatch> align_patch(const Pyramid& image,
                                      const PatchTemplate& patch,
                                      const Eigen::Vector2d& start_pixel);

}  // namespace overfly::odometry
