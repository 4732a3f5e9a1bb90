// Images with several in flight are the images drawn one by one.
#include "renderer/camera_pipeline.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/renderer/procedural_ground.hpp"

namespace overfly::renderer {
namespace {

class Pipeline : public ::testing::Test {
 protected:
  void SetUp() override {
    if (const auto egl = probe_egl(); !egl.ok()) GTEST_SKIP() << egl.error().message;
    overfly::testing::ProceduralGround::Options options;
    options.height_m = overfly::testing::hills_m;
    options.height_range_m = {-20.0, 20.0};
    options.paint = [](double east_m, double north_m) {
      return 60.0 + std::abs(std::remainder(3.0 * east_m + north_m, 100.0));
    };
    options.colourful = true;
    tiles_ = std::make_shared<overfly::testing::ProceduralGround>(options);
  }

  /// Sizes, formats and kinds of images change on the way.
  static CameraRequest request(int number) {
    const auto camera = PinholeCamera::from_fov(
        number % 3 == 2 ? 200 : 160, 120, rad_from_deg(80.0), FovAxis::kHorizontal);
    const PixelFormat formats[] = {
        PixelFormat::kGrey8, PixelFormat::kRgb8, PixelFormat::kGrey8, PixelFormat::kGreyLinear};
    CameraRequest request = CameraRequest::still(
        camera.value(),
        {R_world_body_from({0.1 * number, 0.0, 0.3 * number}) * R_body_camera_nadir(),
         {20.0 * number, -10.0, 150.0}},
        number,
        formats[number % 4]);
    if (number == 5) request.quality = RenderQuality::kReference;
    return request;
  }

  std::shared_ptr<const terrain::TileSource> tiles_;
};

TEST_F(Pipeline, GivesTheSameBytesInOrder) {
  const auto renderer = create_egl_renderer(tiles_);
  ASSERT_TRUE(renderer.ok());
  for (const int in_flight : {1, 3}) {
    auto pipeline = CameraPipeline::create(tiles_, {}, in_flight);
    ASSERT_TRUE(pipeline.ok()) << pipeline.error().message;
    constexpr int kFrames = 9;
    for (int i = 0; i < kFrames + in_flight; ++i) {
      if (i >= in_flight) {
        const auto frame = pipeline->finish();
        ASSERT_TRUE(frame.ok()) << frame.error().message;
        const auto expected = (*renderer)->render_camera(request(i - in_flight));
        ASSERT_TRUE(expected.ok());
        EXPECT_EQ(frame->t_ns, i - in_flight);
        EXPECT_EQ(frame->image.data, expected->image.data);
        EXPECT_EQ(frame->image.width_px, expected->image.width_px);
        EXPECT_EQ(frame->image.channels, expected->image.channels);
        EXPECT_EQ(frame->radiance.data, expected->radiance.data);
        EXPECT_EQ(frame->texels_per_pixel_median, expected->texels_per_pixel_median);
      }
      if (i < kFrames) {
        const Status begun = pipeline->begin(request(i));
        ASSERT_TRUE(begun.ok()) << begun.error().message;
      }
    }
  }
}

TEST_F(Pipeline, FinishReportsHeightsThatCouldNotBeRead) {
  overfly::testing::ProceduralGround::Options options;
  options.paint = [](double, double) { return 90.0; };
  options.heights_fail = true;
  auto pipeline =
      CameraPipeline::create(std::make_shared<overfly::testing::ProceduralGround>(options), {}, 2);
  ASSERT_TRUE(pipeline.ok());
  ASSERT_TRUE(pipeline->begin(request(0)).ok());
  const auto frame = pipeline->finish();
  ASSERT_FALSE(frame.ok());
  EXPECT_EQ(frame.error().code, ErrorCode::kIo);
  EXPECT_EQ(pipeline->finish().error().code, ErrorCode::kConflict) << "as many as were begun";
}

TEST_F(Pipeline, RefusesMoreThanFitAndLessThanOne) {
  auto pipeline = CameraPipeline::create(tiles_, {}, 1);
  ASSERT_TRUE(pipeline.ok());
  EXPECT_EQ(pipeline->finish().error().code, ErrorCode::kConflict);
  ASSERT_TRUE(pipeline->begin(request(0)).ok());
  EXPECT_EQ(pipeline->begin(request(1)).error().code, ErrorCode::kConflict);
  EXPECT_TRUE(pipeline->finish().ok());
  EXPECT_EQ(CameraPipeline::create(tiles_, {}, 0).error().code, ErrorCode::kInvalidArgument);
}

}  // namespace
}  // namespace overfly::renderer
