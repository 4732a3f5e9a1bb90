// OpenGL and the ray-caster draw the same picture: two implementations that share the ground and
// its texels, but neither the geometry nor the sampling.
#include <gtest/gtest.h>

#include <cstdio>

#include "renderer/renderer.hpp"
#include "renderer/tiles/tile_store.hpp"
#include "tests/renderer/image_distance.hpp"
#include "tests/renderer/procedural_ground.hpp"

namespace overfly::renderer {
namespace {

using overfly::testing::ProceduralGround;
using overfly::testing::psnr_db;

/// With more detail than a picture from 300 m can show.
double fine_paint(double east_m, double north_m) {
  return overfly::testing::natural_paint(3.0 * east_m, 3.0 * north_m);
}

std::shared_ptr<ProceduralGround> painted_ground(bool hills) {
  ProceduralGround::Options options;
  options.paint = fine_paint;
  options.colourful = true;
  if (hills) {
    options.height_m = overfly::testing::hills_m;
    options.height_range_m = {-20.0, 20.0};
  }
  return std::make_shared<ProceduralGround>(options);
}

/// The paper's camera at half its size.
PinholeCamera camera_640() {
  return PinholeCamera::from_fov(640, 480, rad_from_deg(84.872), FovAxis::kHorizontal).value();
}

Pose tilted_pose(double roll_rad, double pitch_rad, double height_m, double east_m = 0.0) {
  return {R_world_body_from({roll_rad, pitch_rad, 0.7}) * R_body_camera_nadir(),
          {east_m, 20.0, height_m}};
}

class BackendsAgree : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    if (!probe_egl().ok()) return;
    open(painted_ground(false), flat_);
    open(painted_ground(true), hills_);
  }
  static void TearDownTestSuite() {
    flat_ = {};
    hills_ = {};
  }
  void SetUp() override {
    if (const auto egl = probe_egl(); !egl.ok()) GTEST_SKIP() << "no EGL: " << egl.error().message;
    ASSERT_TRUE(flat_.egl != nullptr && hills_.egl != nullptr);
  }

  struct Pair {
    std::unique_ptr<Renderer> egl, raycast;
  };
  static void open(const std::shared_ptr<const terrain::TileSource>& tiles, Pair& pair) {
    RendererOptions options;
    options.device = "software";
    options.tile_store = std::make_shared<TileStore>(tiles, TileStoreOptions{});
    auto egl = create_egl_renderer(tiles, options);
    ASSERT_TRUE(egl.ok()) << egl.error().message;
    pair.egl = std::move(*egl);
    pair.raycast = create_raycast_renderer(tiles, options);
  }

  static double agreement_db(const char* what, Pair& pair, const CameraRequest& request) {
    const auto a = pair.egl->render_camera(request);
    const auto b = pair.raycast->render_camera(request);
    EXPECT_TRUE(a.ok() && b.ok());
    if (!a.ok() || !b.ok()) return 0.0;
    EXPECT_NEAR(
        a->texels_per_pixel_median, b->texels_per_pixel_median, 0.02 * a->texels_per_pixel_median);
    EXPECT_NEAR(a->void_fraction, b->void_fraction, 0.01);
    const double db = is_linear(request.format) ? psnr_db(a->radiance, b->radiance, 1.0)
                                                : psnr_db(a->image, b->image, 255.0);
    std::printf("[ PSNR     ] %s: %.1f dB\n", what, db);
    return db;
  }

  /// @param flat_db, hill_db  bounds over flat ground and over hills
  void expect(const char* what, const CameraRequest& request, double flat_db, double hill_db) {
    EXPECT_GE(agreement_db((std::string(what) + ", flat").c_str(), flat_, request), flat_db);
    EXPECT_GE(agreement_db((std::string(what) + ", hills").c_str(), hills_, request), hill_db);
  }

  static inline Pair flat_, hills_;
};

TEST_F(BackendsAgree, OnNadirAndObliqueViewsHighAndLow) {
  for (const double height_m : {60.0, 300.0}) {
    for (const double pitch_rad : {0.0, 0.6}) {
      const double bound_db = pitch_rad == 0.0 ? 52.0 : 48.0;
      const std::string what = std::to_string(static_cast<int>(height_m)) + " m, pitch " +
                               std::to_string(pitch_rad).substr(0, 3);
      expect(what.c_str(),
             CameraRequest::still(
                 camera_640(), tilted_pose(0.2, pitch_rad, height_m), 0, PixelFormat::kGrey8),
             bound_db,
             bound_db);
    }
  }
}

TEST_F(BackendsAgree, WithTheHorizonInTheImage) {
  expect("horizon",
         CameraRequest::still(camera_640(), tilted_pose(0.9, 0.1, 300.0), 0, PixelFormat::kGrey8),
         47.0,
         44.5);
}

TEST_F(BackendsAgree, InEveryPixelFormat) {
  for (const PixelFormat format :
       {PixelFormat::kRgb8, PixelFormat::kGreyLinear, PixelFormat::kRgbLinear}) {
    const std::string what = "format " + std::to_string(static_cast<int>(format));
    expect(what.c_str(),
           CameraRequest::still(camera_640(), tilted_pose(0.1, 0.3, 150.0), 0, format),
           50.0,
           50.0);
  }
}

TEST_F(BackendsAgree, AtReferenceQualityAndInHaze) {
  CameraRequest request =
      CameraRequest::still(camera_640(), tilted_pose(0.1, 0.3, 300.0), 0, PixelFormat::kGrey8);
  request.quality = RenderQuality::kReference;
  expect("reference", request, 53.0, 52.0);
  request.quality = RenderQuality::kTrilinear;
  request.atmosphere.extinction_per_m = 1e-3;
  expect("haze", request, 52.0, 52.0);
}

// OpenGL resamples pinhole pictures by cubic convolution where the ray-caster follows every ray.
TEST_F(BackendsAgree, ThroughEveryLens) {
  for (const Distortion& lens : {Distortion{DistortionModel::kRadtan, {-0.28, 0.08, 2e-4, -1e-4}},
                                 Distortion{DistortionModel::kEquidistant, {-0.01, 0.002, 0, 0}},
                                 Distortion{DistortionModel::kFov, {0.9}}}) {
    CameraRequest request =
        CameraRequest::still(camera_640(), tilted_pose(0.1, 0.1, 300.0), 0, PixelFormat::kGrey8);
    request.camera = CameraModel(camera_640(), lens);
    expect(to_string(lens.model), request, 47.5, 47.5);
  }
}

// OpenGL draws rows in groups that share a pose, the ray-caster gives every row its own.
TEST_F(BackendsAgree, WithARollingShutterAndMotionBlur) {
  CameraRequest request =
      CameraRequest::still(camera_640(), tilted_pose(0.0, 0.1, 300.0), 0, PixelFormat::kGrey8);
  request.T_world_camera =
      CameraMotion::from_poses(
          {{0, tilted_pose(-0.02, 0.1, 300.0)}, {40'000'000, tilted_pose(0.02, 0.1, 300.0, 1.0)}})
          .value();
  request.t_ns = 20'000'000;
  request.readout_ns = 20'000'000;
  expect("rolling shutter", request, 52.0, 52.0);
  request.exposure_ns = 8'000'000;
  expect("rolling shutter and blur", request, 54.0, 54.0);
}

TEST_F(BackendsAgree, TheMeasureSeesAQuarterOfAPixel) {
  const double pixel_m = 300.0 / camera_640().fx_px;
  const auto draw = [&](double shift_px) {
    return flat_.raycast->render_camera(
        camera_640(), tilted_pose(0.0, 0.0, 300.0, shift_px * pixel_m), 0, PixelFormat::kGrey8);
  };
  const auto a = draw(0.0);
  const auto b = draw(0.25);
  ASSERT_TRUE(a.ok() && b.ok());
  const double db = psnr_db(a->image, b->image, 255.0);
  std::printf("[ PSNR     ] 0.25 px apart: %.1f dB\n", db);
  EXPECT_LT(db, 49.0);
}

}  // namespace
}  // namespace overfly::renderer
