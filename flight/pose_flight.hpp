// Flies given poses. Private to flight and its sub-rooms.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/motion/trajectory.hpp"
#include "core/motion/truth_source.hpp"

namespace overfly::flight {

/// A flight through poses T_world_body: positions by cubic Hermite splines, rotations by SLERP.
/// Time 0 is the first pose. @pre at least 2 poses
[[nodiscard]] std::unique_ptr<TruthSource> fly_poses(Trajectory T_world_body,
                                                     std::vector<std::string> warnings,
                                                     std::string description);

}  // namespace overfly::flight
