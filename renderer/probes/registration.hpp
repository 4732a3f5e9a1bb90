// Registers two images of the same place; the measure of the camera's self-test.
#pragma once

#include <Eigen/Core>

#include "core/camera/image.hpp"
#include "renderer/camera/truth_images.hpp"

namespace overfly::renderer {

/// An image warped to another one.
struct WarpedImage {
  Image image;  ///< grey
  Image valid;  ///< 255 if the motion leads into the source, else 0
};

/// The source as seen from another image: result(pixel) = source(pixel + motion(pixel)).
///
/// Method: cubic convolution (Keys 1981, IEEE Trans. ASSP 29(6), eq. 4 with a = -1/2).
/// @param source  grey
/// @param motion  2 channels, of the result's size; NaN = none
[[nodiscard]] WarpedImage warp_along(const Image& source, const VectorImage& motion);

struct RegistrationOptions {
  int spacing_px = 24;        ///< between the patches' centres
  int half_patch_px = 10;     ///< a patch is 2 * half + 1 pixels wide
  double min_texture = 1.0;   ///< smaller eigenvalue of the mean gradient product [(grey / px)^2]
  double max_shift_px = 5.0;  ///< a patch that moves farther is lost and keeps this shift
};

/// Result of registering two images patch by patch.
struct Registration {
  int patches = 0;  ///< with enough texture, all valid
  int lost = 0;     ///< of those: not found within max_shift_px
  double median_px = 0.0;
  double p95_px = 0.0;
  Eigen::Vector2d mean_px = Eigen::Vector2d::Zero();  ///< of the patches found: right, down
  double median_grey = 0.0;                           ///< of the differences between valid pixels
  double p95_grey = 0.0;
};

/// Locates each patch of `seen` in `predicted`.
///
/// Method: translation by least squares on the image's gradient (Lucas and Kanade 1981), with the
/// gradient of the template (Baker and Matthews 2004, IJCV 56(3), section 3.2), iterated to 1e-4
/// px.
/// @param valid  255 where `predicted` is valid; of the images' size
[[nodiscard]] Registration register_images(const Image& predicted,
                                           const Image& seen,
                                           const Image& valid,
                                           const RegistrationOptions& options = {});

}  // namespace overfly::renderer
