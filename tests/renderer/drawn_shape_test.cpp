// Where the drawn ground lies: how far in the image each renderer shows a piece of ground from
// where it is, over hills and tilted views. A picture is compared with the ground itself and not
// with another picture, because no PSNR shows a shift of a tenth of a pixel.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "renderer/ground/view.hpp"
#include "renderer/renderer.hpp"
#include "terrain/synthesize.hpp"
#include "terrain/world.hpp"
#include "tests/renderer/procedural_ground.hpp"
#include "tests/support/support.hpp"

namespace overfly::renderer {
namespace {

using overfly::testing::TemporaryFolder;

/// Above the hills of both worlds.
constexpr double kEastM = 350.0;
constexpr double kNorthM = 420.0;

/// The paper's camera.
PinholeCamera camera() {
  return PinholeCamera::from_fov(1280, 960, rad_from_deg(84.872), FovAxis::kHorizontal).value();
}

/// Over the pixels of a view.
struct Displacement {
  double mean_px = 0.0;
  double bias_px = 0.0;  ///< mean along the direction in which higher ground moves
  double worst_px = 0.0;
  double depth_mean_m = 0.0;
  int count = 0;
};

/// The ground below the place that a pixel shows, projected, against the pixel.
Displacement displacement(const terrain::TileSource& tiles,
                          const DepthImage& depth,
                          const Pose& T_world_camera) {
  const View view = View::from(camera(), T_world_camera);
  Displacement all;
  for (int y = 2; y < depth.height_px; y += 5) {
    for (int x = 2; x < depth.width_px; x += 5) {
      const double depth_m = depth.at(x, y);
      if (!std::isfinite(depth_m)) continue;
      const Eigen::Vector3d p_camera = depth_m * camera().ray({x, y});
      const Eigen::Vector3d p = T_world_camera * p_camera;
      const Eigen::Vector2d map = tiles.map_from_world(p.x(), p.y());
      if (!tiles.has_imagery(map.x(), map.y())) continue;
      const double above_m = p.z() - tiles.ground_up_m(p.x(), p.y());
      const double px = view.pixel_rate(p_camera, above_m * view.R_camera_world.col(2)).norm();
      all.mean_px += px;
      all.bias_px += std::copysign(px, above_m);
      all.worst_px = std::max(all.worst_px, px);
      all.depth_mean_m += std::abs(above_m);
      ++all.count;
    }
  }
  all.mean_px /= all.count;
  all.bias_px /= all.count;
  all.depth_mean_m /= all.count;
  return all;
}

class DrawnShape : public ::testing::Test {
 protected:
  void SetUp() override {
    if (const auto egl = probe_egl(); !egl.ok()) GTEST_SKIP() << egl.error().message;
  }

  /// Views from two heights, level and tilted to either side.
  static void expect_ground_in_place(const std::shared_ptr<const terrain::TileSource>& tiles) {
    const auto egl = create_egl_renderer(tiles);
    ASSERT_TRUE(egl.ok()) << egl.error().message;
    const auto raycast = create_raycast_renderer(tiles);
    for (const double height_m : {100.0, 300.0}) {
      for (const double roll_deg : {0.0, 20.0, -45.0}) {
        const RollPitchYaw attitude{rad_from_deg(roll_deg), 0.1, 0.7};
        const Pose pose{R_world_body_from(attitude) * R_body_camera_nadir(),
                        {kEastM, kNorthM, tiles->ground_up_m(kEastM, kNorthM) + height_m}};
        expect_in_place(*tiles, **egl, pose, "OpenGL", 0.03, 0.1);
        expect_in_place(*tiles, *raycast, pose, "rays", 0.02, 0.4);
      }
    }
  }

 private:
  static void expect_in_place(const terrain::TileSource& tiles,
                              Renderer& renderer,
                              const Pose& pose,
                              const char* name,
                              double mean_limit_px,
                              double worst_limit_px) {
    const auto depth = renderer.render_depth(camera(), pose);
    ASSERT_TRUE(depth.ok()) << depth.error().message;
    const Displacement off = displacement(tiles, *depth, pose);
    std::printf(
        "[ SHAPE    ] %-6s %3.0f m: mean %.4f px, bias %+.4f px, worst %.3f px, %.4f m (%d)\n",
        name,
        pose.translation.z() - tiles.ground_up_m(kEastM, kNorthM),
        off.mean_px,
        off.bias_px,
        off.worst_px,
        off.depth_mean_m,
        off.count);
    EXPECT_GT(off.count, 10'000) << name;
    EXPECT_LT(off.mean_px, mean_limit_px) << name;
    EXPECT_LT(off.worst_px, worst_limit_px) << name;
  }
};

TEST_F(DrawnShape, OfHillsKnownAsAFormula) {
  expect_ground_in_place(overfly::testing::natural_ground());
}

TEST_F(DrawnShape, OfTheBuiltInHills) {
  const TemporaryFolder folder;
  terrain::SynthesisOptions options;
  options.size_m = 2000.0;
  options.texel_m = 1.0;
  ASSERT_TRUE(terrain::synthesize_world(folder.path(), options).ok());
  const auto spec = terrain::read_world_manifest(folder.path() / "world.json");
  ASSERT_TRUE(spec.ok()) << spec.error().message;
  const auto world = terrain::open_world(*spec);
  ASSERT_TRUE(world.ok()) << world.error().message;
  expect_ground_in_place(world->tiles);
}

}  // namespace
}  // namespace overfly::renderer
