#include "server/views/view_scene.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/earth/geodesy.hpp"
#include "renderer/viewpoint.hpp"

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

TEST(ViewScene, LabelsWhatIsInTheViewAndNotHidden) {
  renderer::SceneView view;
  view.width_px = 800;
  view.height_px = 600;
  // From 100 m above flat ground to the north.
  view.T_world_camera = renderer::look_at({0, 0, 100}, {0, 1000, 100}, {0, 0, 1});
  const std::vector<PlacedLabel> places = {
      {{"r", "", 0, 0, 0, {}}, {0.0, 500.0, 100.0}},      // straight ahead
      {{"r", "a", 0, 0, 0, 12.5}, {50.0, 500.0, 100.0}},  // to the right of it
      {{"r", "behind", 0, 0, 0, {}}, {0.0, -50.0, 100.0}},
      {{"r", "aside", 0, 0, 0, {}}, {2000.0, 500.0, 100.0}},
      {{"r", "below", 0, 0, 0, {}}, {0.0, 500.0, -20.0}}};
  const auto labels = labels_in_view(places, view, FlatGround(0.0));
  ASSERT_EQ(labels.size(), 2U);
  EXPECT_NEAR(labels[0].x_px, 399.5, 1e-6);
  EXPECT_NEAR(labels[0].y_px, 299.5, 1e-6);
  EXPECT_NEAR(labels[0].distance_m, 500.0, 1e-6);
  EXPECT_EQ(labels[1].estimator, "a");
  EXPECT_EQ(labels[1].error_m, 12.5);
  const double f_px = 300.0 / std::tan(0.5 * view.fov_y_rad);
  EXPECT_NEAR(labels[1].x_px - 399.5, f_px * 50.0 / 500.0, 1e-6);
}

}  // namespace
}  // namespace overfly::server
