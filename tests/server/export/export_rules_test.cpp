// What every export keeps to: the run's own images, equal bytes, whole files, clear errors.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "server/files/jpeg.hpp"
#include "server/files/whole_file.hpp"
#include "server/run/run.hpp"
#include "server/scenario/document/scenario_override.hpp"
#include "terrain/raster/image_file.hpp"
#include "tests/server/export/export_fixture.hpp"
#include "tests/support/support.hpp"

namespace overfly::server {
namespace {

namespace fs = std::filesystem;
using overfly::testing::larger_error;
using overfly::testing::read_text;
using overfly::testing::TemporaryFolder;
using overfly::testing::write_text;
using testing::contents_without_timings;
using testing::export_options;
using testing::exported;
using ::testing::HasSubstr;
using testing::rows_of;
using testing::small_source;

constexpr const char* kLivelyCamera =
    R"(camera={"width_px":160,"height_px":120,"rate_hz":10,
        "sensor":{"exposure_ms":6,"readout_ms":10,"motion_blur":true,"shot_noise":true,
                  "read_noise_e":20,"auto_exposure":{"max_exposure_ms":16}},
        "vibration":{"noise_rotation_rms_mrad":[0.5,0.5,0.5]}})";
constexpr const char* kFaults =
    R"(faults=[{"kind":"frozen_frame","at_s":0.55,"duration_s":0.2},
               {"kind":"dirt","at_s":1.2}])";

/// A run of a scenario, with its images recorded.
fs::path flown(const fs::path& folder, const std::vector<std::string>& overrides) {
  std::vector<std::string> all = overrides;
  all.emplace_back("recording.frames=true");
  RunOptions options;
  options.folder = folder;
  options.renderer_factory = testing::raycast_factory();
  const auto run = run_scenario(testing::small_scenario(all), options);
  if (!run) throw std::runtime_error(run.error().message);
  return folder;
}

ExportSource opened(const fs::path& path) {
  Result<ExportSource> source = open_export_source(path);
  if (!source) throw std::runtime_error(source.error().message);
  return std::move(*source);
}

void replace_in(const fs::path& file, const std::string& from, const std::string& to) {
  std::string text = read_text(file);
  const std::size_t at = text.find(from);
  ASSERT_NE(at, std::string::npos) << from << " in " << file;
  write_text(file, text.replace(at, from.size(), to));
}

void expect_refused(const ExportSource& source,
                    const ExportOptions& options,
                    ErrorCode code,
                    const std::string& text) {
  const auto result = export_dataset(source, options);
  ASSERT_FALSE(result.ok()) << text;
  EXPECT_EQ(result.error().code, code) << result.error().message;
  EXPECT_THAT(result.error().message, HasSubstr(text));
  EXPECT_FALSE(fs::exists(options.folder / "overfly.json"));
}

TEST(Export, ImagesOfARunAreThoseThatItRecorded) {
  const TemporaryFolder folder;
  const fs::path run = flown(folder.path() / "run", {kLivelyCamera, kFaults});
  const ExportSource source = opened(run);
  ASSERT_TRUE(source.run.has_value());
  exported(source, export_options(folder.path() / "d", DatasetFormat::kPng));
  int compared = 0;
  for (const auto& entry : fs::directory_iterator(run / "frames")) {
    const fs::path png =
        folder.path() / "d" / "images" / "camera0" / entry.path().stem().replace_extension("png");
    const Result<Image> image = terrain::read_png(png, kMostImageSidePx);
    ASSERT_TRUE(image.ok()) << image.error().message;
    // JPEG of equal images is equal byte by byte: the recorder writes quality 95.
    const auto jpeg = encode_jpeg(*image, 95);
    ASSERT_TRUE(jpeg.ok());
    EXPECT_EQ(std::string(jpeg->begin(), jpeg->end()), read_text(entry.path())) << png;
    ++compared;
  }
  EXPECT_EQ(compared, 21);
}

TEST(Export, ARunsFlightIsTheRecordedOne) {
  const TemporaryFolder folder;
  const fs::path run = flown(folder.path() / "run", {kLivelyCamera});
  // As if this version flew the course in another way.
  const fs::path file = run / "scenario.json";
  auto document = read_json(file);
  ASSERT_TRUE(document.ok());
  (*document)["flight"]["course"]["airspeed_m_s"] = 31.0;
  ASSERT_TRUE(write_json(file, *document).ok());
  const ExportSource source = opened(run);
  EXPECT_EQ(exported(source, export_options(folder.path() / "d", DatasetFormat::kPng)).frames, 21);
}

TEST(Export, InertialDataOfARunAreThoseOfItsFlight) {
  const TemporaryFolder folder;
  const std::vector<std::string> turning = {
      "duration_s=9", "flight.course.length_m=900", "epoch_utc_s=1700000000"};
  const fs::path run = flown(folder.path() / "run", turning);
  for (const auto& [name, source] :
       {std::pair{"run", opened(run)}, std::pair{"scenario", small_source(turning)}}) {
    ExportOptions options = export_options(folder.path() / name / "d", DatasetFormat::kEuroc);
    options.renderer_factory = testing::noop_factory();
    options.imu = flight::ImuModel::ideal(200.0);
    options.from_s = 4.0;
    exported(source, options);
  }
  const auto imu = [&](const char* name) {
    return rows_of(folder.path() / name / "d" / "mav0" / "imu0" / "data.csv", ',');
  };
  const auto recorded = imu("run");
  const auto exact = imu("scenario");
  ASSERT_EQ(recorded.size(), exact.size());
  ASSERT_GT(exact.size(), 900U);
  double worst_rad_s = 0.0, worst_m_s2 = 0.0;
  for (std::size_t i = 0; i < exact.size(); ++i) {
    ASSERT_EQ(recorded[i][0], exact[i][0]) << i;
    for (std::size_t column = 1; column < 7; ++column) {
      double& worst = column < 4 ? worst_rad_s : worst_m_s2;
      worst = larger_error(worst,
                           std::abs(std::stod(recorded[i][column]) - std::stod(exact[i][column])));
    }
  }
  std::printf("[ IMU      ] from samples: %.2g rad/s, %.2g m/s2 off\n", worst_rad_s, worst_m_s2);
  // A hundredth of the default noise of one sample (2.4e-3 rad/s, 0.028 m/s2).
  EXPECT_LT(worst_rad_s, 2.4e-5);
  EXPECT_LT(worst_m_s2, 2.8e-4);
}

TEST(Export, EqualSourcesGiveEqualBytes) {
  const TemporaryFolder folder;
  const ExportSource source = small_source({kLivelyCamera, "duration_s=0.5"});
  for (const char* name : {"a", "b"}) {
    ExportOptions options = export_options(folder.path() / name, DatasetFormat::kEuroc);
    options.truth = {TruthKind::kDepth, TruthKind::kFlow, TruthKind::kMask};
    options.video = VideoLook{};
    options.video->view = VideoView::kCamera;
    exported(source, options);
  }
  const auto first = contents_without_timings(folder.path() / "a");
  const auto second = contents_without_timings(folder.path() / "b");
  EXPECT_GT(first.size(), 20U);
  EXPECT_EQ(first, second);
}

TEST(Export, ASpanHasTheImagesOfTheWholeFlight) {
  const TemporaryFolder folder;
  const ExportSource source = small_source({kLivelyCamera, kFaults});
  exported(source, export_options(folder.path() / "all", DatasetFormat::kPng));
  ExportOptions options = export_options(folder.path() / "part", DatasetFormat::kPng);
  options.from_s = 0.65;
  options.to_s = 1.3;
  EXPECT_EQ(exported(source, options).frames, 7);
  // Auto-exposure and the frozen image have their history from before the span.
  for (int k = 7; k <= 13; ++k) {
    char name[48];
    std::snprintf(name, sizeof name, "images/camera0/%06d.png", k);
    EXPECT_EQ(read_text(folder.path() / "part" / name), read_text(folder.path() / "all" / name))
        << name;
  }
}

TEST(Export, CancelledDataSetIsWholeAndTheRestCanFollow) {
  const TemporaryFolder folder;
  const ExportSource source = small_source({kLivelyCamera});
  std::atomic<bool> cancel = false;
  ExportOptions options = export_options(folder.path() / "cut", DatasetFormat::kPng);
  options.cancel = &cancel;
  options.progress = [&](std::int64_t done, std::int64_t total) {
    EXPECT_EQ(total, 21);
    cancel = done == 5;
  };
  const ExportSummary summary = exported(source, options);
  EXPECT_TRUE(summary.cancelled);
  EXPECT_EQ(summary.frames, 5);
  EXPECT_EQ(rows_of(folder.path() / "cut" / "camera0.csv", ',').size(), 6U);
  const auto about = read_json(folder.path() / "cut" / "overfly.json");
  ASSERT_TRUE(about.ok());
  EXPECT_EQ(about->at("complete"), false);
  EXPECT_EQ(about->at("frames"), 5);

  cancel = false;
  options.progress = nullptr;
  const auto again = export_dataset(source, options);
  ASSERT_FALSE(again.ok());
  EXPECT_EQ(again.error().code, ErrorCode::kConflict);
  EXPECT_THAT(again.error().message, HasSubstr("cut: is not empty"));
  EXPECT_EQ(rows_of(folder.path() / "cut" / "camera0.csv", ',').size(), 6U);

  options.folder = folder.path() / "rest";
  options.from_s = 0.5;
  EXPECT_EQ(exported(source, options).frames, 16);
  EXPECT_TRUE(fs::exists(folder.path() / "rest" / "images" / "camera0" / "000005.png"));
}

TEST(Export, NamesAFolderThatCannotBeWritten) {
  const TemporaryFolder folder;
  write_text(folder.path() / "file", "x");
  ExportOptions options = export_options(folder.path() / "file" / "d", DatasetFormat::kPng);
  expect_refused(small_source(), options, ErrorCode::kIo, "file/d");
}

TEST(Export, NamesWhatCannotBeExported) {
  const TemporaryFolder folder;
  const auto options = [&](DatasetFormat format) {
    return export_options(folder.path() / "d", format);
  };
  constexpr auto kInvalid = ErrorCode::kInvalidArgument;
  ExportOptions changed = options(DatasetFormat::kPng);
  changed.cameras = {"nose"};
  expect_refused(
      small_source(), changed, kInvalid, "camera = nose: must be one of the scenario's: camera0");
  changed = options(DatasetFormat::kPng);
  changed.from_s = 5.0;
  expect_refused(small_source(), changed, kInvalid, "the flight spans [0, 2.0");
  changed = options(DatasetFormat::kPng);
  changed.from_s = -1.0;
  expect_refused(small_source(), changed, kInvalid, "from = -1");
  changed = options(DatasetFormat::kEuroc);
  changed.imu = flight::ImuModel::ideal(0.0);
  expect_refused(small_source(), changed, kInvalid, "rate_hz");
  changed = options(DatasetFormat::kPng);
  changed.video = VideoLook{VideoView::kCamera, 0, 720};
  expect_refused(small_source(), changed, kInvalid, "video.quality = 0: must be in [1, 100]");

  const char* lens = R"(camera.distortion={"model":"radtan","coefficients":[-0.1,0,0,0,0.01]})";
  expect_refused(small_source({lens}),
                 options(DatasetFormat::kKitti),
                 ErrorCode::kUnsupported,
                 "calib.txt of kitti cannot describe a lens, distortion is radtan");
  expect_refused(
      small_source({lens}), options(DatasetFormat::kTumMono), ErrorCode::kUnsupported, "k3 = 0.01");
  const char* two = R"(cameras=[{"name":"a","width_px":64,"height_px":48,"rate_hz":10},
                                {"name":"b","width_px":64,"height_px":48,"rate_hz":10}])";
  changed = options(DatasetFormat::kKitti);
  changed.cameras = {"a", "b"};
  expect_refused(small_source({two}), changed, ErrorCode::kUnsupported, "select one with --camera");
}

TEST(ExportSource, RefusesARunThatCannotBeMadeAgain) {
  const TemporaryFolder folder;
  EXPECT_EQ(open_export_source(folder.path() / "none").error().code, ErrorCode::kNotFound);
  EXPECT_EQ(open_export_source(folder.path()).error().code, ErrorCode::kNotFound);

  const fs::path run = flown(folder.path() / "run", {"duration_s=0.5"});
  const auto overridden = open_export_source(run, {parse_override("duration_s=1").value()});
  EXPECT_EQ(overridden.error().code, ErrorCode::kInvalidArgument);
  EXPECT_THAT(overridden.error().message, HasSubstr("--set applies only to scenarios"));

  const fs::path moved = folder.path() / "moved";
  fs::copy(run, moved, fs::copy_options::recursive);
  replace_in(moved / "scenario.json", R"("airspeed_m_s": 25)", R"("airspeed_m_s": 30)");
  // A run of an earlier version: its flight is that of the scenario.
  fs::remove(moved / "truth_samples.bin");
  expect_refused(opened(moved),
                 export_options(folder.path() / "d1", DatasetFormat::kPng),
                 ErrorCode::kConflict,
                 "away from the recorded pose");

  const fs::path other = folder.path() / "other";
  fs::copy(run, other, fs::copy_options::recursive);
  replace_in(other / "manifest.json", "sha256:", "sha256:0");
  expect_refused(opened(other),
                 export_options(folder.path() / "d2", DatasetFormat::kPng),
                 ErrorCode::kConflict,
                 "the run flew over sha256:0");
}

}  // namespace
}  // namespace overfly::server
