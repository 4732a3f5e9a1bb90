// Measurements of a laser or radar altimeter.
#pragma once

#include <optional>

#include "core/earth/height_query.hpp"
#include "core/motion/truth_source.hpp"
#include "core/sensors/sensor_samples.hpp"
#include "flight/normal_noise.hpp"
#include "flight/sensors/sensor_models.hpp"

namespace overfly::flight {

/// Distance from a point along a beam to the ground; empty if the beam does not reach it within
/// max_m.
///
/// Method: steps of a quarter of the height above the ground, at least 1 m and at least 0.5 % of
/// the distance so far, then bisection to 0.1 mm. At most 1500 steps reach 100 km. Ground below the
/// beam that rises and falls within one step can be missed.
/// @param direction  unit vector, world
[[nodiscard]] std::optional<double> beam_range_m(const HeightQuery& ground,
                                                 const Eigen::Vector3d& from,
                                                 const Eigen::Vector3d& direction,
                                                 double max_m);

/// Sampled at its rate: the range along the body's z axis, with white noise. No echo beyond the
/// limits of the model.
class RangeFinder {
 public:
  RangeFinder(const RangeModel& model, std::uint64_t seed) : model_(model), noise_(seed) {}
  [[nodiscard]] RangeSample measure(const AircraftState& state, const HeightQuery& ground);

 private:
  RangeModel model_;
  NormalNoise noise_;
};

}  // namespace overfly::flight
