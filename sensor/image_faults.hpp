// What can happen to the light before it reaches the sensor. Each fault acts on linear radiance,
// ahead of the image chain, because that is its place: dirt and water lie on the lens, a flash is
// light, a covered lens lets none through; the sensor then blurs, clips and quantises what is left.
// Pure functions: the same fault makes the same change on every frame. When faults begin and end
// is the caller's affair.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "core/image.hpp"
#include "core/result.hpp"

namespace overfly::renderer {

enum class ImageFaultKind {
  kSaturation,  ///< light added: everywhere, or a glare around a seeded place
  kDirt,        ///< specks on the lens, out of focus, that take light away
  kWaterDrop,   ///< a drop on the lens: a small, turned and blurred image inside its rim
  kBlackout,    ///< light taken away everywhere
};

/// "saturation", "dirt", "water_drop", "blackout".
[[nodiscard]] const char* to_string(ImageFaultKind kind);
[[nodiscard]] std::optional<ImageFaultKind> image_fault_kind_from(const std::string& text);

struct ImageFault {
  ImageFaultKind kind = ImageFaultKind::kBlackout;
  /// kSaturation: radiance added at its middle (1 = the imagery's white), in [1e-6, 1000].
  /// kDirt: share of the light that the middle of the darkest speck may take; each takes between
  /// half and all of it. kWaterDrop: opacity of the drop's image. kBlackout: share of the light
  /// taken. These in [1e-6, 1].
  double strength = 1.0;
  /// kSaturation: standard deviation of the glare, in [0, 10000]; 0 = the whole image alike.
  /// kDirt: mean radius of a speck, in [1, 10000]; from half to one and a half of it.
  /// kWaterDrop: radius of the first drop, in [1, 1000]; the others are 0.3 to 1 of it.
  /// Not used by kBlackout.
  double radius_px = 40.0;
  int count = 0;           ///< specks or drops, in [1, 1000]; 0 = 20 specks, one drop
  std::uint64_t seed = 1;  ///< of places and sizes

  /// Errors: kInvalidArgument naming field, value and limit.
  [[nodiscard]] Status validate() const;
};

/// Changes the radiance at the lens as the fault does. @pre fault.validate()
void apply_fault(const ImageFault& fault, RadianceImage& radiance);

}  // namespace overfly::renderer
