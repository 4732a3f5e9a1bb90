// How well a rendered image agrees with the real image of the same view.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "core/camera/image.hpp"
#include "core/result.hpp"

namespace overfly::evaluation {

struct ImageAgreement {
  /// Position in the real image minus position in the virtual image of the same content: right,
  /// down [px]. Empty if the images cannot be compared: one of them is uniform.
  std::optional<Eigen::Vector2d> offset_px;
  /// Share of the cross-power spectrum in the peak that gave the offset, in [0, 1]. Below about
  /// 0.05 the offset is not reliable. Empty without an offset.
  std::optional<double> peak;
  /// Normalised correlation of all pixels, in [-1, 1]; empty if an image is uniform.
  std::optional<double> correlation;
  /// The same after the offset was taken out, over the common part; empty also if less than a
  /// quarter of the image is common.
  std::optional<double> correlation_aligned;
  int corners_real = 0;  ///< FAST corners at 20 grey levels
  int corners_virtual = 0;
};

/// Compares two grey images of the same size.
///
/// Method: the offset is the peak of the phase correlation (Kuglin and Hines 1975) of both images
/// under a Hann window, refined by least squares on the image's gradient with gain and bias (Lucas
/// and Kanade 1981); one offset for the whole image. Corners: FAST-9 with suppression of neighbours
/// (Rosten and Drummond 2006). Errors: kInvalidArgument for other sizes, colour, or less than 16 x
/// 16 px.
[[nodiscard]] Result<ImageAgreement> compare_images(const Image& real, const Image& rendered);

}  // namespace overfly::evaluation
