// The patches chosen for a view: all that it sees, once, as fine as the image needs and no finer.
#include "renderer/ground/ground_selection.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <random>
#include <vector>

#include "renderer/worker_pool.hpp"
#include "tests/renderer/procedural_ground.hpp"

namespace overfly::renderer {
namespace {

using terrain::TileId;

std::shared_ptr<const terrain::TileSource> plain_world() {
  overfly::testing::ProceduralGround::Options options;
  options.curved = false;
  return std::make_shared<overfly::testing::ProceduralGround>(options);
}

/// The leaf that covers a place of the map; fails if there are two.
const GroundLeaf* leaf_at(const std::vector<GroundLeaf>& leaves,
                          const terrain::TileGrid& grid,
                          const Eigen::Vector2d& map_m) {
  const GroundLeaf* found = nullptr;
  for (const GroundLeaf& leaf : leaves) {
    const double size_m = leaf.patch->size_map_m;
    const TileId& id = leaf.patch->id;
    if (std::floor((map_m.x() - grid.left_x_m) / size_m) != id.col) continue;
    if (std::floor((grid.top_y_m - map_m.y()) / size_m) != id.row) continue;
    EXPECT_EQ(found, nullptr) << "covered twice";
    found = &leaf;
  }
  return found;
}

TEST(GroundSelection, CoversWhatIsSeenOnceAndFinelyEnough) {
  const auto world = plain_world();
  GroundPatches patches(world);
  const PinholeCamera camera{640, 480, 400.0, 400.0, 319.5, 239.5};
  std::mt19937 random(17);
  for (const RollPitchYaw attitude :
       {RollPitchYaw{0.0, 0.0, 0.0}, {0.6, 0.1, 1.0}, {-0.2, 0.9, 2.0}, {0.0, 1.3, -1.0}}) {
    for (const double height_m : {20.0, 150.0, 1200.0}) {
      const Pose pose{R_world_body_from(attitude) * R_body_camera_nadir(), {40.0, 70.0, height_m}};
      const View view = View::from(camera, pose);
      const auto leaves = select_ground(patches, view, {}, [](const GroundPatch&) {});
      for (int trial = 0; trial < 300; ++trial) {
        const Eigen::Vector2d pixel(random() % 640, random() % 480);
        const Eigen::Vector3d ray = camera.ray(pixel);
        const Eigen::Vector3d direction = pose.rotation * ray;
        const double depth_m = -height_m / direction.z();
        // Up to the horizon of a round earth, which ends the ground.
        if (depth_m < 0.0 || depth_m * direction.norm() > 5000.0) continue;
        const Eigen::Vector3d p = pose.translation + depth_m * direction;
        const Eigen::Vector2d map = world->map_from_world(p.x(), p.y());
        const GroundLeaf* leaf = leaf_at(leaves, world->grid(), map);
        ASSERT_NE(leaf, nullptr) << "a hole at " << p.transpose();
        if (!world->has_imagery(map.x(), map.y())) continue;
        ASSERT_TRUE(leaf->textured);
        EXPECT_EQ(leaf->texture, GroundPatches::tile_of(leaf->patch->id));
        // The footprint's shorter side: texels are not larger, except those of level 0.
        const Eigen::Vector3d p_camera = depth_m * ray;
        const Eigen::Vector2d east = view.pixel_rate(p_camera, view.R_camera_world.col(0));
        const Eigen::Vector2d north = view.pixel_rate(p_camera, view.R_camera_world.col(1));
        const double determinant = std::abs(east.x() * north.y() - east.y() * north.x());
        const double longest = std::max(east.norm(), north.norm());
        const double longer_side_texels = longest / determinant / world->grid().texel_m;
        EXPECT_LE(std::exp2(leaf->texture.level), std::max(1.0, 1.01 * longer_side_texels));
      }
      patches.end_view();
    }
  }
}

TEST(GroundSelection, NeitherLooksBehindNorWastesTexels) {
  const auto world = plain_world();
  GroundPatches patches(world);
  const PinholeCamera camera{320, 240, 200.0, 200.0, 159.5, 119.5};
  // 800 m up a pixel is 4 m wide: level 3 has 4 m, and level 2 is needed by the margin.
  const View nadir =
      View::from(camera, {R_world_body_from({}) * R_body_camera_nadir(), {0, 0, 800}});
  int divided = 0;
  const auto leaves = select_ground(patches, nadir, {}, [&](const GroundPatch& patch) {
    ++divided;
    EXPECT_GT(patch.size_map_m, 0.0);
  });
  EXPECT_GT(divided, 0);
  for (const GroundLeaf& leaf : leaves) {
    EXPECT_GE(leaf.patch->id.level, 2);
    EXPECT_LE(leaf.patch->id.level, 3);
    const Eigen::AlignedBox2d seen(Eigen::Vector2d(-640.0, -480.0), Eigen::Vector2d(640.0, 480.0));
    const Eigen::AlignedBox2d held(leaf.patch->bounds.min().head<2>(),
                                   leaf.patch->bounds.max().head<2>());
    EXPECT_TRUE(seen.intersects(held));
    // A metre on the map in pixels; nothing at points of invisible parts.
    for (int i = 0; i < 25; ++i) {
      if (leaf.px_per_map_m[i] != 0.0F) {
        EXPECT_NEAR(leaf.px_per_map_m[i], 0.25, 1e-3);
      } else {
        EXPECT_FALSE(seen.contains(leaf.patch->outline[i].head<2>()));
      }
    }
  }
  const Pose up{Eigen::Quaterniond::Identity(), {0.0, 0.0, 100.0}};  // looks up
  EXPECT_TRUE(
      select_ground(patches, View::from(camera, up), {}, [](const GroundPatch&) {}).empty());
}

/// Hills, whose relief divides patches further than their texels do.
std::shared_ptr<const terrain::TileSource> hilly_world() {
  overfly::testing::ProceduralGround::Options options;
  options.height_m = overfly::testing::hills_m;
  options.height_range_m = {-20.0, 20.0};
  return std::make_shared<overfly::testing::ProceduralGround>(options);
}

TEST(GroundSelection, SeveralThreadsSelectTheSame) {
  const auto world = hilly_world();
  const PinholeCamera camera{640, 480, 400.0, 400.0, 319.5, 239.5};
  const View view = View::from(
      camera, {R_world_body_from({0.3, 0.5, 1.0}) * R_body_camera_nadir(), {40.0, 70.0, 90.0}});
  WorkerPool workers(3);
  GroundPatches alone(world);
  GroundPatches together(std::make_shared<GroundPatchStore>(world), &workers);
  const auto expected = select_ground(alone, view, {}, [](const GroundPatch&) {});
  ASSERT_GT(expected.size(), 10U);
  for (int round = 0; round < 2; ++round) {
    const auto leaves = select_ground(together, view, {}, [](const GroundPatch&) {});
    ASSERT_EQ(leaves.size(), expected.size());
    for (std::size_t i = 0; i < leaves.size(); ++i) {
      EXPECT_EQ(leaves[i].patch->id, expected[i].patch->id);
      EXPECT_EQ(leaves[i].patch->points, expected[i].patch->points);
      EXPECT_EQ(leaves[i].patch->square_error_m, expected[i].patch->square_error_m);
    }
  }
}

}  // namespace
}  // namespace overfly::renderer
