#include "renderer/probes/bench_probe.hpp"

#include <gtest/gtest.h>

#include "tests/renderer/procedural_ground.hpp"

namespace overfly::renderer {
namespace {

TEST(BenchProbe, MeasuresEveryKindOfView) {
  if (const auto egl = probe_egl(); !egl.ok()) GTEST_SKIP() << egl.error().message;
  const auto tiles = overfly::testing::natural_ground();
  const Pose pose{R_body_camera_nadir(), {0, 0, 250}};
  const Pose down{R_world_body_from({}) * pose.rotation, pose.translation};
  const auto costs = measure_render_costs(tiles, {down}, 2);
  ASSERT_TRUE(costs.ok()) << costs.error().message;
  for (const CallCost& cost :
       {costs->quad, costs->camera_grey, costs->camera_rgb, costs->depth, costs->scene}) {
    EXPECT_GT(cost.cpu_ms, 0.0);
    EXPECT_GT(cost.wall_ms, 0.0);
  }
  EXPECT_GT(costs->camera_per_quad, 0.0);
  EXPECT_GT(costs->raycast_per_quad, 0.0);
  EXPECT_GT(costs->raycast_banked_per_quad, 0.0);
}

TEST(BenchProbe, MeasuresRatesBesideTheirCeilings) {
  if (const auto egl = probe_egl(); !egl.ok()) GTEST_SKIP() << egl.error().message;
  const Pose down{R_world_body_from({}) * R_body_camera_nadir(), {0, 0, 250}};
  const auto costs = measure_rate_costs(overfly::testing::natural_ground(), {down}, 1, "software");
  ASSERT_TRUE(costs.ok()) << costs.error().message;
  EXPECT_TRUE(costs->renderer.software);
  EXPECT_GT(costs->memcpy_ms, 0.0);
  EXPECT_GT(costs->readback_per_memcpy, 0.0);
  EXPECT_GT(costs->fill_per_s, 0.0);
  EXPECT_GT(costs->copy_per_s, 0.0);
  ASSERT_EQ(costs->camera.size(), 3U);
  for (const auto& rate : costs->camera) EXPECT_GT(rate.per_s, 0.0);
}

TEST(BenchProbe, RefusesToMeasureNothing) {
  const auto tiles = overfly::testing::natural_ground();
  EXPECT_EQ(measure_render_costs(tiles, {}, 1).error().code, ErrorCode::kInvalidArgument);
  EXPECT_EQ(measure_render_costs(tiles, {Pose()}, 0).error().code, ErrorCode::kInvalidArgument);
}

}  // namespace
}  // namespace overfly::renderer
