// The map points that an estimator observed in one frame, as recorded with its debug images.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <vector>

#include "core/motion/pose.hpp"
#include "core/result.hpp"

namespace overfly::server {

struct MapPoints {
  Similarity S_world_vo;  ///< the alignment `init_scale` at that frame
  std::vector<Eigen::Vector3f> points_vo;
};

/// The points in the world by an alignment.
[[nodiscard]] std::vector<Eigen::Vector3f> in_world(const MapPoints& points,
                                                    const Similarity& S_world_vo);

/// Maximum number in one file; further points are left out.
inline constexpr std::size_t kMaxMapPoints = 20'000;

/// The content of points/NAME/NNNNNN.bin (docs/RUN_FOLDER.md).
[[nodiscard]] std::vector<std::uint8_t> bytes_of(const MapPoints& points);

/// Points with a coordinate that is not finite are left out.
/// Errors: kNotFound, kIo; kUnreadable naming the file for a wrong size or a similarity that is
/// none.
[[nodiscard]] Result<MapPoints> read_map_points(const std::filesystem::path& file);

}  // namespace overfly::server
