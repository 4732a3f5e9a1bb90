// MCAP files, read back by the readers of flight logs and of images.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "flight/logs/images/logged_images.hpp"
#include "flight/logs/truth/log_trajectory.hpp"
#include "server/export/mcap/mcap_file.hpp"
#include "server/scenario/document/scenario_file.hpp"
#include "tests/server/export/export_fixture.hpp"

namespace overfly::server {
namespace {

using Json = nlohmann::json;
using overfly::testing::TemporaryFolder;
using testing::export_options;
using testing::exported;
using testing::frames_of;
using testing::small_source;

TEST(McapExport, HoldsImagesAndTruthOfEveryCamera) {
  const TemporaryFolder folder;
  const ExportSource source =
      small_source({R"(cameras=[{"name":"down","width_px":160,"height_px":120,"rate_hz":10},
                   {"name":"tilted-2","width_px":96,"height_px":64,"rate_hz":10,"color":"rgb",
                    "mount":{"pitch_deg":25}}])"});
  const auto options = export_options(folder.path() / "d", DatasetFormat::kMcap);
  exported(source, options);
  const std::vector<MadeFrame> frames = frames_of(source.scenario);
  const auto file = options.folder / "flight.mcap";
  EXPECT_FALSE(std::filesystem::exists(options.folder / "flight.mcap.active"));
  const auto log = flight::logs::open_log(file);
  ASSERT_TRUE(log.ok()) << log.error().message;
  // The checksums of the chunks and of the data are right, or there were warnings.
  for (const std::string& warning : log->warnings) {
    EXPECT_THAT(
        warning,
        ::testing::AnyOf(::testing::HasSubstr("stays on the ground"),
                         ::testing::HasSubstr("/tilted_2/truth has the poses of the camera")));
  }
  const char* const topics[] = {"/camera/image_raw", "/tilted_2/image_raw"};
  for (std::size_t camera = 0; camera < 2; ++camera) {
    const auto images = flight::logs::LoggedImages::open(file, topics[camera], nullptr);
    ASSERT_TRUE(images.ok()) << images.error().message;
    ASSERT_EQ((*images)->stamps_ns().size(), frames.size());
    for (std::size_t i = 0; i < frames.size(); ++i) {
      const CameraShot& shot = frames[i].shots[camera];
      EXPECT_EQ((*images)->stamps_ns()[i], source.epoch_utc_ns + shot.stamp_ns);
      const auto picture = (*images)->read(i);
      ASSERT_TRUE(picture.ok()) << picture.error().message;
      EXPECT_EQ(picture->encoding, "mono8");
      EXPECT_TRUE(std::ranges::equal(picture->data, grey_of(shot.image).data));
    }
  }
  // The truth of the first camera as poses: positions are exact.
  const auto poses = flight::logs::read_log_trajectory(*log, {"/camera/truth", {}, {}}, nullptr);
  ASSERT_TRUE(poses.ok()) << poses.error().message;
  ASSERT_EQ(poses->poses.size(), frames.size());
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const Eigen::Vector3d& enu = frames[i].shots[0].drawn.T_world_camera.translation;
    const Eigen::Vector3d& ned = poses->poses[i].position;
    EXPECT_EQ(Eigen::Vector3d(ned.y(), ned.x(), -ned.z()), enu);
  }
}

TEST(McapExport, HoldsTheTruthOfLostImagesWithoutTheImages) {
  const TemporaryFolder folder;
  const ExportSource source =
      small_source({R"(faults=[{"kind":"dropped_frames","at_s":0.35,"duration_s":0.2}])"});
  const auto options = export_options(folder.path() / "d", DatasetFormat::kMcap);
  const ExportSummary summary = exported(source, options);
  ASSERT_LT(summary.images, summary.frames);
  const auto images = flight::logs::LoggedImages::open(options.folder / "flight.mcap", "", nullptr);
  ASSERT_TRUE(images.ok());
  EXPECT_EQ((*images)->stamps_ns().size(), static_cast<std::size_t>(summary.images));
}

TEST(McapExport, OfARunHoldsItsEstimates) {
  const TemporaryFolder folder;
  Json document = testing::small_document();
  document["estimators"] = {
      {{"name", "d-1"}, {"type", "drifting"}, {"parameters", {{"scale", 0.5}}}}};
  const auto scenario = resolve_scenario(document, {}, "/");
  ASSERT_TRUE(scenario.ok()) << scenario.error().message;
  RunOptions run = testing::options_for(folder.path() / "run");
  run.renderer_factory = testing::raycast_factory();
  ASSERT_TRUE(run_scenario(*scenario, run).ok());
  const auto source = open_export_source(folder.path() / "run");
  ASSERT_TRUE(source.ok()) << source.error().message;
  const auto options = export_options(folder.path() / "d", DatasetFormat::kMcap);
  const ExportSummary summary = exported(*source, options);
  const auto log = flight::logs::open_log(options.folder / "flight.mcap");
  ASSERT_TRUE(log.ok());
  const auto positions_of = [&](const std::string& topic) {
    const auto poses = flight::logs::read_log_trajectory(*log, {topic, {}, {}}, nullptr);
    EXPECT_TRUE(poses.ok()) << topic;
    std::vector<Eigen::Vector3d> positions;
    if (!poses) return positions;
    for (const auto& pose : poses->poses) positions.push_back(pose.position);
    return positions;
  };
  const auto truth = positions_of("/camera/truth");
  const auto raw = positions_of("/estimates/d_1/pose");
  const auto aligned = positions_of("/estimates/d_1/pose_world");
  ASSERT_EQ(raw.size(), static_cast<std::size_t>(summary.frames));
  ASSERT_EQ(aligned.size(), raw.size());
  // Half a unit a metre; the alignment by sim3 undoes it.
  EXPECT_NEAR((raw.back() - raw.front()).norm() / (truth.back() - truth.front()).norm(), 0.5, 0.05);
  EXPECT_LT((aligned.back() - truth.back()).norm(), 1.0);
}

TEST(McapFile, HasASummaryThatLeadsToEveryMessage) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "a.mcap";
  auto file = McapFile::create(path, "ros2");
  ASSERT_TRUE(file.ok());
  const auto a = file->add_channel("/a", "pkg/msg/T", "uint8 x\n");
  const auto b = file->add_channel("/b", "pkg/msg/T", "uint8 x\n");
  const std::vector<std::uint8_t> large(3 << 20U, 7);
  for (std::uint64_t i = 0; i < 5; ++i) {
    ASSERT_TRUE(file->add_message(i % 2 == 0 ? a : b, 100 + i, large).ok());
  }
  ASSERT_TRUE(file->close().ok());
  const std::string bytes = overfly::testing::read_text(path);
  const auto number = [&](std::size_t at, int size) {
    std::uint64_t value = 0;
    for (int i = size - 1; i >= 0; --i)
      value = value << 8U | static_cast<std::uint8_t>(bytes[at + i]);
    return value;
  };
  // Footer: kind, length, start of the summary, start of the offsets, checksum; then the magic.
  const std::size_t footer = bytes.size() - 8 - 29;
  ASSERT_EQ(bytes[footer], 0x02);
  std::size_t at = number(footer + 9, 8);
  std::uint64_t messages = 0;
  std::uint64_t indexed = 0;
  while (at < footer) {
    const auto kind = static_cast<std::uint8_t>(bytes[at]);
    const std::size_t content = at + 9;
    if (kind == 0x0B) messages = number(content, 8);
    if (kind == 0x08) {
      const std::size_t chunk = number(content + 16, 8);
      const std::size_t records = chunk + 9 + 40;
      EXPECT_EQ(bytes[chunk], 0x06);
      const std::size_t map_bytes = number(content + 32, 4);
      for (std::size_t i = 0; i < map_bytes; i += 10) {
        const std::size_t index = number(content + 36 + i + 2, 8);
        EXPECT_EQ(bytes[index], 0x07);
        EXPECT_EQ(number(index + 9, 2), number(content + 36 + i, 2));
        const std::size_t entries = number(index + 11, 4) / 16;
        for (std::size_t k = 0; k < entries; ++k, ++indexed) {
          const std::size_t message = records + number(index + 15 + 16 * k + 8, 8);
          EXPECT_EQ(bytes[message], 0x05);
          EXPECT_EQ(number(message + 9 + 6, 8), number(index + 15 + 16 * k, 8));
        }
      }
    }
    at = content + number(at + 1, 8);
  }
  EXPECT_EQ(at, footer);
  EXPECT_EQ(messages, 5U);
  EXPECT_EQ(indexed, 5U);
}

}  // namespace
}  // namespace overfly::server
