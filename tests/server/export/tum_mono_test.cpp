// TUM monoVO data sets as DSO takes them in.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdio>
#include <sstream>

#include "core/motion/trajectory_io.hpp"
#include "sensor/photometric_calibration.hpp"
#include "tests/server/export/export_fixture.hpp"

namespace overfly::server {
namespace {

namespace fs = std::filesystem;
using overfly::testing::read_text;
using overfly::testing::TemporaryFolder;
using testing::different_samples;
using testing::export_options;
using testing::exported;
using ::testing::HasSubstr;
using testing::read_picture;
using testing::rows_of;
using testing::small_source;

constexpr const char* kSensorCamera =
    R"(camera={"width_px":160,"height_px":120,"rate_hz":10,"color":"rgb",
        "fx_px":90,"fy_px":91,"cx_px":77.25,"cy_px":61.5,
        "distortion":{"model":"fov","coefficients":[0.6]},
        "sensor":{"exposure_ms":4,"vignette":[-0.3,0,0],"shot_noise":true,"read_noise_e":12,
                  "response":{"shape":"gamma","gamma":2.0},
                  "auto_exposure":{"max_exposure_ms":16}}})";
constexpr const char* kOneLost = R"(faults=[{"kind":"dropped_frames","at_s":0.35,"duration_s":0.1},
                                            {"kind":"stamp_offset","at_s":1,"offset_ms":-3}])";

TEST(TumMono, HoldsTheImagesWithTheirTimesAndExposures) {
  const TemporaryFolder folder;
  const ExportSource source = small_source({kSensorCamera, kOneLost});
  const ExportSummary summary =
      exported(source, export_options(folder.path() / "d", DatasetFormat::kTumMono));
  EXPECT_EQ(summary.frames, 21);
  EXPECT_EQ(summary.images, 20);

  const auto frames = testing::frames_of(source.scenario);
  const auto rows = rows_of(folder.path() / "d" / "times.txt", ' ');
  ASSERT_EQ(rows.size(), 20U);
  const auto truth = read_trajectory(folder.path() / "d" / "groundtruth.txt");
  ASSERT_TRUE(truth.ok()) << truth.error().message;
  ASSERT_EQ(truth->trajectory.size(), 21U);
  std::size_t row = 0;
  for (const MadeFrame& frame : frames) {
    const CameraShot& shot = frame.shots.front();
    const StampedPose& pose = truth->trajectory.poses()[static_cast<std::size_t>(frame.frame)];
    EXPECT_EQ(pose.t_ns, frame.t_ns);
    EXPECT_LT((pose.pose.translation - shot.drawn.T_world_camera.translation).norm(), 1e-9);
    if (frame.frame == 4) {
      EXPECT_FALSE(shot.delivered);
      EXPECT_FALSE(fs::exists(folder.path() / "d" / "images" / "00004.png"));
      continue;
    }
    ASSERT_EQ(rows[row].size(), 3U);
    EXPECT_EQ(std::stoll(rows[row][0]), frame.frame);
    EXPECT_NEAR(std::stod(rows[row][1]), double(shot.stamp_ns) * 1e-9, 1e-9);
    EXPECT_NEAR(std::stod(rows[row][2]), double(shot.setting.exposure_ns) * 1e-6, 1e-6);
    // What an estimator was given, to the last bit: the luma of the colour image.
    const fs::path file = folder.path() / "d" / "images" / (rows[row][0] + ".png");
    EXPECT_EQ(different_samples(read_picture(file), grey_of(shot.image)), 0) << file;
    ++row;
  }
  // The faulty clock is in the times, not in the truth.
  EXPECT_NEAR(std::stod(rows.back()[1]), 1.997, 1e-9);
}

TEST(TumMono, CameraFileGivesTheCameraBackAsDsoReadsIt) {
  const TemporaryFolder folder;
  exported(small_source({kSensorCamera, "duration_s=0.1"}),
           export_options(folder.path() / "d", DatasetFormat::kTumMono));
  const std::string text = read_text(folder.path() / "d" / "camera.txt");
  // DSO: "FOV fx fy cx cy omega"; relative to the image where cx and cy are below 1:
  // pixel = relative * size, less half a pixel for the principal point.
  double fx = 0.0, fy = 0.0, cx = 0.0, cy = 0.0, omega = 0.0;
  int width = 0, height = 0;
  ASSERT_EQ(std::sscanf(text.c_str(),
                        "FOV %lf %lf %lf %lf %lf\n%d %d\n",
                        &fx,
                        &fy,
                        &cx,
                        &cy,
                        &omega,
                        &width,
                        &height),
            7)
      << text;
  EXPECT_EQ(width, 160);
  EXPECT_EQ(height, 120);
  EXPECT_NEAR(fx * width, 90.0, 1e-9);
  EXPECT_NEAR(fy * height, 91.0, 1e-9);
  EXPECT_NEAR(cx * width - 0.5, 77.25, 1e-9);
  EXPECT_NEAR(cy * height - 0.5, 61.5, 1e-9);
  EXPECT_EQ(omega, 0.6);
  EXPECT_THAT(text, HasSubstr("\ncrop\n160 120\n"));
}

TEST(TumMono, PhotometricFilesUndoTheSensorsChain) {
  const TemporaryFolder folder;
  const ExportSource source = small_source({kSensorCamera, "duration_s=0.1"});
  exported(source, export_options(folder.path() / "d", DatasetFormat::kTumMono));

  std::istringstream text(read_text(folder.path() / "d" / "pcalib.txt"));
  std::vector<double> curve;
  for (double value = 0.0; text >> value;) curve.push_back(value);
  ASSERT_EQ(curve.size(), 256U);
  // gamma 2: the value v stands for (v / 255)^2 of the light.
  for (int v = 0; v < 256; ++v) {
    EXPECT_NEAR(curve[static_cast<std::size_t>(v)], v * v / 255.0, 0.6) << v;
  }

  const cv::Mat vignette = read_picture(folder.path() / "d" / "vignette.png");
  ASSERT_EQ(vignette.type(), CV_16UC1);
  double least = 0.0, largest = 0.0;
  cv::minMaxLoc(vignette, &least, &largest);
  EXPECT_EQ(largest, 65535.0);
  const CameraSpec& camera = source.scenario.cameras.front();
  EXPECT_EQ(different_samples(vignette, sensor::vignette_map(camera.sensor, camera.model)), 0);
  EXPECT_LT(vignette.at<std::uint16_t>(119, 0), 0.8 * 65535.0);
}

TEST(TumMono, WritesNoPhotometricFilesWithoutASensorAndNamesOtherLenses) {
  const TemporaryFolder folder;
  exported(small_source({"duration_s=0.1"}),
           export_options(folder.path() / "plain", DatasetFormat::kTumMono));
  EXPECT_FALSE(fs::exists(folder.path() / "plain" / "pcalib.txt"));
  EXPECT_FALSE(fs::exists(folder.path() / "plain" / "vignette.png"));
  EXPECT_EQ(rows_of(folder.path() / "plain" / "times.txt", ' ').front().at(2), "0");
  const std::string pinhole = read_text(folder.path() / "plain" / "camera.txt");
  EXPECT_THAT(pinhole, HasSubstr("Pinhole "));
  EXPECT_THAT(pinhole, HasSubstr(" 0\n160 120\nnone\n160 120\n"));

  for (const auto& [lens, name] :
       {std::pair{R"({"model":"radtan","coefficients":[-0.1,0.01,0.001,0]})",
                  "RadTan ([0-9.]+ ){4}-0.1 0.01 0.001 0\n"},
        {R"({"model":"equidistant","coefficients":[0.01,0.001,0,0]})",
         "EquiDistant ([0-9.]+ ){4}0.01 0.001 0 0\n"}}) {
    const fs::path out = folder.path() / std::string(name, 6);
    exported(small_source({"duration_s=0.1", std::string("camera.distortion=") + lens}),
             export_options(out, DatasetFormat::kTumMono));
    EXPECT_THAT(read_text(out / "camera.txt"), ::testing::ContainsRegex(name));
  }
}

}  // namespace
}  // namespace overfly::server
