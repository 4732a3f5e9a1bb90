// Parameters of a camera's sensor. Equations and sources: docs/CAMERA.md.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/result.hpp"

namespace overfly::sensor {

struct Vignette {
  /// Transmission at the radius r, in units of half the image's diagonal from the principal point:
  /// 1 + a1 r^2 + a2 r^4 + a3 r^6, in (0, 1] over the image.
  std::array<double, 3> a{};
  [[nodiscard]] double transmission(double r) const;
};

enum class ResponseShape {
  kSrgb,   ///< IEC 61966-2-1, the imagery's encoding: the image is unchanged
  kGamma,  ///< output = input^(1 / gamma); gamma 1 = linear, as in a measuring camera
  kTable,  ///< linear interpolation of the table's values
};

/// "srgb", "gamma", "table".
[[nodiscard]] const char* to_string(ResponseShape shape);
[[nodiscard]] std::optional<ResponseShape> response_shape_from(const std::string& text);

/// Digital numbers of the converter against those of the file, both as fractions of the largest.
struct ResponseCurve {
  ResponseShape shape = ResponseShape::kSrgb;
  double gamma = 1.0;  ///< of kGamma, in [0.1, 10]
  /// For kTable: output at equally spaced inputs, strictly increasing from 0 to 1; >= 2 values.
  std::vector<double> table;

  static ResponseCurve linear() { return {ResponseShape::kGamma, 1.0, {}}; }
  [[nodiscard]] bool is_linear() const { return shape == ResponseShape::kGamma && gamma == 1.0; }
  [[nodiscard]] double operator()(double input) const;
  [[nodiscard]] double inverse(double output) const;
};

/// Metering on the mean of the whole image. First increases the exposure up to its limit, then the
/// gain.
struct AutoExposure {
  /// Target grey level of the mean light (fraction of the largest number in the file).
  double target_mean = 0.45;
  double min_exposure_s = 20e-6;
  double max_exposure_s = 20e-3;
  double max_gain = 8.0;  ///< used only at the longest exposure
  /// Frames to settle within 5 % of the target after a step of the light within +-3 stops; in [4,
  /// 1000].
  int settle_frames = 8;
};

/// Parameters of a sensor. The default one leaves the image unchanged: 8 bit, sRGB response.
struct SensorModel {
  bool enabled = false;           ///< false: the imagery's own digital numbers, without any stage
  double defocus_sigma_px = 0.0;  ///< Gaussian, cut at 4 sigma; in [0, 50]
  std::optional<Vignette> vignette;
  double exposure_s = 2e-3;
  double readout_s = 0.0;  ///< first row to last; 0 = global shutter
  bool motion_blur = false;
  /// Electrons that radiance 1 generates in a pixel in one second.
  double electrons_per_s = 5e6;
  bool shot_noise = false;
  double prnu = 0.0;          ///< fixed pattern: relative standard deviation of the pixels' gain
  double dsnu_e = 0.0;        ///< fixed pattern: standard deviation of the pixels' offset
  double full_well_e = 0.0;   ///< 0 = none
  double read_noise_e = 0.0;  ///< standard deviation
  /// Digital numbers of depth `bits` per electron, K of EMVA 1288. 0 = full scale at the electrons
  /// that radiance 1 generates in `exposure_s`, or at the full well if that is less.
  double gain_dn_per_e = 0.0;
  double black_level_dn = 0.0;  ///< of depth `bits`, added before quantisation
  int bits = 8;                 ///< of the image, in [8, 16]; more than 8 makes 16-bit images
  /// Bits of the converter before the response, in [bits, 16]. 0 = `bits` for a linear response,
  /// else 4 more (16 at most), so that the curve leaves no gaps in the dark.
  int adc_bits = 0;
  ResponseCurve response;
  std::optional<AutoExposure> auto_exposure;

  /// Errors: kInvalidArgument naming field, value and limit.
  [[nodiscard]] Status validate() const;
  /// The gain and the converter's depth in effect, with zeros resolved.
  [[nodiscard]] double effective_gain_dn_per_e() const;
  [[nodiscard]] int effective_adc_bits() const;
};

struct ExposureSetting {
  std::int64_t exposure_ns = 0;
  double gain = 1.0;  ///< times gain_dn_per_e
};

}  // namespace overfly::sensor
