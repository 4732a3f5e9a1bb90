// Frames with shutter, sensor, vibration and several cameras.
#include "server/camera/frame_maker.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdio>

#include "server/camera/frame_remaker.hpp"
#include "server/record/rows/rows.hpp"
#include "server/record/run_folder.hpp"
#include "server/worlds/world_cache.hpp"
#include "tests/server/support/server_fixture.hpp"

namespace overfly::server {
namespace {

using testing::small_scenario;

constexpr const char* kRealCamera =
    R"(camera={"width_px":160,"height_px":120,"rate_hz":10,
        "sensor":{"exposure_ms":8,"readout_ms":20,"motion_blur":true,"shot_noise":true,
                  "read_noise_e":20,"prnu":0.01,"vignette":[-0.2,0,0],
                  "auto_exposure":{"max_exposure_ms":16}},
        "vibration":{"engine_rotation_rms_mrad":[1],"noise_rotation_rms_mrad":[0.5,0.5,0.5]}})";

FrameMakerOptions raycast() {
  FrameMakerOptions options;
  options.renderer_factory = [](std::shared_ptr<const terrain::TileSource> tiles) {
    renderer::RendererOptions renderer_options;
    renderer_options.threads = 1;
    return Result<std::unique_ptr<renderer::Renderer>>(
        renderer::create_raycast_renderer(std::move(tiles), renderer_options));
  };
  return options;
}

std::unique_ptr<FrameMaker> open(const Scenario& scenario, const FrameMakerOptions& options) {
  auto maker = FrameMaker::open(scenario, options);
  if (!maker) throw std::runtime_error(maker.error().message);
  return std::move(*maker);
}

MadeFrame made(FrameMaker& maker, std::int64_t k) {
  auto frame = maker.make(k);
  if (!frame) throw std::runtime_error(frame.error().message);
  return std::move(frame->value());
}

double largest_difference(const Image& a, const Image& b) {
  EXPECT_EQ(a.data.size(), b.data.size());
  double largest = 0.0;
  for (std::size_t i = 0; i < a.data.size(); ++i) {
    largest = std::max(largest, std::abs(double(a.data[i]) - double(b.data[i])));
  }
  return largest;
}

TEST(FrameMaker, RecordsThePoseAtTheMiddleOfTheShutter) {
  const Scenario scenario = small_scenario({kRealCamera});
  const auto maker = open(scenario, raycast());
  for (const std::int64_t k : {0, 1, 7}) {
    const MadeFrame frame = made(*maker, k);
    const CameraShot& shot = frame.shots.front();
    EXPECT_EQ(frame.t_ns, frame_time_ns(k, scenario.rate));
    EXPECT_EQ(shot.stamp_ns, frame.t_ns);
    const renderer::CameraRequest& request = shot.request;
    // The shutter of the first and the last row lies within the motion.
    const auto& poses = request.T_world_camera.poses();
    const std::int64_t half_ns = request.readout_ns / 2 + request.exposure_ns / 2;
    EXPECT_EQ(request.readout_ns, 20'000'000);
    EXPECT_GE(request.exposure_ns, 20'000);
    EXPECT_LE(poses.front().t_ns, frame.t_ns - half_ns);
    EXPECT_GE(poses.back().t_ns, frame.t_ns + half_ns);
    // The pose in the record is the truth at the stamp, shaken by the mount.
    const Pose at_rest = frame.state.T_world_body * scenario.cameras.front().T_body_camera;
    EXPECT_LT((shot.drawn.T_world_camera.translation - at_rest.translation).norm(), 1e-9);
    const double shake = rotation_angle_rad(shot.drawn.T_world_camera.rotation, at_rest.rotation);
    EXPECT_GT(shake, 1e-6);
    EXPECT_LT(shake, 0.02);
    EXPECT_EQ(shot.drawn.T_world_camera.matrix(), request.T_world_camera.at(frame.t_ns).matrix());
  }
}

TEST(FrameMaker, SamplesTheTruthFinelyEnoughForTheFastestVibration) {
  // Noise up to 200 Hz: a tenth of its period is 0.5 ms.
  const Scenario scenario = small_scenario({kRealCamera});
  const auto maker = open(scenario, raycast());
  const MadeFrame frame = made(*maker, 3);
  const auto& poses = frame.shots.front().request.T_world_camera.poses();
  for (std::size_t i = 1; i < poses.size(); ++i) {
    EXPECT_EQ(poses[i].t_ns - poses[i - 1].t_ns, 500'000);
  }
}

TEST(FrameMaker, MovingShutterBlursAndAHoveringOneDoesNot) {
  const overfly::testing::TemporaryFolder folder;
  const auto pose_file = [&](const char* name, double speed_m_s) {
    std::string text;
    for (int i = 0; i <= 20; ++i) {
      // Body north-up at 250 m over the world's origin: nose north is q = (0.5, 0.5, ...) in ENU.
      char line[128];
      std::snprintf(line,
                    sizeof line,
                    "%.3f %.3f 0 250 0.70710678 0.70710678 0 0\n",
                    0.1 * i,
                    0.1 * i * speed_m_s);
      text += line;
    }
    overfly::testing::write_text(folder.path() / name, text);
    return (folder.path() / name).string();
  };
  const auto images = [&](const std::string& file) {
    std::vector<Image> pair;
    for (const char* blur : {"false", "true"}) {
      const Scenario scenario =
          small_scenario({R"(flight={"log":{"file":")" + file + R"("}})",
                          R"(camera={"width_px":160,"height_px":120,"rate_hz":10,"fov_deg":20,
              "sensor":{"exposure_ms":50,"motion_blur":)" +
                              std::string(blur) + "}}"});
      const auto maker = open(scenario, raycast());
      pair.push_back(made(*maker, 5).shots.front().image);
    }
    return pair;
  };
  const auto still = images(pose_file("still.tum", 0.0));
  EXPECT_EQ(still[0].data, still[1].data);
  // 40 m/s for 50 ms = 2 m = 3.6 px at 0.55 m/px.
  const auto moving = images(pose_file("moving.tum", 40.0));
  EXPECT_GT(largest_difference(moving[0], moving[1]), 2.0);
}

TEST(FrameMaker, CamerasShareStampsAndStandApartByTheirBaseline) {
  const Scenario scenario =
      small_scenario({R"(cameras=[{"name":"a","width_px":160,"height_px":120,"rate_hz":10},
                   {"name":"b","width_px":80,"height_px":60,"rate_hz":10,"color":"rgb",
                    "mount":{"pitch_deg":20,"p_body_m":[0.3,-1.2,0.1]}}])"});
  FrameMakerOptions options;
  options.renderer_factory = testing::noop_factory();
  const auto maker = open(scenario, options);
  for (const std::int64_t k : {0, 4, 11}) {
    const MadeFrame frame = made(*maker, k);
    ASSERT_EQ(frame.shots.size(), 2U);
    EXPECT_EQ(frame.shots[0].stamp_ns, frame.shots[1].stamp_ns);
    EXPECT_EQ(frame.shots[1].image.channels, 3);
    EXPECT_EQ(frame.shots[1].image.width_px, 80);
    const Pose T_a_b =
        frame.shots[0].drawn.T_world_camera.inverse() * frame.shots[1].drawn.T_world_camera;
    // Of b in a's axes: x = right, y = back, z = down.
    EXPECT_LT((T_a_b.translation - Eigen::Vector3d(-1.2, -0.3, 0.1)).norm(), 1e-9);
    EXPECT_NEAR(rotation_angle_rad(T_a_b.rotation, Eigen::Quaterniond::Identity()),
                rad_from_deg(20.0),
                1e-9);
  }
}

TEST(FrameMaker, SensorlessCameraGivesTheRenderersPicture) {
  const Scenario scenario = small_scenario();
  const auto maker = open(scenario, raycast());
  const MadeFrame frame = made(*maker, 2);
  const CameraShot& shot = frame.shots.front();
  EXPECT_TRUE(shot.request.T_world_camera.still());
  EXPECT_EQ(shot.setting.exposure_ns, 0);
  const auto again = maker->renderer().render_camera(scenario.cameras.front().model,
                                                     shot.drawn.T_world_camera,
                                                     frame.t_ns,
                                                     renderer::PixelFormat::kGrey8);
  ASSERT_TRUE(again.ok());
  EXPECT_EQ(again->image.data, shot.image.data);
}

TEST(FrameMaker, LensFaultsActWithAndWithoutASensor) {
  for (const char* camera : {R"({"width_px":160,"height_px":120,"rate_hz":10})",
                             R"({"width_px":160,"height_px":120,"rate_hz":10,"sensor":{}})"}) {
    const Scenario scenario =
        small_scenario({std::string("camera=") + camera,
                        R"(faults=[{"kind":"blackout","at_s":0.2,"duration_s":0.1},
                    {"kind":"saturation_burst","at_s":0.4,"duration_s":0.1,"strength":5,
                     "radius_px":0},
                    {"kind":"water_drop","at_s":0.6,"duration_s":0.1,"radius_px":30}])"});
    const auto maker = open(scenario, raycast());
    const Scenario faultless = small_scenario({std::string("camera=") + camera});
    const auto sharp = open(faultless, raycast());
    for (const std::int64_t k : {1, 2, 4, 6, 7}) {
      const CameraShot shot = std::move(made(*maker, k).shots.front());
      const Image clean = std::move(made(*sharp, k).shots.front().image);
      if (k == 1 || k == 7) {
        EXPECT_EQ(shot.image.data, clean.data) << k;
        EXPECT_TRUE(shot.faults.empty());
        continue;
      }
      ASSERT_EQ(shot.faults.size(), 1U);
      if (k == 2) {
        EXPECT_EQ(shot.image.data, std::vector<std::uint8_t>(160 * 120, 0));
      } else if (k == 4) {
        EXPECT_EQ(shot.image.data, std::vector<std::uint8_t>(160 * 120, 255));
      } else {
        EXPECT_NE(shot.image.data, clean.data);
      }
    }
  }
}

TEST(FrameMaker, FrozenCameraRepeatsItsLastImage) {
  const Scenario scenario =
      small_scenario({R"(faults=[{"kind":"frozen_frame","at_s":0.3,"duration_s":0.2}])"});
  FrameMakerOptions options;
  options.renderer_factory = testing::noop_factory();
  const auto maker = open(scenario, options);
  std::vector<Image> images;
  for (std::int64_t k = 0; k < 7; ++k) images.push_back(made(*maker, k).shots.front().image);
  EXPECT_EQ(images[3].data, images[2].data);
  EXPECT_EQ(images[4].data, images[2].data);
  EXPECT_NE(images[5].data, images[2].data);
  EXPECT_NE(images[1].data, images[2].data);
}

TEST(FrameRemaker, MakesAnyFrameAgainBitByBit) {
  const Scenario scenario =
      small_scenario({kRealCamera, R"(faults=[{"kind":"dirt","at_s":0.5,"duration_s":0.3}])"});
  const overfly::testing::TemporaryFolder folder;
  auto samples = TruthSampleFile::create(truth_samples_file(folder.path()));
  ASSERT_TRUE(samples.ok()) << samples.error().message;
  FrameMakerOptions options = raycast();
  options.truth_samples = &*samples;
  const auto maker = open(scenario, options);
  std::vector<CameraShot> shots;
  for (std::int64_t k = 0; k < 9; ++k) {
    shots.push_back(std::move(made(*maker, k).shots.front()));
  }
  WorldCache worlds;
  const auto world = worlds.get(scenario, {});
  ASSERT_TRUE(world.ok());
  // The flight is the recorded one, whatever the scenario would fly now.
  const Scenario another =
      small_scenario({kRealCamera,
                      R"(faults=[{"kind":"dirt","at_s":0.5,"duration_s":0.3}])",
                      "flight.course.airspeed_m_s=31"});
  const auto remaker = FrameRemaker::create(folder.path(), another, bare_world(*world));
  ASSERT_TRUE(remaker.ok()) << remaker.error().message;
  const auto row_of = [&](std::size_t k) {
    FrameRow row;
    row.frame = static_cast<std::int64_t>(k);
    row.t_ns = frame_time_ns(row.frame, scenario.rate);
    row.T_world_camera = shots[k].drawn.T_world_camera;
    row.exposure_ns = shots[k].setting.exposure_ns;
    row.gain = shots[k].setting.gain;
    return row;
  };
  for (const std::size_t k : {6U, 2U, 8U, 0U}) {
    const auto image = (*remaker)->make(0, row_of(k), maker->renderer());
    ASSERT_TRUE(image.ok()) << image.error().message;
    EXPECT_EQ(image->data, shots[k].image.data) << "frame " << k;
  }
  // A folder of an earlier version has no samples: then the scenario flies.
  const overfly::testing::TemporaryFolder old_folder;
  const auto refly = FrameRemaker::create(old_folder.path(), scenario, bare_world(*world));
  ASSERT_TRUE(refly.ok()) << refly.error().message;
  EXPECT_EQ((*refly)->make(0, row_of(5), maker->renderer())->data, shots[5].image.data);
  // If that is another flight than the recorded one, its images are refused.
  const auto elsewhere = FrameRemaker::create(old_folder.path(), another, bare_world(*world));
  ASSERT_TRUE(elsewhere.ok()) << elsewhere.error().message;
  const auto refused = (*elsewhere)->make(0, row_of(5), maker->renderer());
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().code, ErrorCode::kConflict);
  EXPECT_THAT(refused.error().message, ::testing::HasSubstr("frame 5: rendered "));
}

}  // namespace
}  // namespace overfly::server
