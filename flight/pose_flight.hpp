// Flies given poses. Private to flight and its sub-rooms.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/motion/trajectory.hpp"
#include "core/motion/truth_source.hpp"

namespace overfly::flight {

struct StampedRotation {
  std::int64_t t_ns = 0;
  Eigen::Quaterniond R_world_body;
};

/// A flight through poses T_world_body: positions by cubic Hermite splines, rotations by SLERP.
/// Time 0 is the first pose. @pre at least 2 poses
/// @param rotations  between which the SLERP is instead of between the poses; empty, or with times
/// strictly increasing from the first pose or before it to the last one or after it
[[nodiscard]] std::unique_ptr<TruthSource> fly_poses(Trajectory T_world_body,
                                                     std::vector<StampedRotation> rotations,
                                                     std::vector<std::string> warnings,
                                                     std::string description);

}  // namespace overfly::flight
