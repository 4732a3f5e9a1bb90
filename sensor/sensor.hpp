// The camera's image chain, from the radiance at the lens to digital numbers, in physical order:
// defocus, vignetting, exposure, photo-electrons, shot noise, full well, read noise, gain,
// quantisation, response curve. Every stage is off by default: an enabled sensor without a stage
// reproduces the imagery. Equations and sources: docs/CAMERA.md.
//
// A colour image passes the chain channel by channel: three equal sensors behind ideal colour
// filters, without a Bayer mosaic.
#pragma once

#include <cstdint>
#include <memory>

#include "core/camera/camera_model.hpp"
#include "core/camera/image.hpp"
#include "core/result.hpp"
#include "sensor/sensor_model.hpp"
#include "sensor/vector_units.hpp"

namespace overfly::sensor {

/// The sensor's output for one radiance image.
struct SensorImage {
  Image image;      ///< 8 bit; of deeper sensors the high 8 bits
  Image16 image16;  ///< for sensors deeper than 8 bit: raw numbers, 0 to 2^bits - 1; else empty
  ExposureSetting setting;
  double saturated_fraction = 0.0;  ///< of the samples at full scale or full well
  double mean_level = 0.0;          ///< of the digital numbers before response, in [0, 1]
};

/// One camera's sensor. Deterministic: the same seed, frames and radiances give the same bytes,
/// regardless of the machine's vector units.
class Sensor {
 public:
  /// Errors: as SensorModel::validate (`enabled` is ignored); a vignette outside (0, 1] within the
  /// image; an invalid camera. @pre supported(units)
  static Result<std::unique_ptr<Sensor>> create(const SensorModel& model,
                                                const CameraModel& camera,
                                                std::uint64_t seed,
                                                VectorUnits units = VectorUnits::kBest);
  virtual ~Sensor() = default;

  /// The exposure of the next frame: fixed, or chosen by auto-exposure from the preceding frames.
  [[nodiscard]] virtual ExposureSetting next_setting() const = 0;
  /// @param radiance  finite; grey or RGB, of the camera's size, taken with next_setting()
  /// @param frame     index of the frame, the noise's second seed
  [[nodiscard]] virtual SensorImage expose(const RadianceImage& radiance, std::int64_t frame) = 0;
};

}  // namespace overfly::sensor
