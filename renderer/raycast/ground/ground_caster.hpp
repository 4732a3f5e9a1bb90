// Intersects rays with the ground.
#pragma once

#include <Eigen/Core>
#include <array>

#include "renderer/raycast/ground/ground_hit.hpp"
#include "renderer/raycast/ground/height_field.hpp"

namespace overfly::renderer::raycast {

/// Casts rays onto a ground tree. A ray steeper than all ground meets it only once, and Newton's
/// method finds the point. Other rays are marched from square to square, skipping squares whose
/// highest post they pass (maximum mipmaps: Tevs, Ihrke, Seidel, Maximum mipmaps for fast,
/// accurate, and scalable dynamic height field rendering, I3D 2008), and meet the bilinear surface
/// of a cell at a root of a quadratic. In a tile whose ground falls less steeply than the ray along
/// its way, Newton's method leads to the same cell.
class GroundCaster {
 public:
  explicit GroundCaster(const GroundTree& tree) : tree_(tree) {}

  /// The first intersection of a ray with the ground.
  /// @param direction  any length
  /// @param guess  a depth near the answer, or 0
  /// @param near  a leaf of the tree near the answer, or null; shortens the search
  [[nodiscard]] GroundHit cast(const Eigen::Vector3d& origin,
                               const Eigen::Vector3d& direction,
                               double guess,
                               const GroundNode* near = nullptr) const;

  /// True for a direction steeper than all ground, for which nothing can hide the intersection.
  [[nodiscard]] bool meets_ground_once(const Eigen::Vector3d& direction) const {
    const double slope = tree_.steepest;
    return direction.z() < 0.0 &&
           direction.z() * direction.z() > slope * slope * direction.head<2>().squaredNorm();
  }

  [[nodiscard]] const GroundTree& tree() const { return tree_; }

 private:
  [[nodiscard]] const GroundNode* leaf_at(double east_m, double north_m) const;
  [[nodiscard]] GroundHit descend(const Eigen::Vector3d& origin,
                                  const Eigen::Vector3d& direction,
                                  double guess,
                                  const GroundNode* near) const;
  [[nodiscard]] GroundHit march(const Eigen::Vector3d& origin,
                                const Eigen::Vector3d& direction,
                                double guess,
                                const GroundNode* near) const;

  const GroundTree& tree_;
};

/// Maximum vertical distance between the ground in a square of about `size_m` around a hit and a
/// bilinear surface over it [m].
[[nodiscard]] double relief_around(const GroundTree& tree, const GroundHit& hit, double size_m);

}  // namespace overfly::renderer::raycast
