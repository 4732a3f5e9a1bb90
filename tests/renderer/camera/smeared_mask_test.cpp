// Cliffs on which imagery from above is smeared, in the mask of a camera image.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "renderer/camera/truth_images.hpp"
#include "tests/renderer/procedural_ground.hpp"

namespace overfly::renderer {
namespace {

/// Flat land, east of 40 m a slope that rises for 30 m of the map.
std::shared_ptr<const terrain::TileSource> slope_of(double slope_deg) {
  testing::ProceduralGround::Options options;
  options.curved = false;
  options.paint = [](double, double) { return 100.0; };
  const double rise = std::tan(rad_from_deg(slope_deg));
  options.height_m = [rise](double east_m, double) {
    return rise * std::clamp(east_m - 40.0, 0.0, 30.0);
  };
  options.height_range_m = {0.0, 30.0 * rise};
  return std::make_shared<testing::ProceduralGround>(options);
}

TEST(SmearedMask, MarksSlopesAbove60DegAlone) {
  for (const double slope_deg : {58.0, 62.0}) {
    const auto tiles = slope_of(slope_deg);
    const auto renderer = create_raycast_renderer(tiles);
    const PinholeCamera camera =
        PinholeCamera::from_fov(160, 120, rad_from_deg(60.0), FovAxis::kHorizontal).value();
    // Image top = north: columns follow the east.
    const Pose pose{R_world_body_from({0.0, 0.0, 0.0}) * R_body_camera_nadir(), {30.0, 0.0, 200.0}};
    const CameraRequest request = CameraRequest::still(camera, pose, 0, PixelFormat::kGrey8);
    const auto depth = renderer->render_depth(request);
    ASSERT_TRUE(depth) << depth.error().message;
    const PixelRays rays(camera);
    const PointImage points = world_points(rays, request, *depth);
    const Image mask = validity_mask(points, *tiles);
    int on_slope = 0;
    for (int y = 0; y < 120; ++y) {
      for (int x = 0; x < 160; ++x) {
        const double east_m = points.at(x, y);
        // A texel on either side of the slope's ends the differences see both.
        if (std::abs(east_m - 40.0) < 1.0 || std::abs(east_m - 70.0) < 1.0) continue;
        const bool steep = east_m > 40.0 && east_m < 70.0;
        on_slope += steep ? 1 : 0;
        const int expected = steep && slope_deg > 60.0 ? kMaskSmeared : kMaskImagery;
        ASSERT_EQ(mask.at(x, y), expected) << slope_deg << " deg, east " << east_m;
      }
    }
    EXPECT_GT(on_slope, 500);
  }
}

}  // namespace
}  // namespace overfly::renderer
