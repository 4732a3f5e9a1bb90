// The corners of a mesh of squares of many sizes, found by their place.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "renderer/ground_patch.hpp"

namespace overfly::renderer {

/// A set of lattice points with their ground points. Where a small square meets a large one, the
/// large one finds here the corners that lie on its side and takes them over, so that the mesh
/// has neither gaps nor T-junctions.
class GroundCorners {
 public:
  GroundCorners();

  /// @param point  must outlive the set
  void add(const GroundPatches::LatticePoint& at, const Eigen::Vector3d& point);
  /// The corner at a place, or null.
  [[nodiscard]] const Eigen::Vector3d* find(const GroundPatches::LatticePoint& at) const;

 private:
  struct Slot {
    GroundPatches::LatticePoint at{};
    const Eigen::Vector3d* point = nullptr;  // null: free
  };
  [[nodiscard]] std::size_t slot_of(const GroundPatches::LatticePoint& at) const;
  void grow();

  std::vector<Slot> slots_;  // open addressing, a power of two, at most half full
  std::size_t used_ = 0;
};

}  // namespace overfly::renderer
