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
};

/// Errors: kInvalidArgument naming an unknown key, or field, value and limit.
[[nodiscard]] Result<FeatureParameters> feature_parameters_from(
    const std::map<std::string, double>& values);

[[nodiscard]] Result<std::unique_ptr<VoPort>> create_feature_odometry(
    const FeatureParameters& parameters);

}  // namespace overfly::odometry
