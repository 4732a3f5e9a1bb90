#include "server/views/view_scene.hpp"

#include <gtest/gtest.h>

#include "core/earth/geodesy.hpp"

namespace overfly::server {
namespace {

/// A point of one run is at the same place on the earth in the world frame of the other.
TEST(ViewScene, PlacesAnotherRunWhereItLiesOnTheEarth) {
  const Geodetic origin = geodetic_from_deg(46.5, 7.3, 600.0);
  const Geodetic other = geodetic_from_deg(46.6, 7.5, 1250.0);
  const LocalFrame world(origin);
  const LocalFrame elsewhere(other);
  const Pose T = T_world_other(origin, other);
  for (const Eigen::Vector3d& p_other :
       {Eigen::Vector3d(0.0, 0.0, 0.0), Eigen::Vector3d(1000.0, -2000.0, 300.0)}) {
    const Eigen::Vector3d expected = world.world_from_ecef(elsewhere.ecef_from_world(p_other));
    EXPECT_LT((T * p_other - expected).norm(), 1e-6);
  }
  EXPECT_LT((T_world_other(origin, origin) * Eigen::Vector3d(1.0, 2.0, 3.0) -
             Eigen::Vector3d(1.0, 2.0, 3.0))
                .norm(),
            1e-8);
}

}  // namespace
}  // namespace overfly::server
