// What a piece of a camera image offers to an estimator: corners, and whether places look alike.
#pragma once

#include <optional>

#include "core/camera/image.hpp"

namespace overfly::server::predict {

/// Corners of a grey image: pixels around which 9 contiguous pixels of a circle of 16 are all
/// brighter or all darker by more than `threshold` (Rosten, Drummond 2006, "Machine learning for
/// high-speed corner detection", section 2), and of which none within 1 px has a higher score (the
/// sum of the differences beyond the threshold). Pixels within 3 px of the border have none.
/// @param threshold  grey levels, >= 0
[[nodiscard]] int count_corners(const Image& grey, int threshold);

/// How similar other places within `radius_px` look: for each of a few square templates, the
/// highest normalised cross-correlation at a distance of more than half a template. The median over
/// the templates, in [0, 1]; 1 = the pattern repeats. A template with a standard deviation below
/// `least_contrast` counts 1: nothing tells such places apart. Empty if the image is too small for
/// the search.
/// @param least_contrast  grey levels, > 0
[[nodiscard]] std::optional<double> self_similarity(const Image& grey,
                                                    int radius_px,
                                                    double least_contrast);

/// The largest search that fits into an image, at most `radius_px`; below 1 if there is none.
[[nodiscard]] int fitting_radius_px(const Image& grey, int radius_px);

/// Standard deviation of the noise of one image [grey levels], from two images of the same light.
/// 0 for images without pixels. @pre equal sizes
[[nodiscard]] double noise_of(const Image& first, const Image& second);

}  // namespace overfly::server::predict
