// The corners of a mesh of squares of different sizes, indexed by place.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "renderer/ground/ground_patch.hpp"

namespace overfly::renderer {

/// A set of lattice points with their ground points, which avoids gaps and T-junctions in the mesh.
/// Where a small square meets a large one, the large one finds and uses the corners on its side.
/// Where patches of different levels have different heights for a corner, all use that of the
/// finest patch.
class GroundCorners {
 public:
  GroundCorners();

  /// @param point  must outlive the set
  /// @param level  of the patch that provides the point; the lowest level wins, equal levels agree
  void add(const LatticePoint& at, const Eigen::Vector3d& point, int level);
  /// The corner at a place, or null.
  [[nodiscard]] const Eigen::Vector3d* find(const LatticePoint& at) const;

 private:
  struct Slot {
    LatticePoint at{};
    const Eigen::Vector3d* point = nullptr;  // null = free slot
    int level = 0;
  };
  [[nodiscard]] std::size_t slot_of(const LatticePoint& at) const;
  void grow();

  std::vector<Slot> slots_;  // open addressing, a power of two, at most half full
  std::size_t used_ = 0;
};

}  // namespace overfly::renderer
