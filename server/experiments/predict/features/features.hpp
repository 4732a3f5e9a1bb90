// What `overfly predict` knows of an instant of a flight before it is flown.
#pragma once

#include <array>
#include <cstddef>
#include <optional>

namespace overfly::server::predict {

/// Features of an instant, or of a place of the map.
struct Features {
  /// Median of the imagery's linear texels per pixel: below 1 the imagery is coarser than the
  /// camera. 0 without imagery.
  double texels_per_pixel = 0.0;
  /// Corners that stand out of the noise, after motion blur and defocus, per 1000 px: median of the
  /// image's patches.
  double corners_per_kpx = 0.0;
  double bare_share = 0.0;       ///< of the patches, those with less than one corner in 1000 px
  double self_similarity = 0.0;  ///< image_features.hpp: median of the patches
  double relief = 0.0;       ///< range of the ground's height in the image over the height above it
  double rotation_px = 0.0;  ///< motion between frames by the rotation alone, RMS
  double translation_px = 0.0;  ///< by the translation, after the rotation
  double overlap = 1.0;         ///< share of the image still in view kOverlapS later
  double blur_px = 0.0;         ///< motion of the image while the shutter is open, RMS
  double noise_grey = 0.0;      ///< standard deviation of a pixel [grey levels]
  double void_share = 0.0;      ///< of the image, without imagery
  /// Elevation of the sun that lights the scenario; empty if the imagery keeps its own light.
  std::optional<double> sun_elevation_deg;
  double image_width_px = 1.0;
  double image_kpx = 1.0;  ///< pixels of the whole image / 1000
};

inline constexpr double kOverlapS = 1.0;

/// Inputs of the risk model, each a function of the features in which risk grows about linearly.
inline constexpr std::size_t kInputs = 12;
using Inputs = std::array<double, kInputs>;

/// Names of the inputs, as in risk_coefficients.cpp.
inline constexpr std::array<const char*, kInputs> kInputNames = {"texels",
                                                                 "corners",
                                                                 "bare",
                                                                 "similarity",
                                                                 "relief",
                                                                 "rotation",
                                                                 "translation",
                                                                 "overlap",
                                                                 "blur",
                                                                 "noise",
                                                                 "void",
                                                                 "sun"};

[[nodiscard]] Inputs inputs_of(const Features& features);

}  // namespace overfly::server::predict
