// The camera frame's geometry against projections made without any of our own code.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "renderer/renderer.hpp"
#include "terrain/world.hpp"
#include "tests/renderer/checkerboard_world.hpp"
#include "tests/support/support.hpp"

namespace overfly::renderer {
namespace {

using overfly::testing::CheckerboardSpec;

struct Place {
  const char* name;
  int epsg;
  double left_m, top_m;
  bool pixel_is_point;
};

struct Deviation {
  int corners = 0;
  cv::Point2d bias_px, rms_px;
};

/// Bright to dark corners found in the image, near where they should be, against where they
/// should be. Corners whose squares are too small in the image to be measured are left out.
Deviation deviation_of(const Image& image,
                       const std::vector<cv::Point2d>& expected,
                       int corners_per_row) {
  cv::Mat grey(
      image.height_px, image.width_px, CV_8UC1, const_cast<std::uint8_t*>(image.data.data()));
  constexpr int kHalfWindowPx = 4;
  const cv::Rect2d inside(12, 12, image.width_px - 24, image.height_px - 24);
  std::vector<cv::Point2f> found;
  std::vector<cv::Point2d> wanted;
  for (std::size_t i = 0; i + corners_per_row < expected.size(); ++i) {
    const cv::Point2d east = expected[i + 1] - expected[i];
    const cv::Point2d south = expected[i + corners_per_row] - expected[i];
    const double area_px2 = std::abs(east.cross(south));
    const double longest_px = std::max(cv::norm(east), cv::norm(south));
    // At least 10 px between opposite sides, so that the window holds one corner only.
    if (!inside.contains(expected[i]) || area_px2 < 10.0 * longest_px) continue;
    wanted.push_back(expected[i]);
    // Begin off the expected place: the search must find the corner, not keep the guess.
    found.emplace_back(static_cast<float>(expected[i].x + 0.8),
                       static_cast<float>(expected[i].y - 0.7));
  }
  Deviation deviation;
  if (found.empty()) return deviation;
  cv::cornerSubPix(grey,
                   found,
                   {kHalfWindowPx, kHalfWindowPx},
                   {-1, -1},
                   {cv::TermCriteria::EPS + cv::TermCriteria::COUNT, 100, 1e-4});
  deviation.corners = static_cast<int>(found.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    const cv::Point2d d(found[i].x - wanted[i].x, found[i].y - wanted[i].y);
    deviation.bias_px += d / deviation.corners;
    deviation.rms_px += cv::Point2d(d.x * d.x, d.y * d.y) / deviation.corners;
  }
  deviation.rms_px = {std::sqrt(deviation.rms_px.x), std::sqrt(deviation.rms_px.y)};
  return deviation;
}

class CameraGeometry : public ::testing::TestWithParam<Place> {};

TEST_P(CameraGeometry, CheckerboardCornersLieWhereProjAndOpenCvPutThem) {
  if (const auto egl = probe_egl(); !egl.ok()) GTEST_SKIP() << egl.error().message;
  const Place place = GetParam();
  for (const double relief_m : {0.0, 12.0}) {
    CheckerboardSpec spec;
    spec.epsg = place.epsg;
    spec.left_m = place.left_m;
    spec.top_m = place.top_m;
    spec.pixel_is_point = place.pixel_is_point;
    spec.relief_m = relief_m;
    const overfly::testing::TemporaryFolder folder;
    overfly::testing::write_checkerboard(spec, folder.path());
    terrain::WorldSpec world_spec;
    world_spec.imagery.emplace_back().file = folder.path() / "board.tif";
    terrain::ElevationLayer elevation;
    elevation.file = folder.path() / "ground.tif";
    elevation.datum = terrain::VerticalDatum::kEllipsoid;
    world_spec.elevation.push_back(elevation);
    const auto world = terrain::open_world(world_spec);
    ASSERT_TRUE(world.ok()) << world.error().message;
    const LocalFrame& frame = world->tiles->frame();
    const auto renderer = create_egl_renderer(world->tiles);
    ASSERT_TRUE(renderer.ok()) << renderer.error().message;
    const auto corners = overfly::testing::corners_ecef(spec);
    const int corners_per_row = spec.texels / spec.texels_per_square - 1;

    PinholeCamera centred =
        PinholeCamera::from_fov(1280, 960, rad_from_deg(84.872), FovAxis::kHorizontal).value();
    PinholeCamera skewed = centred;
    skewed.fx_px = 820.0;
    skewed.fy_px = 760.0;
    skewed.cx_px = 500.3;
    skewed.cy_px = 610.8;
    struct Case {
      const char* name;
      RollPitchYaw attitude;
      double height_m;
      const PinholeCamera& camera;
    };
    const Case cases[] = {
        {"nadir", {0.0, 0.0, 0.0}, 250.0, centred},
        {"turned", {0.02, -0.03, 2.2}, 300.0, centred},
        {"tilted", {rad_from_deg(20), rad_from_deg(-12), rad_from_deg(57)}, 220.0, centred},
        {"banked", {rad_from_deg(45), rad_from_deg(5), rad_from_deg(-140)}, 200.0, centred},
        {"off-centre camera", {rad_from_deg(-15), rad_from_deg(10), 1.0}, 250.0, skewed}};
    for (const Case& view : cases) {
      SCOPED_TRACE(std::string(view.name) + ", relief " + std::to_string(relief_m));
      const double x_m = spec.left_m + 371.3, y_m = spec.top_m - 402.7;
      const cv::Point2d lat_lon = overfly::testing::lat_lon_by_proj(spec.epsg, x_m, y_m);
      const double alt_m = spec.height_m(x_m, y_m) + view.height_m;
      const Pose pose{R_world_body_from(view.attitude) * R_body_camera_nadir(),
                      frame.world_from_geodetic(geodetic_from_deg(lat_lon.x, lat_lon.y, alt_m))};
      const auto image = (*renderer)->render_camera(view.camera, pose, 0, PixelFormat::kGrey8);
      ASSERT_TRUE(image.ok()) << image.error().message;
      const auto expected = overfly::testing::project_by_opencv(
          corners,
          overfly::testing::ecef_by_proj(lat_lon.x, lat_lon.y, alt_m),
          frame.origin().lat_rad,
          frame.origin().lon_rad,
          view.attitude,
          view.camera);
      const Deviation deviation = deviation_of(image->image, expected, corners_per_row);
      std::printf(
          "[ GEOMETRY ] %s %s relief %.0f m: %d corners, bias %.4f %.4f px, rms %.4f %.4f px\n",
          place.name,
          view.name,
          relief_m,
          deviation.corners,
          deviation.bias_px.x,
          deviation.bias_px.y,
          deviation.rms_px.x,
          deviation.rms_px.y);
      EXPECT_GT(deviation.corners, 100);
      EXPECT_LT(std::abs(deviation.bias_px.x), 0.05);
      EXPECT_LT(std::abs(deviation.bias_px.y), 0.05);
      EXPECT_LT(deviation.rms_px.x, 0.1);
      EXPECT_LT(deviation.rms_px.y, 0.1);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Latitudes,
                         CameraGeometry,
                         ::testing::Values(Place{"Indiana", 32616, 582000.0, 4356000.0, false},
                                           Place{"Sydney", 32756, 334000.0, 6252000.0, true},
                                           Place{"Iceland", 32627, 455000.0, 7110000.0, false},
                                           Place{"IcelandPoint", 32627, 455000.0, 7110000.0, true}),
                         [](const auto& suite) { return std::string(suite.param.name); });

}  // namespace
}  // namespace overfly::renderer
