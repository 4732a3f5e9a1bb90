// Faults of the light before it reaches the sensor. Each fault acts on linear radiance, ahead of
// the image chain, as in reality: dirt and water lie on the lens, a flash is light, a covered lens
// blocks it; the sensor then blurs, clips and quantises the result. Pure functions: the same fault
// makes the same change on every frame. The caller decides when faults begin and end.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "core/camera/image.hpp"
#include "core/result.hpp"

namespace overfly::sensor {

enum class ImageFaultKind {
  kSaturation,  ///< adds light: everywhere, or a glare around a seeded place
  kDirt,        ///< specks on the lens, out of focus, that block light
  kWaterDrop,   ///< a drop on the lens: a small, turned and blurred image inside its rim
  kBlackout,    ///< blocks light everywhere
};

/// "saturation", "dirt", "water_drop", "blackout".
[[nodiscard]] const char* to_string(ImageFaultKind kind);
[[nodiscard]] std::optional<ImageFaultKind> image_fault_kind_from(const std::string& text);

struct ImageFault {
  ImageFaultKind kind = ImageFaultKind::kBlackout;
  /// kSaturation: radiance added at its centre (1 = the imagery's white), in [1e-6, 1000].
  /// kDirt: fraction of the light blocked at the centre of the darkest speck; each blocks between
  /// half and all of it. kWaterDrop: opacity of the drop's image. kBlackout: fraction of the light
  /// blocked. These in [1e-6, 1].
  double strength = 1.0;
  /// kSaturation: standard deviation of the glare, in [0, 10000]; 0 = uniform over the image.
  /// kDirt: mean radius of a speck, in [1, 10000]; radii are 0.5 to 1.5 times the mean.
  /// kWaterDrop: radius of the first drop, in [1, 1000]; the others have 0.3 to 1 times this
  /// radius.
  /// Not used by kBlackout.
  double radius_px = 40.0;
  int count = 0;           ///< specks or drops, in [1, 1000]; 0 = 20 specks, one drop
  std::uint64_t seed = 1;  ///< of places and sizes

  /// Errors: kInvalidArgument naming field, value and limit.
  [[nodiscard]] Status validate() const;
};

/// Applies the fault to the radiance at the lens. @pre fault.validate()
void apply_fault(const ImageFault& fault, RadianceImage& radiance);

}  // namespace overfly::sensor
