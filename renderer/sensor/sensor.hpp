// The camera's image chain, from the radiance at the lens to digital numbers, in physical order:
// defocus, vignetting, exposure, photo-electrons, shot noise, full well, read noise, gain,
// quantisation, response curve. Every stage is off by default.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/camera_model.hpp"
#include "core/image.hpp"
#include "core/result.hpp"

namespace overfly::renderer {

struct Vignette {
  /// Transmission at the radius r, in units of half the image's diagonal from the principal point:
  /// 1 + a1 r^2 + a2 r^4 + a3 r^6, in (0, 1] over the image.
  std::array<double, 3> a{};
  [[nodiscard]] double transmission(double r) const;
};

/// Digital numbers of the sensor against what the file holds.
struct ResponseCurve {
  double gamma = 1.0;  ///< output = input^(1 / gamma), both in [0, 1]; 1 = linear
  /// Instead of gamma: output at evenly spread inputs, strictly growing from 0 to 1; >= 2 values.
  std::vector<double> table;
  [[nodiscard]] double operator()(double input) const;
  [[nodiscard]] double inverse(double output) const;
};

struct AutoExposure {
  double target_mean = 0.45;  ///< of the digital numbers, as a share of the largest
  double min_exposure_s = 20e-6;
  double max_exposure_s = 20e-3;
  double max_gain = 8.0;  ///< used only once the exposure is at its longest
  int settle_frames = 8;  ///< after a step of the light within +-3 stops, to 5 % of the target
};

/// Parameters of a sensor. The default one passes the picture through: 8 bit, sRGB response.
struct SensorModel {
  bool enabled = false;  ///< false: the imagery's own digital numbers, no stage at all
  double defocus_sigma_px = 0.0;
  std::optional<Vignette> vignette;
  double exposure_s = 2e-3;
  double readout_s = 0.0;  ///< first row to last; 0 = global shutter
  bool motion_blur = false;
  /// Electrons that radiance 1 leaves in a pixel in one second.
  double electrons_per_s = 5e6;
  bool shot_noise = false;
  double full_well_e = 0.0;   ///< 0 = none
  double read_noise_e = 0.0;  ///< standard deviation
  double gain_dn_per_e =
      0.0;       ///< at bit depth `bits`; 0 = full scale at electrons_per_s * exposure_s
  int bits = 8;  ///< in [8, 16]; more than 8 makes 16-bit images
  ResponseCurve response;
  std::optional<AutoExposure> auto_exposure;

  /// Errors: kInvalidArgument naming field, value and limit.
  [[nodiscard]] Status validate() const;
};

struct ExposureSetting {
  std::int64_t exposure_ns = 0;
  double gain = 1.0;  ///< times gain_dn_per_e
};

/// What the sensor made of one radiance image.
struct SensorImage {
  Image image;      ///< 8 bit; of deeper sensors the high 8 bits
  Image16 image16;  ///< of sensors deeper than 8 bit, left-aligned as raw numbers; else empty
  ExposureSetting setting;
  double saturated_fraction = 0.0;  ///< of the pixels at full scale or full well
  double mean_level = 0.0;          ///< of the digital numbers before response, in [0, 1]
};

/// One camera's sensor. Deterministic: the same seed, frames and radiances give the same bytes,
/// whatever the machine's vector units.
class Sensor {
 public:
  /// Errors: as SensorModel::validate.
  static Result<std::unique_ptr<Sensor>> create(const SensorModel& model,
                                                const CameraModel& camera,
                                                std::uint64_t seed);
  virtual ~Sensor() = default;

  /// The exposure of the next frame: fixed, or what auto-exposure chose from the frames before.
  [[nodiscard]] virtual ExposureSetting next_setting() const = 0;
  /// @param radiance  grey or RGB, of the camera's size, taken with next_setting()
  /// @param frame     index of the frame, the noise's second seed
  [[nodiscard]] virtual SensorImage expose(const RadianceImage& radiance, std::int64_t frame) = 0;
};

}  // namespace overfly::renderer
