// What the keys of pictures depend on.
#include "server/frame_cache/frame_key.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <set>

#include "tests/server/support/server_fixture.hpp"

namespace overfly::server {
namespace {

using renderer::CameraRequest;
using testing::small_scenario;

CameraRequest moving_request() {
  CameraRequest request;
  PinholeCamera pinhole;
  pinhole.fx_px = pinhole.fy_px = 700.0;
  request.camera = CameraModel(pinhole, {DistortionModel::kRadtan, {0.1, 0.2, 0.0, 0.0, 0.0}});
  std::vector<StampedPose> poses(3);
  for (int i = 0; i < 3; ++i) {
    poses[i].t_ns = 1000 * i;
    poses[i].pose.translation.x() = i;
  }
  request.T_world_camera = CameraMotion::from_poses(poses).value();
  request.t_ns = 1000;
  request.exposure_ns = 500;
  request.readout_ns = 200;
  return request;
}

TEST(FrameKey, DependsOnEverythingThatIsDrawn) {
  using Change = std::function<void(CameraRequest&)>;
  const auto with_pose = [](const std::function<void(std::vector<StampedPose>&)>& change) {
    return [change](CameraRequest& request) {
      std::vector<StampedPose> poses = request.T_world_camera.poses();
      change(poses);
      request.T_world_camera = CameraMotion::from_poses(poses).value();
    };
  };
  const auto with_camera = [](const std::function<void(PinholeCamera&, Distortion&)>& change) {
    return [change](CameraRequest& request) {
      PinholeCamera pinhole = request.camera.pinhole();
      Distortion distortion = request.camera.distortion();
      change(pinhole, distortion);
      request.camera = CameraModel(pinhole, distortion);
    };
  };
  const std::vector<Change> changes = {
      [](CameraRequest&) {},
      with_pose([](auto& poses) { poses[2].pose.translation.z() = 1e-12; }),
      with_pose([](auto& poses) { poses[0].pose.rotation.z() = 1e-12; }),
      with_pose([](auto& poses) { poses[0].t_ns -= 1; }),
      with_pose([](auto& poses) { poses.pop_back(); }),
      with_camera([](auto& pinhole, auto&) { pinhole.width_px += 1; }),
      with_camera([](auto& pinhole, auto&) { pinhole.height_px += 1; }),
      with_camera([](auto& pinhole, auto&) { pinhole.fx_px += 1e-9; }),
      with_camera([](auto& pinhole, auto&) { pinhole.fy_px += 1e-9; }),
      with_camera([](auto& pinhole, auto&) { pinhole.cx_px += 1e-9; }),
      with_camera([](auto& pinhole, auto&) { pinhole.cy_px += 1e-9; }),
      with_camera([](auto&, auto& distortion) { distortion.k[4] = 1e-9; }),
      with_camera([](auto&, auto& distortion) { distortion = {}; }),
      [](CameraRequest& request) { request.t_ns += 1; },
      [](CameraRequest& request) { request.exposure_ns += 1; },
      [](CameraRequest& request) { request.readout_ns += 1; },
      [](CameraRequest& request) { std::swap(request.exposure_ns, request.readout_ns); },
      [](CameraRequest& request) { request.format = renderer::PixelFormat::kGreyLinear; },
      [](CameraRequest& request) { request.format = renderer::PixelFormat::kRgb8; },
      [](CameraRequest& request) { request.quality = renderer::RenderQuality::kReference; },
      [](CameraRequest& request) { request.atmosphere.extinction_per_m = 1e-6; },
      [](CameraRequest& request) { request.atmosphere.airlight_rgb[2] = 0.5F; },
  };
  std::set<std::string> keys;
  for (const Change& change : changes) {
    CameraRequest request = moving_request();
    change(request);
    keys.insert(frame_key("context", request));
  }
  EXPECT_EQ(keys.size(), changes.size());
  keys.insert(frame_key("other context", moving_request()));
  EXPECT_EQ(keys.size(), changes.size() + 1);
}

TEST(FrameKey, DoesNotDependOnWhatIsOnlyReadAhead) {
  CameraRequest request = moving_request();
  const std::string key = frame_key("context", request);
  request.velocity_world_m_s = {1.0, 2.0, 3.0};
  request.tile_wait_ns = 0;
  EXPECT_EQ(frame_key("context", request), key);
}

std::string context_of(const Scenario& scenario, const renderer::RendererInfo& info) {
  const auto opened = open_scenario_world(scenario);
  if (!opened) throw std::runtime_error(opened.error().message);
  return picture_context(scenario, *opened, info);
}

TEST(PictureContext, DependsOnTheWorldItsLightAndTheRenderer) {
  renderer::RendererInfo raycast;
  raycast.backend = "raycast";
  raycast.device = "CPU, 1 thread, avx2";
  renderer::RendererInfo egl;
  egl.backend = "egl";
  egl.device = "llvmpipe";
  const std::string context = context_of(small_scenario(), raycast);
  std::set<std::string> contexts{
      context,
      context_of(small_scenario(), egl),
      context_of(small_scenario({R"(light={"sun_azimuth_deg":90,"sun_elevation_deg":30})"}),
                 raycast),
      context_of(small_scenario({"detail={}"}), raycast)};
  egl.device = "other device";
  contexts.insert(context_of(small_scenario(), egl));
  EXPECT_EQ(contexts.size(), 5U);
  // What does not change the image.
  raycast.device = "CPU, 8 threads, plain";
  EXPECT_EQ(context_of(small_scenario({"seed=7"}), raycast), context);
}

TEST(PictureContext, DependsOnTheWorldsFiles) {
  const overfly::testing::TemporaryFolder folder;
  std::filesystem::copy(testing::small_world().parent_path(),
                        folder.path() / "world",
                        std::filesystem::copy_options::recursive);
  const std::filesystem::path manifest = folder.path() / "world" / "world.json";
  const Scenario scenario =
      small_scenario({R"(world={"manifest":")" + manifest.string() + R"("})"});
  renderer::RendererInfo info;
  info.backend = "raycast";
  const std::string before = context_of(scenario, info);
  EXPECT_EQ(context_of(scenario, info), before);
  for (const auto& entry : std::filesystem::directory_iterator(manifest.parent_path())) {
    if (entry.path().extension() != ".tif") continue;
    // Written again with the same bytes: only its times show that it may be another file.
    const std::string bytes = overfly::testing::read_text(entry.path());
    overfly::testing::write_text(entry.path(), bytes);
    EXPECT_NE(context_of(scenario, info), before) << entry.path();
    return;
  }
  FAIL() << "the world has no GeoTIFF";
}

}  // namespace
}  // namespace overfly::server
