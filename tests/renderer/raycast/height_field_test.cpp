// The ray-caster's ground: bounded however far the flight, and the same whatever it has forgotten.
#include "renderer/raycast/ground/height_field.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <functional>
#include <new>

#include "renderer/raycast/ground/ground_caster.hpp"
#include "renderer/raycast/ground/view_sweep.hpp"
#include "tests/renderer/procedural_ground.hpp"

namespace overfly::renderer::raycast {
namespace {

using overfly::testing::hills_m;

std::shared_ptr<const terrain::TileSource> hills(
    const std::function<double(double, double)>& height_m = hills_m) {
  overfly::testing::ProceduralGround::Options options;
  options.height_m = height_m;
  options.height_range_m = {-20.0, 20.0};
  options.paint = overfly::testing::natural_paint;
  return std::make_shared<overfly::testing::ProceduralGround>(options);
}

CameraRequest request_at(double north_m) {
  const PinholeCamera camera =
      PinholeCamera::from_fov(320, 240, rad_from_deg(84.872), FovAxis::kHorizontal).value();
  const Pose pose{R_world_body_from({0.2, 0.0, 0.0}) * R_body_camera_nadir(),
                  {0.0, north_m, 300.0 + hills_m(0.0, north_m)}};
  return CameraRequest::still(camera, pose, 0, PixelFormat::kGrey8);
}

double axis_depth_m(const GroundTree& tree, const CameraRequest& request) {
  const Pose pose = request.T_world_camera.at(0);
  const Eigen::Vector3d axis = pose.rotation * Eigen::Vector3d::UnitZ();
  return GroundCaster(tree).cast(pose.translation, axis, 0.0).depth;
}

TEST(HeightField, KeepsABoundedNumberOfTilesOverFiveKilometres) {
  constexpr std::size_t kMaxTiles = 150;
  HeightField bounded(hills(), kMaxTiles);
  HeightField unbounded(hills(), 1'000'000);
  const RayGrid rays(request_at(0.0).camera);
  std::size_t most = 0, in_view = 0;
  for (double north_m = 0.0; north_m <= 5000.0; north_m += 50.0) {
    const CameraRequest request = request_at(north_m);
    const ViewSweep sweep = sweep_of(request, rays);
    const GroundTree& tree = bounded.select(sweep);
    in_view = std::max(in_view, tree.nodes.size());
    most = std::max(most, bounded.held_tiles());
    ASSERT_EQ(axis_depth_m(tree, request), axis_depth_m(unbounded.select(sweep), request));
  }
  std::printf("[ TILES    ] at most %zu held, %zu in view; %zu met\n",
              most,
              in_view,
              unbounded.held_tiles());
  // Squares that were examined and are out of view are held in addition to those in view.
  EXPECT_LE(most, kMaxTiles + 2 * in_view);
  EXPECT_GT(unbounded.held_tiles(), 2 * most);
}

TEST(HeightField, PreparesALaterViewOneTileAtATime) {
  HeightField field(hills());
  const RayGrid rays(request_at(0.0).camera);
  const ViewSweep later = sweep_of(request_at(600.0), rays);
  (void)field.select(sweep_of(request_at(0.0), rays));
  const std::size_t first = field.held_tiles();
  for (std::size_t before = 0; field.held_tiles() != before;) {
    before = field.held_tiles();
    field.prepare(later);
    ASSERT_LE(field.held_tiles(), before + 1);
  }
  const std::size_t prepared = field.held_tiles();
  EXPECT_GT(prepared, first);
  (void)field.select(later);
  EXPECT_EQ(field.held_tiles(), prepared) << "the view itself found tiles missing";
}

TEST(HeightField, IsCompleteAfterMemoryRanOut) {
  bool out_of_memory = false;
  HeightField field(hills([&](double east_m, double north_m) {
    if (out_of_memory) throw std::bad_alloc();
    return hills_m(east_m, north_m);
  }));
  const CameraRequest request = request_at(0.0);
  const ViewSweep sweep = sweep_of(request, RayGrid(request.camera));
  out_of_memory = true;
  EXPECT_THROW((void)field.select(sweep), std::bad_alloc);
  EXPECT_EQ(field.held_tiles(), 0U);
  out_of_memory = false;
  HeightField untroubled(hills());
  EXPECT_EQ(axis_depth_m(field.select(sweep), request),
            axis_depth_m(untroubled.select(sweep), request));
}

}  // namespace
}  // namespace overfly::renderer::raycast
