// Converts answers of an estimator from LCM messages.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <overfly_lcm/debug_t.hpp>
#include <overfly_lcm/pose_t.hpp>
#include <vector>

#include "core/camera/image.hpp"
#include "core/result.hpp"
#include "vo_bridges/vo_port.hpp"

namespace overfly {

/// Converts all but the debug image; the names of counters and timings are not checked. Errors:
/// kUnreadable naming the field, its value and limit.
[[nodiscard]] Result<VoEstimate> estimate_from(const overfly_lcm::pose_t& message);

/// Content of a PREFIX_DEBUG message.
struct DebugView {
  std::optional<Image> image;
  std::vector<Eigen::Vector3f> map_points_vo;
};
/// Errors: kUnreadable, as for estimate_from.
[[nodiscard]] Result<DebugView> debug_view_from(const overfly_lcm::debug_t& message,
                                                int largest_width_px,
                                                int largest_height_px);

}  // namespace overfly
