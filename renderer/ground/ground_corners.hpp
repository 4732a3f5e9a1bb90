// The corners of a mesh of squares of many sizes, found by their place.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "renderer/ground/ground_patch.hpp"

namespace overfly::renderer {

/// A set of lattice points with their ground points. Where a small square meets a large one, the
/// large one finds here the corners that lie on its side and takes them over, and where patches
/// of different levels know different heights of a corner, all take the finest patch's: so that
/// the mesh has neither gaps nor T-junctions.
class GroundCorners {
 public:
  GroundCorners();

  /// @param point  must outlive the set
  /// @param level  of the patch that knows it; the lowest wins, equal ones know the same
  void add(const LatticePoint& at, const Eigen::Vector3d& point, int level);
  /// The corner at a place, or null.
  [[nodiscard]] const Eigen::Vector3d* find(const LatticePoint& at) const;

 private:
  struct Slot {
    LatticePoint at{};
    const Eigen::Vector3d* point = nullptr;  // null: free
    int level = 0;
  };
  [[nodiscard]] std::size_t slot_of(const LatticePoint& at) const;
  void grow();

  std::vector<Slot> slots_;  // open addressing, a power of two, at most half full
  std::size_t used_ = 0;
};

}  // namespace overfly::renderer
