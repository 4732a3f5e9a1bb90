#include "server/calibration/calibrate_images.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cmath>

#include "server/calibration/calibration_file.hpp"
#include "server/files/png_file.hpp"
#include "server/files/whole_file.hpp"
#include "tests/support/support.hpp"

namespace overfly::server {
namespace {

namespace fs = std::filesystem;
using calibration::CalibratorOptions;
using overfly::testing::read_text;
using overfly::testing::TemporaryFolder;
using overfly::testing::write_text;
using ::testing::HasSubstr;

const CalibratorOptions kRadtanBoard{{9, 6, 0.03}, {DistortionModel::kRadtan, false}, false};

VirtualCalibration virtual_request(int views) {
  VirtualCalibration request;
  request.camera.camera =
      CameraModel(PinholeCamera{480, 360, 340.0, 338.5, 242.0, 177.0},
                  {DistortionModel::kRadtan, {-0.2, 0.05, 0.0005, -0.0004, 0.0}});
  request.camera.views = views;
  return request;
}

std::string reason_of(const CalibrationRecord& record, const std::string& name) {
  for (const LeftOutImage& image : record.left_out) {
    if (image.name == name) return image.reason;
  }
  return "not left out";
}

TEST(CalibrateVirtual, FindsTheCameraThroughDefocusAndNoise) {
  VirtualCalibration request = virtual_request(24);
  request.camera.sensor.enabled = true;
  request.camera.sensor.defocus_sigma_px = 0.7;
  request.camera.sensor.shot_noise = true;
  request.camera.sensor.read_noise_e = 8.0;
  request.camera.sensor.full_well_e = 10000.0;
  const auto record = calibrate_virtual(request, kRadtanBoard);
  ASSERT_TRUE(record.ok()) << record.error().message;
  const PinholeCamera& found = record->result.camera.pinhole();
  EXPECT_NEAR(found.fx_px, 340.0, 0.34);
  EXPECT_NEAR(found.fy_px, 338.5, 0.34);
  EXPECT_NEAR(found.cx_px, 242.0, 0.5);
  EXPECT_NEAR(found.cy_px, 177.0, 0.5);
  EXPECT_NEAR(record->result.camera.distortion().k[0], -0.2, 0.004);
  EXPECT_LT(record->result.rms_px, 0.15);
  EXPECT_EQ(record->truth->pinhole().fx_px, 340.0);
}

TEST(CalibrateVirtual, GivesTheSameFileFromTheSameSeed) {
  const auto a = calibrate_virtual(virtual_request(6), kRadtanBoard);
  const auto b = calibrate_virtual(virtual_request(6), kRadtanBoard);
  ASSERT_TRUE(a.ok() && b.ok());
  EXPECT_EQ(json_from(*a).dump(), json_from(*b).dump());
}

TEST(CalibrateVirtual, RejectsRequestsOutsideItsLimits) {
  for (const int views : {3, 1001}) {
    const auto record = calibrate_virtual(virtual_request(views), kRadtanBoard);
    ASSERT_FALSE(record.ok());
    EXPECT_THAT(record.error().message, HasSubstr("views = " + std::to_string(views)));
  }
  CalibratorOptions symmetric = kRadtanBoard;
  symmetric.board.rows = 7;
  EXPECT_FALSE(calibrate_virtual(virtual_request(6), symmetric).ok());
}

TEST(CalibrateVirtual, StopsWhenCancelled) {
  const std::atomic<bool> cancel{true};
  CalibrationProgress progress;
  progress.cancel = &cancel;
  const auto record = calibrate_virtual(virtual_request(6), kRadtanBoard, progress);
  ASSERT_FALSE(record.ok());
  EXPECT_EQ(record.error().code, ErrorCode::kCancelled);
}

class CalibrateImages : public ::testing::Test {
 protected:
  [[nodiscard]] fs::path file(const std::string& name) const { return folder_.path() / name; }
  /// Writes the images of a virtual board, and returns what they give directly.
  CalibrationRecord write_views(int count) {
    VirtualCalibration request = virtual_request(count);
    request.images = folder_.path();
    const auto record = calibrate_virtual(request, kRadtanBoard);
    EXPECT_TRUE(record.ok()) << record.error().message;
    return *record;
  }
  TemporaryFolder folder_;
};

TEST_F(CalibrateImages, GivesTheResultOfTheImagesInTheFolder) {
  const CalibrationRecord direct = write_views(8);
  const auto record = calibrate_images(folder_.path(), kRadtanBoard);
  ASSERT_TRUE(record.ok()) << record.error().message;
  EXPECT_EQ(record->names, direct.names);
  EXPECT_EQ(record->result.camera.pinhole().fx_px, direct.result.camera.pinhole().fx_px);
  EXPECT_FALSE(record->truth.has_value());
}

TEST_F(CalibrateImages, ListsEveryImageThatGivesNoView) {
  write_views(6);
  write_text(file("zz_text.png"), "this is no image");
  write_text(file("zz_notes.txt"), "not listed, because its name is not that of an image");
  fs::copy_file(file("view0001.png"), file("zz_copy.png"));
  ASSERT_TRUE(write_png_file(file("zz_grey.png"), Image(480, 360, 1, 90)));
  ASSERT_TRUE(write_png_file(file("zz_small.png"), Image(64, 64, 1, 90)));
  std::string huge = read_text(file("view0000.png"));
  huge.replace(16, 8, std::string("\x7f\xff\xff\xff\x7f\xff\xff\xff", 8));
  write_text(file("zz_huge.png"), huge);
  const std::string half = read_text(file("view0000.png"));
  write_text(file("zz_half.png"), half.substr(0, half.size() / 2));
  ASSERT_EQ(::mkfifo(file("zz_pipe.png").c_str(), 0600), 0);
  fs::create_directory(file("zz_folder.png"));

  const auto record = calibrate_images(folder_.path(), kRadtanBoard);
  ASSERT_TRUE(record.ok()) << record.error().message;
  EXPECT_EQ(record->names.size(), 6U);
  EXPECT_EQ(record->left_out.size(), 8U);
  EXPECT_THAT(reason_of(*record, "zz_text.png"), HasSubstr("format"));
  EXPECT_EQ(reason_of(*record, "zz_copy.png"), "near duplicate");
  EXPECT_EQ(reason_of(*record, "zz_grey.png"), "no board");
  EXPECT_THAT(reason_of(*record, "zz_small.png"), HasSubstr("64 x 64"));
  EXPECT_THAT(reason_of(*record, "zz_huge.png"), HasSubstr("at most 16384"));
  EXPECT_NE(reason_of(*record, "zz_half.png"), "not left out");
  EXPECT_THAT(reason_of(*record, "zz_pipe.png"), HasSubstr("regular"));
  EXPECT_NE(reason_of(*record, "zz_folder.png"), "not left out");
}

TEST_F(CalibrateImages, NamesImagesInTheErrorIfTooFewGiveViews) {
  write_views(6);
  for (const int i : {3, 4, 5}) fs::remove(file("view000" + std::to_string(i) + ".png"));
  ASSERT_TRUE(write_png_file(file("dark.png"), Image(480, 360, 1, 0)));
  const auto record = calibrate_images(folder_.path(), kRadtanBoard);
  ASSERT_FALSE(record.ok());
  EXPECT_THAT(record.error().message, HasSubstr("3 of 4 images give a view (dark.png: no board)"));
  EXPECT_THAT(record.error().message, HasSubstr("must be 4 to 1000"));
}

TEST_F(CalibrateImages, RejectsFoldersWithoutImages) {
  EXPECT_FALSE(calibrate_images(folder_.path(), kRadtanBoard).ok());
  const auto absent = calibrate_images(file("absent"), kRadtanBoard);
  ASSERT_FALSE(absent.ok());
  EXPECT_EQ(absent.error().code, ErrorCode::kNotFound);
}

TEST_F(CalibrateImages, WritesAFileFromWhichTheCameraIsReadExactly) {
  const CalibrationRecord record = write_views(6);
  const nlohmann::json written = json_from(record);
  ASSERT_TRUE(write_json(file("camera.json"), written));
  const auto camera = read_calibrated_camera(file("camera.json"));
  ASSERT_TRUE(camera.ok()) << camera.error().message;
  EXPECT_EQ(camera->pinhole().fy_px, record.result.camera.pinhole().fy_px);
  EXPECT_EQ(camera->pinhole().width_px, 480);
  EXPECT_EQ(camera->distortion().k, record.result.camera.distortion().k);
  EXPECT_EQ(written.at("views").size(), 6U);
  EXPECT_EQ(written.at("views")[2].at("image"), "view0002.png");
  EXPECT_EQ(written.at("standard_deviation").at("coefficients").size(), 5U);
  EXPECT_GT(written.at("standard_deviation").at("fx_px").get<double>(), 0.0);
}

TEST_F(CalibrateImages, RejectsInvalidCalibrationFilesWithTheirNames) {
  const std::string good =
      R"("format": "overfly-calibration", "format_version": 1, "width_px": 480, "height_px": 360,)";
  const std::string intrinsics = R"("fx_px": 300, "fy_px": 300, "cx_px": 239.5, "cy_px": 179.5)";
  write_text(file("a.json"), "{" + good + intrinsics + "}");
  EXPECT_TRUE(read_calibrated_camera(file("a.json")).ok());
  const std::vector<std::string> broken = {
      "",
      "[]",
      "{}",
      "{" + intrinsics + "}",
      R"({"format": "overfly-calibration", "format_version": 2})",
      "{" + good + R"("fx_px": -1, "fy_px": 300, "cx_px": 239.5, "cy_px": 179.5})",
      "{" + good + R"("fx_px": "300", "fy_px": 300, "cx_px": 239.5, "cy_px": 179.5})",
      "{" + good + intrinsics + R"(, "distortion": {"model": "radtan", "coefficients": [-9]}})",
      "{" + good + intrinsics + R"(, "distortion": {"model": "other", "coefficients": []}})"};
  for (const std::string& text : broken) {
    write_text(file("b.json"), text);
    const auto camera = read_calibrated_camera(file("b.json"));
    ASSERT_FALSE(camera.ok()) << text;
    EXPECT_EQ(camera.error().code, ErrorCode::kUnreadable) << text;
    EXPECT_THAT(camera.error().message, HasSubstr("b.json")) << text;
  }
  write_text(file("b.json"),
             "cam0:\n  camera_model: pinhole\n  intrinsics: [300, 300, 240, 180]\n");
  EXPECT_THAT(read_calibrated_camera(file("b.json")).error().message,
              HasSubstr("must be a calibration file of Overfly, JSON written by"));
}

}  // namespace
}  // namespace overfly::server
