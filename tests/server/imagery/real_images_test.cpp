// Exports of a flight take the camera's place on the same flight: what was rendered must come back.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <random>

#include "middleware/lcm/findings.hpp"
#include "middleware/ros1/findings.hpp"
#include "server/camera/frame_remaker.hpp"
#include "server/export/dataset_export.hpp"
#include "server/export/video/vp9_encoder.hpp"
#include "server/export/video/webm_file.hpp"
#include "server/export/video_export.hpp"
#include "server/files/png_file.hpp"
#include "server/imagery/flight_images.hpp"
#include "server/imagery/video_images.hpp"
#include "server/record/rows/agreement_rows.hpp"
#include "server/record/run_records.hpp"
#include "server/scenario/document/scenario_file.hpp"
#include "server/scoring/agreement_report.hpp"
#include "server/worlds/world_cache.hpp"
#include "tests/flight/logs/ros_bytes.hpp"
#include "tests/server/imagery/real_images_fixture.hpp"
#include "tests/server/support/server_fixture.hpp"

namespace overfly::server {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;
using ::testing::Contains;
using ::testing::HasSubstr;

TEST_F(RealImages, OfAFolderAreThoseThatWereRendered) {
  const fs::path folder = exported(DatasetFormat::kPng);
  expect_identical(flown(twin_document({{"source", folder.string()}})));
}

TEST_F(RealImages, OfABagAreThoseThatWereRendered) {
  if (!ros1::is_built_in()) GTEST_SKIP() << "no ROS 1";
  const fs::path bag = exported(DatasetFormat::kRosbag) / "flight.bag";
  expect_identical(flown(twin_document({{"source", bag.string()}, {"clock", "utc"}})));
}

TEST_F(RealImages, OfAnLcmLogAreThoseThatWereRendered) {
  if (!lcm::is_built_in()) GTEST_SKIP() << "no LCM";
  const fs::path log = exported(DatasetFormat::kLcm) / "flight.lcm";
  expect_identical(flown(twin_document({{"source", log.string()}, {"topic", "OVERFLY_IMAGE"}})));
}

TEST_F(RealImages, OfAVideoAreCloseToThoseThatWereRendered) {
  if (!reads_videos()) GTEST_SKIP() << "no FFmpeg";
  ExportSource source{scenario_of(flight_document()), std::nullopt, 0};
  VideoOptions options;
  options.file = folder_.path() / "flight.webm";
  options.look.view = VideoView::kCamera;
  options.look.quality = 95;
  options.renderer_factory = one_thread_raycaster();
  const auto video = export_video(source, options);
  ASSERT_TRUE(video.ok()) << video.error().message;
  const AgreementReport report = flown(twin_document({{"source", options.file.string()}}));
  EXPECT_EQ(report.frames, kFrames);
  EXPECT_EQ(report.lost, 0);
  EXPECT_LT(report.offset_px->p95, 0.2);  // what the peak resolves, and the compression
  EXPECT_GT(report.correlation->p5, 0.98);
}

TEST_F(RealImages, OfADamagedVideoAreReadAsFarAsTheyGo) {
  if (!reads_videos()) GTEST_SKIP() << "no FFmpeg";
  ExportSource source{scenario_of(flight_document()), std::nullopt, 0};
  VideoOptions options;
  options.file = folder_.path() / "flight.webm";
  options.look.view = VideoView::kCamera;
  options.renderer_factory = one_thread_raycaster();
  ASSERT_TRUE(export_video(source, options).ok());
  const std::string whole = overfly::testing::read_text(options.file);
  const fs::path damaged = folder_.path() / "damaged.webm";
  std::mt19937 random(1);
  int opened = 0;
  int read = 0;
  for (int round = 0; round < 100; ++round) {
    std::string bytes = whole;
    for (int i = 0; i < 1 + round % 20; ++i) {
      bytes[random() % bytes.size()] = static_cast<char>(random());
    }
    if (round % 4 == 0) bytes.resize(random() % bytes.size());
    overfly::testing::write_text(damaged, bytes);
    const auto images = open_video_images(damaged, nullptr);
    if (!images) continue;
    ++opened;
    for (std::size_t i = 0; i < (*images)->stamps_ns().size(); ++i) {
      read += (*images)->read(i).ok() ? 1 : 0;
    }
  }
  EXPECT_GT(opened, 10);
  EXPECT_GT(read, 100);
}

TEST(VideoImages, ReportFramesWithEqualTimes) {
  if (!reads_videos()) GTEST_SKIP() << "no FFmpeg";
  const overfly::testing::TemporaryFolder folder;
  const fs::path file = folder.path() / "doubled.webm";
  VideoSettings settings;
  settings.width_px = 64;
  settings.height_px = 48;
  auto encoder = Vp9Encoder::open(settings).value();
  auto webm = WebmFile::create(file, 64, 48).value();
  for (int i = 0; i < 6; ++i) {
    const Image picture(64, 48, 3, static_cast<std::uint8_t>(40 * i));
    std::vector<VideoPacket> packets = encoder.encode(picture, 100 * i).value();
    for (VideoPacket& packet : packets) {
      if (i == 3) packet.t_ms = 200;
      ASSERT_TRUE(webm.add(packet).ok());
    }
  }
  ASSERT_TRUE(webm.finish(600).ok());
  const auto images = open_video_images(file, nullptr);
  ASSERT_TRUE(images.ok()) << images.error().message;
  EXPECT_EQ((*images)->stamps_ns().size(), 5U);
  EXPECT_THAT((*images)->warnings(),
              Contains(HasSubstr("1 frames have the time of another one and were left out")));
}

TEST_F(RealImages, OfADataSetWithAnotherCalibrationCauseAWarning) {
  for (const DatasetFormat format : {DatasetFormat::kPng,
                                     DatasetFormat::kEuroc,
                                     DatasetFormat::kTumMono,
                                     DatasetFormat::kKitti}) {
    fs::remove_all(folder_.path() / "export");
    const fs::path folder = exported(format);
    const auto warnings = [&](double fov_deg) {
      Json document = twin_document({{"source", folder.string()}, {"clock", "first_image"}});
      for (Json& camera : document["cameras"]) camera["fov_deg"] = fov_deg;
      const Scenario scenario = scenario_of(document);
      const auto images = FlightImages::open(scenario.cameras[0],
                                             {std::nullopt, std::nullopt, 2 * kNsPerS},
                                             scenario.sources,
                                             nullptr);
      if (!images) throw std::runtime_error(images.error().message);
      return (*images)->warnings();
    };
    const auto differs = HasSubstr("contradicts the data set's own calibration");
    EXPECT_THAT(warnings(kFovDeg), ::testing::Not(Contains(differs))) << to_string(format);
    // The left and right edges see tan(23.5 deg) / tan(20 deg) = 1.195 times as far aside.
    EXPECT_THAT(warnings(47.0), Contains(differs)) << to_string(format);
  }
}

TEST_F(RealImages, OfADataSetWithAnotherCalibrationAreRecordedWithTheWarning) {
  Json document = twin_document({{"source", exported(DatasetFormat::kPng).string()}});
  for (Json& camera : document["cameras"]) camera["fov_deg"] = 47.0;
  (void)flown(document);
  const Json manifest = Json::parse(overfly::testing::read_text(run() / "manifest.json"));
  const auto differs = HasSubstr("contradicts the data set's own calibration");
  EXPECT_THAT(manifest.at("flight").at("warnings").get<std::vector<std::string>>(),
              Contains(::testing::AllOf(::testing::StartsWith("images: "), differs)));
  EXPECT_THAT(overfly::testing::read_text(run() / "log.jsonl"), differs);
}

TEST_F(RealImages, ShowAWrongTimeAsAnOffset) {
  const fs::path folder = exported(DatasetFormat::kPng);
  // Each image is placed half a second late: the aircraft flies 12.5 m on meanwhile, 300 m above
  // the ground, so that the real image shows the ground further ahead: towards its top.
  const AgreementReport report =
      flown(twin_document({{"source", folder.string()}, {"time_offset_s", 0.5}}));
  EXPECT_EQ(report.frames, kFrames - 5);
  const double predicted_px = 12.5 / 300.0 * kFocalPx;
  EXPECT_NEAR(report.mean_offset_px->y(), -predicted_px, 0.1 * predicted_px);
  EXPECT_NEAR(report.mean_offset_px->x(), 0.0, 0.5);
  EXPECT_GT(report.correlation_aligned->median, report.correlation->median);
  const auto records = read_run_records(run());
  ASSERT_TRUE(records.ok());
  EXPECT_EQ(records->cameras[0].frames.front().t_ns, kNsPerS / 2);
}

TEST_F(RealImages, ShowAWrongMountAsAnOffset) {
  const fs::path folder = exported(DatasetFormat::kPng);
  // Both cameras are described as pitched up by 2 deg, and the real one was not: what the virtual
  // one shows in the middle is ahead of the real one's middle.
  const AgreementReport report =
      flown(twin_document({{"source", folder.string()}}, {{"pitch_deg", 2.0}}));
  const double predicted_px = std::tan(2.0 * EIGEN_PI / 180.0) * kFocalPx;
  EXPECT_NEAR(report.mean_offset_px->y(), -predicted_px, 0.05 * predicted_px);
  EXPECT_NEAR(report.mean_offset_px->x(), 0.0, 0.5);
}

TEST_F(RealImages, ThatAreMissingOrDamagedAreLostFrames) {
  const fs::path folder = exported(DatasetFormat::kPng);
  std::vector<fs::path> images;
  for (const auto& entry : fs::recursive_directory_iterator(folder / "images")) {
    if (entry.is_regular_file()) images.push_back(entry.path());
  }
  std::sort(images.begin(), images.end());
  ASSERT_EQ(images.size(), static_cast<std::size_t>(kFrames));
  fs::remove(images[4]);
  fs::resize_file(images[9], 500);
  const AgreementReport report = flown(twin_document({{"source", folder.string()}}));
  EXPECT_EQ(report.frames, kFrames);
  EXPECT_EQ(report.lost, 2);
  EXPECT_EQ(metrics_.cameras[0].faults.at("unreadable_image"), 2);
  EXPECT_EQ(metrics_.estimators.at("on_real").answered, kFrames - 2);
  EXPECT_EQ(metrics_.estimators.at("on_virtual").answered, kFrames);
  EXPECT_THAT(overfly::testing::read_text(run() / "log.jsonl"), HasSubstr("image lost: "));
}

TEST_F(RealImages, ThatAreUniformCannotBeComparedAndCountSeparately) {
  const fs::path folder = exported(DatasetFormat::kPng);
  std::vector<fs::path> images;
  for (const auto& entry : fs::recursive_directory_iterator(folder / "images")) {
    if (entry.is_regular_file()) images.push_back(entry.path());
  }
  std::sort(images.begin(), images.end());
  Image grey(160, 120, 1);
  std::fill(grey.data.begin(), grey.data.end(), std::uint8_t{128});
  const auto write = [&](std::size_t i) { ASSERT_TRUE(write_png_file(images[i], grey).ok()); };
  write(3);
  write(4);
  AgreementReport report = flown(twin_document({{"source", folder.string()}}));
  EXPECT_EQ(report.lost, 0);
  EXPECT_EQ(report.not_comparable, 2);
  EXPECT_GT(report.correlation->p5, 0.999999);
  EXPECT_GT(report.peak->p5, 0.1);  // an image without an offset has no peak of 0
  for (std::size_t i = 0; i < images.size(); ++i) write(i);
  fs::remove_all(run());
  report = flown(twin_document({{"source", folder.string()}}));
  EXPECT_EQ(report.not_comparable, kFrames);
  EXPECT_FALSE(report.offset_px.has_value() || report.correlation.has_value());
  const Json written = json_from(report, metrics_);
  EXPECT_TRUE(written.at("mean_offset_px").is_null() && written.at("correlation").is_null());
}

TEST_F(RealImages, AreReadAgainForPlayback) {
  const fs::path folder = exported(DatasetFormat::kPng);
  const Json document = twin_document({{"source", folder.string()}});
  (void)flown(document);
  const Scenario scenario = scenario_of(document);
  WorldCache worlds;
  const auto opened = worlds.get(scenario, {});
  ASSERT_TRUE(opened.ok());
  const auto world = bare_world(*opened);
  const auto records = read_run_records(run());
  ASSERT_TRUE(records.ok());
  auto remaker = FrameRemaker::create(run(), scenario, world);
  ASSERT_TRUE(remaker.ok());
  const auto renderer = one_thread_raycaster()(world->tiles);
  ASSERT_TRUE(renderer.ok());
  const FrameRow& row = records->cameras[0].frames[7];
  EXPECT_EQ(row.source_image, 7);
  const auto real = (*remaker)->make(0, row, **renderer);
  const auto rendered = (*remaker)->make(1, records->cameras[1].frames[7], **renderer);
  ASSERT_TRUE(real.ok()) << real.error().message;
  ASSERT_TRUE(rendered.ok()) << rendered.error().message;
  EXPECT_EQ(real->data, rendered->data);
}

TEST_F(RealImages, ThatCannotBeReadAtTheStartEndTheFlightThere) {
  const fs::path folder = exported(DatasetFormat::kPng);
  std::vector<fs::path> images;
  for (const auto& entry : fs::recursive_directory_iterator(folder / "images")) {
    if (entry.is_regular_file()) images.push_back(entry.path());
  }
  std::sort(images.begin(), images.end());
  const auto opened = [&] {
    const Scenario scenario = scenario_of(twin_document({{"source", folder.string()}}));
    const auto source = FlightImages::open(
        scenario.cameras[0], {std::nullopt, std::nullopt, 2 * kNsPerS}, scenario.sources, nullptr);
    return source ? std::string("opened") : source.error().message;
  };
  fs::remove(images[0]);
  EXPECT_EQ(opened(), "opened");  // one that is missing is a lost frame
  fs::remove(images[1]);
  EXPECT_THAT(opened(), HasSubstr("camera \"real\": "));
}

/// An encoding that is not read is that of all images.
TEST_F(RealImages, OfAnUnknownEncodingAreAnError) {
  using namespace flight::testing;
  Bytes bytes = bag_start(1);
  append(bytes, bag_connection(0, "/image", "sensor_msgs/Image"));
  for (int i = 0; i < 3; ++i) {
    WireWriter message(Wire::kRos1);
    message.header(i * kNsPerS, "camera").number(std::uint32_t{120}).number(std::uint32_t{160});
    message.text("rgb16").number(std::uint8_t{0}).number(std::uint32_t{960});
    message.number(std::uint32_t{960 * 120});
    Bytes image = message.bytes();
    image.resize(image.size() + std::size_t{960} * 120);
    append(bytes, bag_message(0, i, image));
  }
  const fs::path bag = folder_.path() / "flight.bag";
  write_bytes(bag, bytes);
  const Scenario scenario = scenario_of(twin_document({{"source", bag.string()}}));
  const auto images = FlightImages::open(
      scenario.cameras[0], {std::nullopt, std::nullopt, 2 * kNsPerS}, scenario.sources, nullptr);
  ASSERT_FALSE(images.ok());
  EXPECT_EQ(images.error().code, ErrorCode::kUnsupported);
  EXPECT_THAT(images.error().message, HasSubstr("encoding \"rgb16\": is not read"));
}

TEST_F(RealImages, OutsideOfTheFlightAreAnError) {
  const fs::path folder = exported(DatasetFormat::kPng);
  const Scenario scenario =
      scenario_of(twin_document({{"source", folder.string()}, {"time_offset_s", 100.0}}));
  RunOptions options;
  options.folder = run();
  options.renderer_factory = one_thread_raycaster();
  const auto result = run_scenario(scenario, options);
  ASSERT_FALSE(result.ok());
  EXPECT_THAT(result.error().message,
              HasSubstr("no image lies within the flight: the images span [100, 102] s"));
}

}  // namespace
}  // namespace overfly::server
