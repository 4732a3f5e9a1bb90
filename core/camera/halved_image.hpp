// Smaller versions of images for viewers.
#pragma once

#include <memory>

#include "core/camera/image.hpp"

namespace overfly {

/// The image, halved (each pixel the mean of four) until it is at most `max_width_px` wide.
[[nodiscard]] std::shared_ptr<const Image> halved_to_fit(std::shared_ptr<const Image> image,
                                                         int max_width_px);

}  // namespace overfly
