// KITTI sequences, and plain PNG with CSV.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/motion/trajectory_io.hpp"
#include "server/files/whole_file.hpp"
#include "tests/server/export/export_fixture.hpp"

namespace overfly::server {
namespace {

namespace fs = std::filesystem;
using overfly::testing::read_text;
using overfly::testing::TemporaryFolder;
using testing::different_samples;
using ::testing::ElementsAre;
using testing::export_options;
using testing::exported;
using testing::numbers_behind;
using testing::read_picture;
using testing::rows_of;
using testing::small_source;

constexpr const char* kDroppedAndDark =
    R"(faults=[{"kind":"dropped_frames","at_s":0.35,"duration_s":0.2},
               {"kind":"blackout","at_s":1.25,"duration_s":0.1}])";

TEST(Kitti, CountsTheImagesThatArrivedAndPutsTheFirstPoseAtTheOrigin) {
  const TemporaryFolder folder;
  const ExportSource source = small_source({kDroppedAndDark});
  const ExportSummary summary =
      exported(source, export_options(folder.path() / "00", DatasetFormat::kKitti));
  EXPECT_EQ(summary.frames, 21);
  EXPECT_EQ(summary.images, 19);
  // Our own reader finds times.txt next to the poses.
  const auto read = read_trajectory(folder.path() / "00" / "poses.txt");
  ASSERT_TRUE(read.ok()) << read.error().message;
  EXPECT_EQ(read->format, TrajectoryFormat::kKitti);
  EXPECT_TRUE(read->has_times);
  const auto& poses = read->trajectory.poses();
  ASSERT_EQ(poses.size(), 19U);
  EXPECT_LT((poses.front().pose.matrix() - Eigen::Matrix4d::Identity()).norm(), 1e-12);

  std::size_t number = 0;
  const auto frames = testing::frames_of(source.scenario);
  const Pose T_first_world = frames.front().shots.front().drawn.T_world_camera.inverse();
  for (const MadeFrame& frame : frames) {
    const CameraShot& shot = frame.shots.front();
    if (!shot.delivered) continue;
    ASSERT_LT(number, poses.size());
    EXPECT_EQ(poses[number].t_ns, frame.t_ns);
    const Pose expected = T_first_world * shot.drawn.T_world_camera;
    EXPECT_LT((poses[number].pose.matrix() - expected.matrix()).norm(), 1e-9);
    char name[32];
    std::snprintf(name, sizeof name, "image_0/%06zu.png", number);
    EXPECT_EQ(different_samples(read_picture(folder.path() / "00" / name), shot.image), 0);
    ++number;
  }
  const PinholeCamera& c = source.scenario.cameras.front().model.pinhole();
  EXPECT_THAT(numbers_behind(read_text(folder.path() / "00" / "calib.txt"), "P0"),
              ElementsAre(c.fx_px, 0, c.cx_px, 0, 0, c.fy_px, c.cy_px, 0, 0, 0, 1, 0));
}

TEST(Kitti, KeepsColoursInImage2) {
  const TemporaryFolder folder;
  exported(small_source({"duration_s=0.1", "camera.color=rgb"}),
           export_options(folder.path() / "d", DatasetFormat::kKitti));
  EXPECT_EQ(read_picture(folder.path() / "d" / "image_2" / "000001.png").channels(), 3);
  EXPECT_FALSE(fs::exists(folder.path() / "d" / "image_0"));
}

TEST(PlainPng, KeepsSixteenBitsAndTellsAllThatIsKnown) {
  const TemporaryFolder folder;
  const ExportSource source = small_source(
      {kDroppedAndDark, "camera.bits=12", R"(camera.sensor={"exposure_ms":3,"shot_noise":true})"});
  exported(source, export_options(folder.path() / "d", DatasetFormat::kPng));
  auto rows = rows_of(folder.path() / "d" / "camera0.csv", ',');
  ASSERT_EQ(rows.size(), 22U);
  const std::vector<std::string> names = rows.front();
  rows.erase(rows.begin());
  const auto field = [&](std::size_t row, const std::string& name) {
    const auto at = std::find(names.begin(), names.end(), name);
    EXPECT_NE(at, names.end()) << name;
    return rows[row].at(static_cast<std::size_t>(at - names.begin()));
  };
  const auto frames = testing::frames_of(source.scenario);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const CameraShot& shot = frames[i].shots.front();
    ASSERT_EQ(rows[i].size(), names.size());
    EXPECT_EQ(std::stoll(field(i, "frame")), frames[i].frame);
    EXPECT_EQ(std::stoll(field(i, "t_ns")), frames[i].t_ns);
    EXPECT_EQ(std::stoll(field(i, "exposure_ns")), 3'000'000);
    const Pose& T = shot.drawn.T_world_camera;
    EXPECT_EQ(std::stod(field(i, "p_world_camera_z_m")), T.translation.z());
    EXPECT_EQ(std::stod(field(i, "q_world_camera_w")), T.rotation.w());
    EXPECT_EQ(std::stod(field(i, "texels_per_pixel_median")), shot.drawn.texels_per_pixel_median);
    if (!shot.delivered) {
      EXPECT_EQ(field(i, "file"), "");
      EXPECT_EQ(field(i, "faults"), "dropped_frames");
      continue;
    }
    const cv::Mat image = read_picture(folder.path() / "d" / field(i, "file"));
    EXPECT_EQ(different_samples(image, shot.image16), 0);
  }
  EXPECT_EQ(field(4, "file"), "");
  EXPECT_EQ(field(5, "file"), "");
  EXPECT_EQ(field(13, "faults"), "blackout");

  const auto cameras = read_json(folder.path() / "d" / "cameras.json");
  ASSERT_TRUE(cameras.ok());
  EXPECT_EQ(cameras->at(0).at("fx_px"), source.scenario.cameras[0].model.pinhole().fx_px);
  EXPECT_EQ(cameras->at(0).at("distortion").at("model"), "none");
}

}  // namespace
}  // namespace overfly::server
