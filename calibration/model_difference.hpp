// How far two camera models are apart in the image.
#pragma once

#include "core/camera/camera_model.hpp"

namespace overfly::calibration {

/// Distances between the two projections of a ray.
struct ModelDifference {
  double mean_px = 0.0;
  double max_px = 0.0;
};

/// Compares the projections of the rays through a grid of pixels over `camera`'s whole image,
/// corners included. Rays that `other` cannot project are left out.
/// @pre both are valid and have the same size
[[nodiscard]] ModelDifference model_difference(const CameraModel& camera, const CameraModel& other);

}  // namespace overfly::calibration
