// ROS bags, read back by rosbag itself. Skipped where ROS 1 is not built in.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>

#include "middleware/ros1/findings.hpp"
#include "server/record/rows/sensor_files.hpp"
#include "server/run/run.hpp"
#include "tests/server/export/export_fixture.hpp"

#ifdef OVERFLY_TESTS_ROS1
#include <rosbag/bag.h>
#include <rosbag/view.h>

#include "middleware/ros1/messages.hpp"
#endif

namespace overfly::server {
namespace {

using overfly::testing::TemporaryFolder;
using testing::export_options;
using testing::exported;
using testing::frames_of;
using ::testing::HasSubstr;
using testing::small_source;

TEST(RosbagExport, IsRefusedWhereRosIsNotBuiltIn) {
  if (ros1::is_built_in()) GTEST_SKIP() << "ROS 1 is built in";
  const TemporaryFolder folder;
  const auto summary =
      export_dataset(small_source(), export_options(folder.path() / "d", DatasetFormat::kRosbag));
  ASSERT_FALSE(summary.ok());
  EXPECT_EQ(summary.error().code, ErrorCode::kUnsupported);
  EXPECT_THAT(summary.error().message, HasSubstr("librosbag-storage-dev"));
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "d"));
}

#ifdef OVERFLY_TESTS_ROS1

constexpr const char* kTwoTopicCameras =
    R"(cameras=[{"name":"down","width_px":160,"height_px":120,"rate_hz":10},
                {"name":"tilted-2","width_px":96,"height_px":64,"rate_hz":10,"color":"rgb",
                 "distortion":{"model":"radtan","coefficients":[-0.1,0.01,0.002,0.001]},
                 "mount":{"pitch_deg":25,"p_body_m":[0.2,1,0]}}])";

/// The messages of a topic.
template <typename M>
std::vector<typename M::ConstPtr> messages_of(const std::filesystem::path& file,
                                              const std::string& topic) {
  const rosbag::Bag bag(file.string());
  rosbag::View view(bag, rosbag::TopicQuery(topic));
  std::vector<typename M::ConstPtr> messages;
  for (const rosbag::MessageInstance& instance : view) {
    messages.push_back(instance.instantiate<M>());
    if (!messages.back()) throw std::runtime_error(topic + " is a " + instance.getDataType());
  }
  return messages;
}

TEST(RosbagExport, HoldsImagesCalibrationAndTruthOfEveryCamera) {
  const TemporaryFolder folder;
  const ExportSource source = small_source({kTwoTopicCameras});
  const auto options = export_options(folder.path() / "d", DatasetFormat::kRosbag);
  const ExportSummary summary = exported(source, options);
  const std::vector<MadeFrame> frames = frames_of(source.scenario);
  const auto file = options.folder / "flight.bag";
  ASSERT_EQ(summary.frames, static_cast<std::int64_t>(frames.size()));
  EXPECT_FALSE(std::filesystem::exists(options.folder / "flight.bag.active"));
  const char* const prefixes[] = {"/camera", "/tilted_2"};
  for (std::size_t camera = 0; camera < 2; ++camera) {
    const std::string prefix = prefixes[camera];
    const auto images = messages_of<ros1::ImageMessage>(file, prefix + "/image_raw");
    const auto infos = messages_of<ros1::CameraInfoMessage>(file, prefix + "/camera_info");
    const auto truth = messages_of<ros1::PoseStampedMessage>(file, prefix + "/truth");
    ASSERT_EQ(images.size(), frames.size());
    ASSERT_EQ(infos.size(), frames.size());
    ASSERT_EQ(truth.size(), frames.size());
    for (std::size_t i = 0; i < frames.size(); ++i) {
      const CameraShot& shot = frames[i].shots[camera];
      EXPECT_EQ(images[i]->encoding, "mono8");
      const Image grey = grey_of(shot.image);
      EXPECT_TRUE(std::equal(
          grey.data.begin(), grey.data.end(), images[i]->data.begin(), images[i]->data.end()));
      EXPECT_EQ(images[i]->header.stamp.toNSec(),
                static_cast<std::uint64_t>(source.epoch_utc_ns + shot.stamp_ns));
      EXPECT_EQ(infos[i]->header.stamp, images[i]->header.stamp);
      EXPECT_EQ(infos[i]->header.frame_id, prefix.substr(1) + "_optical_frame");
      EXPECT_EQ(truth[i]->header.frame_id, "world");
      const std::optional<Pose> pose = ros1::pose_from(truth[i]->pose);
      ASSERT_TRUE(pose);
      EXPECT_EQ(pose->translation, shot.drawn.T_world_camera.translation);
      EXPECT_NEAR(
          rotation_angle_rad(pose->rotation, shot.drawn.T_world_camera.rotation), 0.0, 1e-9);
    }
  }
  const auto tilted = messages_of<ros1::CameraInfoMessage>(file, "/tilted_2/camera_info");
  EXPECT_THAT(tilted.front()->D, ::testing::ElementsAre(-0.1, 0.01, 0.002, 0.001, 0.0));
  EXPECT_EQ(messages_of<ros1::TransformsMessage>(file, "/tf").size(), 3 * frames.size())
      << "of two cameras, and the mount of the first one";
}

TEST(RosbagExport, HoldsTheTruthOfLostImagesWithoutTheImages) {
  const TemporaryFolder folder;
  const ExportSource source =
      small_source({R"(faults=[{"kind":"dropped_frames","at_s":0.35,"duration_s":0.2}])"});
  const auto options = export_options(folder.path() / "d", DatasetFormat::kRosbag);
  const ExportSummary summary = exported(source, options);
  ASSERT_LT(summary.images, summary.frames);
  const auto file = options.folder / "flight.bag";
  EXPECT_EQ(messages_of<ros1::ImageMessage>(file, "/camera/image_raw").size(),
            static_cast<std::size_t>(summary.images));
  EXPECT_EQ(messages_of<ros1::PoseStampedMessage>(file, "/camera/truth").size(),
            static_cast<std::size_t>(summary.frames));
}

TEST(RosbagExport, IsTheSameBytesEachTime) {
  const TemporaryFolder folder;
  const ExportSource source = small_source();
  for (const char* name : {"a", "b"}) {
    exported(source, export_options(folder.path() / name, DatasetFormat::kRosbag));
  }
  EXPECT_EQ(overfly::testing::read_text(folder.path() / "a" / "flight.bag"),
            overfly::testing::read_text(folder.path() / "b" / "flight.bag"));
}

TEST(RosbagExport, HasTheSamplesThatARunRecorded) {
  const TemporaryFolder folder;
  RunOptions flying = testing::options_for(folder.path() / "run");
  const auto run = run_scenario(
      testing::small_scenario({R"(sensors={"imu":{},"range":{"max_m":1000}})"}), flying);
  ASSERT_TRUE(run.ok()) << run.error().message;
  const ExportSource source = open_export_source(folder.path() / "run").value();
  ExportOptions options = export_options(folder.path() / "d", DatasetFormat::kRosbag);
  options.renderer_factory = testing::noop_factory();
  exported(source, options);
  const auto file = options.folder / "flight.bag";
  const auto imu = messages_of<ros1::ImuMessage>(file, "/sensors/imu");
  // Those of the first frame at t = 0 are older than it by nothing; the last frame is at 2 s.
  const SensorSamples recorded =
      SensorFilesReader::open(folder.path() / "run").value().until(2 * kNsPerS).value();
  ASSERT_EQ(imu.size(), recorded.imu.size());
  for (std::size_t i = 0; i < imu.size(); ++i) {
    EXPECT_EQ(imu[i]->header.stamp.toNSec(),
              static_cast<std::uint64_t>(source.epoch_utc_ns + recorded.imu[i].t_ns));
    EXPECT_EQ(imu[i]->angular_velocity.x, recorded.imu[i].angular_rate_rad_s.x());
    EXPECT_EQ(imu[i]->linear_acceleration.z, -recorded.imu[i].acceleration_m_s2.z());
  }
  EXPECT_EQ(messages_of<ros1::RangeMessage>(file, "/sensors/range").size(), recorded.range.size());
}

#endif

}  // namespace
}  // namespace overfly::server
