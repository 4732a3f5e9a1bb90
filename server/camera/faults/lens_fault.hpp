// Lens faults for a camera without a sensor model.
#pragma once

#include <vector>

#include "core/camera/image.hpp"
#include "server/scenario/fault_spec.hpp"

namespace overfly::server {

/// Applies faults in linear light: decodes sRGB (IEC 61966-2-1) before and encodes it after. Pixels
/// that no fault changes keep their exact value.
[[nodiscard]] Image with_lens_faults(const Image& image,
                                     const std::vector<const FaultSpec*>& faults);

}  // namespace overfly::server
