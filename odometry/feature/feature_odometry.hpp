// The native feature-based monocular visual odometry.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>

#include "core/result.hpp"
#include "vo_bridges/vo_port.hpp"

namespace overfly::odometry::feature {

/// Parameters. Each field name is also the key in a scenario's `parameters`.
struct FeatureParameters {
  int features = 2000;          ///< per image, in [100, 20000]
  double scale_factor = 1.2;    ///< between pyramid levels, in (1, 2]
  int levels = 8;               ///< in [1, 16]
  int ini_fast_threshold = 20;  ///< grey levels, in [1, 100]
  int min_fast_threshold = 7;   ///< for cells without corners otherwise, in [1, ini]
  std::uint64_t seed = 1;       ///< seed of RANSAC

  // Extensions for flight over land. Each can be disabled to measure its effect.
  bool rotation_compensation = true;  ///< predict the search position from the rotation
  bool planar_start = true;           ///< allow a homography for the first map
  bool low_texture = true;            ///< track blurred ground by coarser patches
  bool reject_saturated = true;       ///< ignore saturated areas of the image
  /// Height above ground at the first map [m], in (0, 20000]: poses are then in metres. 0 =
  /// unknown: the depth of the ground on the optical axis of the first map's first view is 1.
  double initial_height_m = 0.0;
  /// 1 = each keyframe is mapped before the estimate is returned: results are byte-identical.
  /// 2 = mapping runs in its own thread, as needed in real time.
  int threads = 1;
};

/// Reads parameters. Switches are 1 and 0. Errors: kInvalidArgument naming an unknown key, or
/// field, value and limit.
[[nodiscard]] Result<FeatureParameters> feature_parameters_from(
    const std::map<std::string, double>& values);
/// The inverse of `feature_parameters_from`. Switches are 1 and 0.
[[nodiscard]] std::map<std::string, double> values_of(const FeatureParameters& parameters);
/// The parameters as text for display. Switches are "true" and "false".
[[nodiscard]] std::map<std::string, std::string> texts_of(const FeatureParameters& parameters);

/// Upper bound of the memory of an estimator's own images [bytes per pixel of the camera]: the
/// keyframes of its maps, the images that wait for the first map, and the corners' levels. Points
/// and observations are not included.
[[nodiscard]] double most_bytes_per_px(const FeatureParameters& parameters);

[[nodiscard]] Result<std::unique_ptr<VoPort>> create_feature_odometry(
    const FeatureParameters& parameters);

}  // namespace overfly::odometry::feature
