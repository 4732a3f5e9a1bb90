// The native feature-based monocular odometry.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>

#include "core/result.hpp"
#include "vo_bridges/vo_port.hpp"

namespace overfly::odometry {

/// Names are the field's; each is also the key of a scenario's `parameters`.
struct FeatureParameters {
  int features = 2000;          ///< per image, in [100, 20000]
  double scale_factor = 1.2;    ///< between pyramid levels, in (1, 2]
  int levels = 8;               ///< in [1, 16]
  int ini_fast_threshold = 20;  ///< grey levels, in [1, 100]
  int min_fast_threshold = 7;   ///< where a cell has no corner at the first, in [1, ini]
  std::uint64_t seed = 1;       ///< of RANSAC

  // What flight over land asks for; each can be switched off, to see what it is worth.
  bool rotation_compensation = true;  ///< the search goes where the turn takes the image
  bool planar_start = true;           ///< the first map may come from a plane's homography
  bool low_texture = true;            ///< blurred ground is held by larger, coarser patches
  bool reject_saturated = true;       ///< nothing is looked for where the image is burnt out
  /// Above ground at the first map [m], in (0, 20000]: poses are in metres. 0 = not known: the
  /// ground on the axis of the first map's first view is 1 away.
  double initial_height_m = 0.0;
  /// 1 = each keyframe is mapped before the answer: results repeat to the last byte.
  /// 2 = mapping has a thread of its own, as real time needs it.
  int threads = 1;
};

/// Switches are 1 and 0. Errors: kInvalidArgument naming an unknown key, or field, value and limit.
[[nodiscard]] Result<FeatureParameters> feature_parameters_from(
    const std::map<std::string, double>& values);
/// What `feature_parameters_from` takes back to the same parameters; switches are 1 and 0.
[[nodiscard]] std::map<std::string, double> values_of(const FeatureParameters& parameters);
/// The same for people; switches are "true" and "false".
[[nodiscard]] std::map<std::string, std::string> texts_of(const FeatureParameters& parameters);

[[nodiscard]] Result<std::unique_ptr<VoPort>> create_feature_odometry(
    const FeatureParameters& parameters);

}  // namespace overfly::odometry
