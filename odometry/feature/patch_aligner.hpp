// Finds a patch again in another image, to a few hundredths of a pixel.
#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <optional>

#include "odometry/feature/pyramid.hpp"

namespace overfly::odometry {

inline constexpr int kPatchSize = 12;
inline constexpr int kPatchArea = kPatchSize * kPatchSize;
using PatchVector = Eigen::Matrix<float, kPatchArea, 1>;  ///< row-major patch

/// A patch as it should look in the image where it is searched, with all that one step of the
/// search needs. All at one pyramid level.
struct PatchTemplate {
  int level = 0;
  PatchVector value;  ///< mean removed
  PatchVector gradient_x;
  PatchVector gradient_y;
  Eigen::Matrix2f inverse_hessian;
  Eigen::Vector2f gradient_value;  ///< sum of gradient times value
  float energy = 0.0F;             ///< sum of squared values
};

/// The finest level, at least `finest` and at most `coarsest`, at which the patch around a pixel
/// has texture to hold on; empty if there is none. Blurred ground is held at coarse levels.
[[nodiscard]] std::optional<int> textured_level(const Pyramid& image,
                                                const Eigen::Vector2d& pixel,
                                                int finest,
                                                int coarsest);

struct PatchMatch {
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();  ///< full-resolution pixel
  float correlation = 0.0F;                         ///< normalised, in [-1, 1]
};

/// Samples the patch around `source_pixel` (full resolution), shaped as the other view sees it.
///
/// @param A_other_source derivative of the other view's pixel by the source's pixel
/// @param level          pyramid level of the search in the other view
/// @return empty where the patch leaves the image, is too distorted, or has no texture to hold on
std::optional<PatchTemplate> make_template(const Pyramid& source,
                                           const Eigen::Vector2d& source_pixel,
                                           const Eigen::Matrix2d& A_other_source,
                                           int level);

/// Moves the patch over the image until it fits best.
///
/// Method: inverse compositional Lucas-Kanade with translation only (Baker and Matthews 2004,
/// section 3.2, DOI 10.1023/B:VISI.0000011205.11775.fd), mean and contrast normalised.
/// @param start_pixel where the search starts, full resolution
/// @return empty when it leaves the image or does not settle
std::optional<PatchMatch> align_patch(const Pyramid& image,
                                      const PatchTemplate& patch,
                                      const Eigen::Vector2d& start_pixel);

}  // namespace overfly::odometry
