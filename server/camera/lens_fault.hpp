// Faults on the lens of a camera that has no sensor model.
#pragma once

#include <vector>

#include "core/image.hpp"
#include "server/scenario/fault_spec.hpp"

namespace overfly::engine {

/// Applies faults in the light: sRGB (IEC 61966-2-1) undone before and redone after. What no fault
/// touches keeps its value exactly.
[[nodiscard]] Image with_lens_faults(const Image& image,
                                     const std::vector<const FaultSpec*>& faults);

}  // namespace overfly::engine
