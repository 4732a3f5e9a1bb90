// Depth and error pictures, and what a pixel shows, of flights that are over.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <future>
#include <utility>

#include "server/camera/frame_remaker.hpp"
#include "server/files/jpeg.hpp"
#include "server/views/view_service.hpp"
#include "tests/server/support/manager_fixture.hpp"

namespace overfly::server {
namespace {

using ::testing::HasSubstr;

constexpr std::int64_t kPeriodNs = 100'000'000;

/// With the ray-caster, which needs no OpenGL.
class FramePictures : public testing::ManagerTest {
 protected:
  FramePictures() {
    RunManagerOptions drawn = options();
    drawn.renderer_factory = {};
    runs_ = std::move(RunManager::create(drawn).value());
  }

  std::string fly(std::vector<Override> overrides) {
    overrides.push_back({"renderer.camera", "raycast"});
    const std::string id = runs_->start("small", overrides).value().id;
    EXPECT_EQ(wait_for_end(*runs_, id).status, RunStatus::kCompleted);
    return id;
  }
  Result<Picture> picture(const PictureRequest& request) {
    ViewService views(*runs_);
    std::promise<Result<Picture>> answer;
    views.request(1, 1, request, [&](Result<Picture> made) { answer.set_value(std::move(made)); });
    return answer.get_future().get();
  }
  Result<PixelValue> pixel(const PixelRequest& request) {
    ViewService views(*runs_);
    std::promise<Result<PixelValue>> answer;
    views.probe(1, 1, request, [&](Result<PixelValue> seen) { answer.set_value(std::move(seen)); });
    return answer.get_future().get();
  }
  static PictureRequest request_of(PictureRequest::Kind kind, const std::string& id) {
    PictureRequest request;
    request.run_id = id;
    request.kind = kind;
    request.t_ns = 8 * kPeriodNs;
    request.quality = 100;
    return request;
  }
  static PixelRequest pixel_of(const std::string& id, double x_px, double y_px) {
    PixelRequest request;
    request.run_id = id;
    request.t_ns = 8 * kPeriodNs;
    request.x_px = x_px;
    request.y_px = y_px;
    return request;
  }
  FrameRow row(const std::string& id) const {
    return runs_->timeline(id).value()->frame_at(8 * kPeriodNs).value();
  }

  std::unique_ptr<RunManager> runs_;
};

Override camera_with(const std::string& more) {
  return {"camera",
          nlohmann::json::parse(R"({"width_px":160,"height_px":120,"rate_hz":10,)" + more + "}")};
}

TEST_F(FramePictures, DepthIsColouredBetweenTheEndsOfItsScale) {
  const std::string id = fly(perfect());
  const auto depth = picture(request_of(PictureRequest::Kind::kDepth, id));
  ASSERT_TRUE(depth.ok()) << depth.error().message;
  EXPECT_EQ(depth->frame, 8);
  EXPECT_EQ(depth->width_px, 160);
  ASSERT_TRUE(depth->scale);
  const auto centre = pixel(pixel_of(id, 79.5, 59.5));
  ASSERT_TRUE(centre.ok()) << centre.error().message;
  EXPECT_GT(centre->depth_m, depth->scale->low);
  EXPECT_LT(centre->depth_m, depth->scale->high);
  EXPECT_NEAR(centre->depth_m, *row(id).axis_depth_m, 0.5);
}

TEST_F(FramePictures, AReducedDepthKnowsTheSizeOfTheWholeImage) {
  const std::string id = fly(perfect());
  PictureRequest request = request_of(PictureRequest::Kind::kDepth, id);
  request.max_width_px = 80;
  const auto depth = picture(request);
  ASSERT_TRUE(depth.ok()) << depth.error().message;
  EXPECT_EQ(depth->width_px, 80);
  EXPECT_EQ(depth->height_px, 60);
  EXPECT_EQ(depth->full_width_px, 160);
  EXPECT_EQ(depth->full_height_px, 120);
}

TEST_F(FramePictures, APreviewShowsTheFrameInHalfItsSize) {
  const std::string id = fly(perfect());
  PictureRequest request = request_of(PictureRequest::Kind::kCamera, id);
  request.preview = true;
  const auto preview = picture(request);
  ASSERT_TRUE(preview.ok()) << preview.error().message;
  EXPECT_EQ(preview->frame, 8);
  EXPECT_EQ(preview->width_px, 80);
  EXPECT_TRUE(preview->preview);
  EXPECT_EQ(preview->full_width_px, 160);
  EXPECT_EQ(preview->full_height_px, 120);
  request.preview = false;
  EXPECT_EQ(picture(request)->width_px, 160);
  request.max_width_px = 80;
  const Image halved = decode_jpeg(*picture(request)->bytes).value();
  const Image half = decode_jpeg(*preview->bytes).value();
  double sum = 0.0;
  for (std::size_t i = 0; i < half.data.size(); ++i) sum += std::abs(half.data[i] - halved.data[i]);
  EXPECT_LT(sum / static_cast<double>(half.data.size()), 4.0) << "the same ground";
}

TEST_F(FramePictures, AFrameThatIsNotOnlyRenderedHasNoPreview) {
  auto overrides = perfect();
  overrides.push_back(camera_with(R"("sensor":{"vignette":[-0.3,0,0]})"));
  overrides.push_back(
      {"faults", nlohmann::json::parse(R"([{"kind":"blackout","at_s":1.5,"duration_s":0.4}])")});
  PictureRequest request = request_of(PictureRequest::Kind::kCamera, fly(overrides));
  request.preview = true;
  EXPECT_EQ(picture(request)->width_px, 160);
  overrides.erase(overrides.end() - 2);
  overrides.push_back(camera_with(R"("color":"grey")"));
  request.run_id = fly(overrides);
  EXPECT_EQ(picture(request)->width_px, 80);
  request.t_ns = 16 * kPeriodNs;
  EXPECT_EQ(picture(request)->width_px, 160) << "black";
}

TEST_F(FramePictures, APlainCameraHasNoSensorEffects) {
  const std::string id = fly(perfect());
  const auto error = picture(request_of(PictureRequest::Kind::kError, id));
  ASSERT_TRUE(error.ok()) << error.error().message;
  const Image image = decode_jpeg(*error->bytes).value();
  for (const std::uint8_t value : image.data) ASSERT_NEAR(value, 18, 4);
}

/// The dashboard asks for -0.5 at the left and upper edges.
TEST_F(FramePictures, ThePixelAtTheEdgeIsTheFirstOne) {
  const std::string id = fly(perfect());
  const auto first = pixel(pixel_of(id, 0.0, 0.0));
  ASSERT_TRUE(first.ok()) << first.error().message;
  const auto corner = pixel(pixel_of(id, -0.5, -0.5));
  ASSERT_TRUE(corner.ok()) << corner.error().message;
  EXPECT_EQ(corner->grey, first->grey);
  const auto last = pixel(pixel_of(id, 159.0, 119.0));
  const auto other_corner = pixel(pixel_of(id, 159.49, 119.49));
  ASSERT_TRUE(other_corner.ok()) << other_corner.error().message;
  EXPECT_EQ(other_corner->grey, last->grey);
}

TEST_F(FramePictures, ADifferenceIsOfTheEstimatorsCameraOnly) {
  const std::string id =
      fly({{"cameras",
            nlohmann::json::parse(R"([{"name":"wide","width_px":320,"height_px":240,"rate_hz":10},
                                  {"name":"small","width_px":64,"height_px":48,"rate_hz":10}])")},
           {"estimators",
            nlohmann::json::parse(R"([{"name":"p","type":"perfect","camera":"small"}])")}});
  PixelRequest far_out = pixel_of(id, 300.0, 200.0);
  far_out.error.emplace();
  far_out.error->estimator = 0;
  const auto refused = pixel(far_out);
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().code, ErrorCode::kInvalidArgument);
  EXPECT_THAT(refused.error().message,
              ::testing::HasSubstr(R"(uses camera "small", but the pixel is of camera "wide")"));
  far_out.camera = "small";
  far_out.x_px = 60.0;
  far_out.y_px = 40.0;
  const auto seen = pixel(far_out);
  ASSERT_TRUE(seen.ok()) << seen.error().message;
  EXPECT_EQ(seen->difference, 0);
}

TEST_F(FramePictures, NoiseVignetteAndFaultsAreSensorEffects) {
  auto overrides = perfect();
  overrides.push_back(camera_with(R"("sensor":{"read_noise_e":60,"vignette":[-0.3,0,0]})"));
  overrides.push_back(
      {"faults", nlohmann::json::parse(R"([{"kind":"blackout","at_s":1.5,"duration_s":0.4}])")});
  const std::string id = fly(overrides);
  PixelRequest corner = pixel_of(id, 2.0, 2.0);
  corner.error.emplace();
  const auto dark = pixel(corner);
  ASSERT_TRUE(dark.ok()) << dark.error().message;
  ASSERT_TRUE(dark->difference);
  EXPECT_LT(*dark->difference, -8) << "the vignette darkens the corner";
  PixelRequest black = pixel_of(id, 80.0, 60.0);
  black.error.emplace();
  black.t_ns = 16 * kPeriodNs;
  const auto blackout = pixel(black);
  ASSERT_TRUE(blackout.ok()) << blackout.error().message;
  EXPECT_LT(*blackout->difference, -40);
  EXPECT_LT(blackout->grey, 20);
}

TEST_F(FramePictures, AnEstimatesErrorIsThatOfItsPose) {
  const std::string id = fly({{"estimators",
                               nlohmann::json::parse(
                                   R"([{"name":"p","type":"perfect"},
                                       {"name":"d","type":"drifting",
                                        "parameters":{"drift":0.2}}])")}});
  const auto mean_luma = [&](std::size_t estimator) {
    PictureRequest request = request_of(PictureRequest::Kind::kError, id);
    request.error.estimator = estimator;
    request.t_ns = 18 * kPeriodNs;
    const auto error = picture(request);
    EXPECT_TRUE(error.ok()) << error.error().message;
    EXPECT_TRUE(error->scale);
    const Image image = decode_jpeg(*error->bytes).value();
    double sum = 0.0;
    for (const std::uint8_t value : image.data) sum += value;
    return sum / static_cast<double>(image.data.size());
  };
  EXPECT_NEAR(mean_luma(0), 18.0, 2.0) << "no difference";
  EXPECT_GT(mean_luma(1), 25.0) << "20 % of the path off";
}

TEST_F(FramePictures, AnEstimateThatDoesNotTrackHasNoPicture) {
  const std::string id =
      fly({{"estimators", nlohmann::json::parse(R"([{"name":"f","type":"feature"}])")}});
  PictureRequest request = request_of(PictureRequest::Kind::kError, id);
  request.error.estimator = 0;
  request.t_ns = 0;
  const auto error = picture(request);
  ASSERT_FALSE(error.ok());
  EXPECT_EQ(error.error().code, ErrorCode::kNotFound);
  request.error.estimator = 7;
  EXPECT_EQ(picture(request).error().code, ErrorCode::kInvalidArgument);
}

TEST_F(FramePictures, APixelShowsItsGreyLevelAndPlace) {
  auto overrides = perfect();
  overrides.push_back(camera_with(R"("color":"rgb")"));
  const std::string id = fly(overrides);
  const auto timeline = runs_->timeline(id).value();
  const Scenario scenario = runs_->scenario_of(id).value();
  const auto world = runs_->world_of(id, [] { return false; }).value();
  auto again = FrameRemaker::create(folder_of(id), scenario, world).value();
  const auto renderer = renderer::create_raycast_renderer(world->tiles);
  const Image whole = again->make(0, row(id), *renderer).value();
  const auto seen = pixel(pixel_of(id, 40.3, 30.6));
  ASSERT_TRUE(seen.ok()) << seen.error().message;
  ASSERT_TRUE(seen->rgb);
  for (int c = 0; c < 3; ++c) EXPECT_EQ((*seen->rgb)[c], whole.at(40, 31, c));
  EXPECT_EQ(seen->grey,
            (299 * (*seen->rgb)[0] + 587 * (*seen->rgb)[1] + 114 * (*seen->rgb)[2] + 500) / 1000);
  // Back from the ground to the pixel, by the camera's own projection.
  ASSERT_TRUE(seen->ground && seen->ground_world_m);
  const Pose T_world_camera = row(id).T_world_camera;
  const auto back = timeline->main_camera().model.project(
      T_world_camera.rotation.conjugate() * (*seen->ground_world_m - T_world_camera.translation));
  ASSERT_TRUE(back);
  EXPECT_NEAR(back->x(), 40.3, 0.01);
  EXPECT_NEAR(back->y(), 30.6, 0.01);
  EXPECT_NEAR((*seen->ground_world_m - T_world_camera.translation).norm(), seen->range_m, 1e-3);
  const Eigen::Vector3d from_geodetic = world->tiles->frame().world_from_geodetic(*seen->ground);
  EXPECT_LT((from_geodetic - *seen->ground_world_m).norm(), 1e-3);
  EXPECT_NEAR(seen->ground_world_m->z(),
              world->tiles->ground_up_m(seen->ground_world_m->x(), seen->ground_world_m->y()),
              0.01);
}

TEST_F(FramePictures, APixelOutsideTheImageIsRefused) {
  const std::string id = fly(perfect());
  const auto outside = pixel(pixel_of(id, 160.0, 10.0));
  ASSERT_FALSE(outside.ok());
  EXPECT_EQ(outside.error().code, ErrorCode::kInvalidArgument);
  EXPECT_THAT(outside.error().message, HasSubstr("x_px = 160: must be in [-0.5, 159.5)"));
  EXPECT_FALSE(pixel(pixel_of(id, 10.0, std::nan(""))).ok());
}

}  // namespace
}  // namespace overfly::server
