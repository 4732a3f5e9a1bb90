// The engine's files and small parts: JPEG, whole files, lines, rows, live alignment.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cmath>

#include "core/time.hpp"
#include "evaluation/evaluation.hpp"
#include "server/files/jpeg.hpp"
#include "server/files/whole_file.hpp"
#include "server/record/live_alignment.hpp"
#include "server/record/run_rows.hpp"
#include "tests/support/support.hpp"

namespace overfly::engine {
namespace {

using overfly::testing::TemporaryFolder;
using ::testing::HasSubstr;

Image gradient(int channels) {
  Image image(64, 48, channels);
  for (int y = 0; y < 48; ++y) {
    for (int x = 0; x < 64; ++x) {
      for (int c = 0; c < channels; ++c) {
        image.at(x, y, c) = static_cast<std::uint8_t>(2 * x + y + 20 * c);
      }
    }
  }
  return image;
}

TEST(Jpeg, KeepsSizeChannelsAndNearlyTheValues) {
  for (const int channels : {1, 3}) {
    const Image image = gradient(channels);
    const auto bytes = encode_jpeg(image, 95);
    ASSERT_TRUE(bytes.ok()) << bytes.error().message;
    const auto decoded = decode_jpeg(*bytes);
    ASSERT_TRUE(decoded.ok()) << decoded.error().message;
    ASSERT_EQ(decoded->width_px, 64);
    ASSERT_EQ(decoded->height_px, 48);
    ASSERT_EQ(decoded->channels, channels);
    for (std::size_t i = 0; i < image.data.size(); ++i) {
      EXPECT_NEAR(decoded->data[i], image.data[i], 6);  // smooth content at quality 95
    }
  }
}

TEST(Jpeg, RefusesBadQualityEmptyImagesAndOtherBytes) {
  EXPECT_THAT(encode_jpeg(gradient(1), 0).error().message, HasSubstr("must be in [1, 100]"));
  EXPECT_EQ(encode_jpeg(Image(), 75).error().code, ErrorCode::kInvalidArgument);
  EXPECT_EQ(encode_jpeg(Image(4, 4, 2), 75).error().code, ErrorCode::kInvalidArgument);
  const std::vector<std::uint8_t> noise = {1, 2, 3, 4};
  EXPECT_EQ(decode_jpeg(noise).error().code, ErrorCode::kUnreadable);
}

TEST(WholeFile, ReplacesAndLeavesNoPart) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "a.txt";
  ASSERT_TRUE(write_whole(file, std::string("one")).ok());
  ASSERT_TRUE(write_whole(file, std::string("two")).ok());
  EXPECT_EQ(overfly::testing::read_text(file), "two");
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1);
  const auto nowhere = write_whole(folder.path() / "no" / "a.txt", std::string("x"));
  EXPECT_EQ(nowhere.error().code, ErrorCode::kIo);
  EXPECT_THAT(nowhere.error().message, HasSubstr("No such file"));
}

TEST(LineFile, IsReadBackWithoutTheLineThatAKillCutShort) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "a.jsonl";
  {
    LineFile lines = std::move(LineFile::create(file)).value();
    ASSERT_TRUE(lines.append({{"a", 1}}).ok());
    ASSERT_TRUE(lines.append({{"a", 0.1}}).ok());
  }
  EXPECT_FALSE(LineFile::create(file).ok()) << "never writes into a file that is there";
  const std::string text = overfly::testing::read_text(file);
  overfly::testing::write_text(file, text + "{\"a\": 3");
  const auto lines = read_lines(file);
  ASSERT_TRUE(lines.ok()) << lines.error().message;
  ASSERT_EQ(lines->size(), 2U);
  EXPECT_EQ((*lines)[1].at("a").get<double>(), 0.1);
  EXPECT_TRUE(read_lines(folder.path() / "none").value().empty());
  overfly::testing::write_text(file, "{\"a\": 1}\n{a}\n");
  EXPECT_THAT(read_lines(file).error().message, HasSubstr("row 2"));
}

TEST(WholeFile, GivesReadErrorsAsErrors) {
  for (const Error& error :
       {read_json("/proc/self/mem").error(), read_lines("/proc/self/mem").error()}) {
    EXPECT_EQ(error.code, ErrorCode::kIo);
    EXPECT_THAT(error.message, HasSubstr("/proc/self/mem: reading failed"));
  }
  const TemporaryFolder folder;
  const auto file = folder.path() / "a.json";
  ASSERT_EQ(::mkfifo(file.c_str(), 0600), 0);
  EXPECT_EQ(read_json(file).error().code, ErrorCode::kUnreadable);
  EXPECT_EQ(read_lines(file).error().code, ErrorCode::kUnreadable);
  overfly::testing::write_text(folder.path() / "b.json", "{}");
  std::filesystem::resize_file(folder.path() / "b.json", 20'000'000'000U);
  EXPECT_THAT(read_json(folder.path() / "b.json").error().message, HasSubstr("must have at most"));
}

TEST(WholeFile, RefusesDeepJson) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "a.json";
  const std::string deep = std::string(100'000, '[') + std::string(100'000, ']');
  overfly::testing::write_text(file, deep);
  EXPECT_THAT(read_json(file).error().message, HasSubstr("a.json: is nested more than 64 deep"));
  overfly::testing::write_text(file, "{}\n" + deep + "\n");
  EXPECT_THAT(read_lines(file).error().message, HasSubstr("row 2: is nested more than 64 deep"));
}

TEST(RunRows, ReadBackExactly) {
  FrameRecord record;
  record.row.frame = 7;
  record.row.t_ns = 225806452;
  record.row.T_world_camera.translation = {1.0 / 3.0, -2e-17, 1e8 / 7.0};
  record.row.T_world_camera.rotation =
      Eigen::Quaterniond(Eigen::AngleAxisd(0.3, Eigen::Vector3d(1, 2, 3).normalized()));
  record.axis_depth_m = 1e3 / 9.0;
  const auto read = frame_record_from(nlohmann::json::parse(json_from(record).dump()), Pose{});
  ASSERT_TRUE(read.ok()) << read.error().message;
  EXPECT_EQ(read->row.T_world_camera.matrix(), record.row.T_world_camera.matrix());
  EXPECT_EQ(read->axis_depth_m, record.axis_depth_m);
  EXPECT_EQ(read->row.t_ns, record.row.t_ns);
  EXPECT_EQ(frame_record_from({{"frame", 1}}, Pose{}).error().code, ErrorCode::kUnreadable);
}

EstimateSample tracked(std::int64_t t_s, double x, std::optional<double> depth, int map_id = 0) {
  EstimateSample sample;
  sample.frame = t_s;
  sample.t_ns = t_s * kNsPerS;
  sample.state = TrackingState::kTracking;
  sample.T_vo_camera.translation.x() = x;
  sample.scene_depth = depth;
  sample.map_id = map_id;
  return sample;
}

Pose at_x(double x) { return {Eigen::Quaterniond::Identity(), {x, 0, 0}}; }

TEST(LiveAlignment, AgreesWithTheEvaluationsInitScale) {
  const Pose T_body_camera{R_body_camera_nadir(), Eigen::Vector3d::Zero()};
  Pose first = at_x(100);
  first.rotation = Eigen::Quaterniond(Eigen::AngleAxisd(0.7, Eigen::Vector3d::UnitZ()));
  LiveAlignment alignment(T_body_camera);
  std::vector<evaluation::MatchedPose> matches;
  for (int i = 0; i < 3; ++i) {
    Pose truth = first;
    truth.translation += first.rotation * Eigen::Vector3d(30.0 * i, 0, 0);
    const EstimateSample sample = tracked(i, 0.1 * i, 1.0);
    matches.push_back({sample.t_ns, truth, sample.T_vo_camera, sample.scene_depth});
    EXPECT_TRUE(alignment.add(sample, truth, 300.0).has_value());
  }
  evaluation::Options options;
  options.init_true_depth_m = 300.0;
  const auto S = evaluation::align(matches, evaluation::AlignmentMode::kInitScale, options);
  ASSERT_TRUE(S.ok()) << S.error().message;
  ASSERT_TRUE(alignment.S_world_vo().has_value());
  EXPECT_NEAR(alignment.S_world_vo()->scale, S->scale, 1e-9);
  EXPECT_LT((alignment.S_world_vo()->translation - S->translation).norm(), 1e-9);
  EXPECT_LT(rotation_angle_rad(alignment.S_world_vo()->rotation, S->rotation), 1e-9);
}

TEST(LiveAlignment, TakesTheScaleFromFiveSecondsOfPathWithoutADepth) {
  LiveAlignment alignment{Pose{}};
  for (int t = 0; t < 5; ++t) {
    EXPECT_FALSE(alignment.add(tracked(t, 0.5 * t, {}), at_x(10.0 * t), 300.0).has_value());
  }
  const auto placed = alignment.add(tracked(5, 2.5, {}), at_x(50.0), 300.0);
  ASSERT_TRUE(placed.has_value());
  EXPECT_NEAR(placed->translation.x(), 50.0, 1e-9);
}

TEST(LiveAlignment, StartsAnewWithANewMap) {
  LiveAlignment alignment{Pose{}};
  EXPECT_NEAR(alignment.add(tracked(0, 0, 1.0), at_x(0), 300.0)->translation.x(), 0.0, 1e-9);
  const auto placed = alignment.add(tracked(9, 4.0, 2.0, 1), at_x(90), 200.0);
  ASSERT_TRUE(placed.has_value());
  EXPECT_NEAR(placed->translation.x(), 90.0, 1e-9);
  EXPECT_NEAR(alignment.S_world_vo()->scale, 100.0, 1e-9);
  EXPECT_EQ(alignment.init_true_depth_m(), 300.0);
}

}  // namespace
}  // namespace overfly::engine
