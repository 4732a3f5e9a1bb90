#include "server/calibration/camera_text.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <opencv2/core.hpp>
#include <regex>
#include <string>

#include "server/dataset/dataset_reader.hpp"
#include "tests/support/support.hpp"

namespace overfly::server {
namespace {

using overfly::testing::TemporaryFolder;
using overfly::testing::write_text;
using ::testing::HasSubstr;

constexpr PinholeCamera kIntrinsics{1280, 960, 700.25, 699.5, 641.0, 478.75};

CameraModel camera_with(DistortionModel model, std::array<double, 5> k) {
  return {kIntrinsics, {model, k}};
}

const CameraModel kRadtan =
    camera_with(DistortionModel::kRadtan, {-0.28, 0.07, 0.0002, 1e-05, 0.0});
const CameraModel kFisheye =
    camera_with(DistortionModel::kEquidistant, {0.003, 0.0007, -0.002, 0.0002, 0.0});

std::string text_of(CameraFormat format, const CameraModel& camera) {
  const auto text = camera_text(format, camera, "down");
  EXPECT_TRUE(text.ok()) << text.error().message;
  return text ? *text : "";
}

/// ORB-SLAM2 reads its settings by cv::FileStorage; ORB-SLAM3 demands real numbers.
TEST(CameraText, OrbSlam2IsReadByOpenCv) {
  const std::string text = text_of(CameraFormat::kOrbSlam2, kRadtan);
  const cv::FileStorage file(text, cv::FileStorage::READ | cv::FileStorage::MEMORY);
  const auto real = [&](const char* key) {
    EXPECT_TRUE(file[key].isReal()) << key;
    return static_cast<double>(file[key]);
  };
  EXPECT_EQ(real("Camera.fx"), 700.25);
  EXPECT_EQ(real("Camera.fy"), 699.5);
  EXPECT_EQ(real("Camera.cx"), 641.0);
  EXPECT_EQ(real("Camera.cy"), 478.75);
  EXPECT_EQ(real("Camera.k1"), -0.28);
  EXPECT_EQ(real("Camera.p2"), 1e-05);
  EXPECT_EQ(real("Camera.k3"), 0.0);
  EXPECT_EQ(static_cast<int>(file["Camera.width"]), 1280);
}

TEST(CameraText, DsoIsReadBackWithHalfAPixelRemoved) {
  const TemporaryFolder folder;
  for (const CameraModel& camera : {kRadtan, kFisheye, CameraModel(kIntrinsics)}) {
    write_text(folder.path() / "camera.txt", text_of(CameraFormat::kDso, camera));
    const auto read = read_tum_mono_camera(folder.path() / "camera.txt");
    ASSERT_TRUE(read.ok()) << read.error().message;
    EXPECT_NEAR(read->pinhole().fx_px, 700.25, 1e-10);
    EXPECT_NEAR(read->pinhole().cx_px, 641.0, 1e-10);
    EXPECT_NEAR(read->pinhole().cy_px, 478.75, 1e-10);
    EXPECT_EQ(read->distortion().model, camera.distortion().model);
    EXPECT_EQ(read->distortion().k, camera.distortion().k);
  }
}

TEST(CameraText, SvoHasTheKeysOfItsLoader) {
  EXPECT_EQ(text_of(CameraFormat::kSvo, kRadtan),
            "cam_model: Pinhole\ncam_width: 1280\ncam_height: 960\ncam_fx: 700.25\ncam_fy: 699.5\n"
            "cam_cx: 641.0\ncam_cy: 478.75\ncam_d0: -0.28\ncam_d1: 0.07\ncam_d2: 2.0e-04\n"
            "cam_d3: 1.0e-05\n");
}

TEST(CameraText, RosHasTheMatricesOfCameraInfo) {
  const std::string text = text_of(CameraFormat::kRos, kRadtan);
  EXPECT_THAT(text, HasSubstr("camera_name: down\n"));
  EXPECT_THAT(text, HasSubstr("  data: [700.25, 0.0, 641.0, 0.0, 699.5, 478.75, 0.0, 0.0, 1.0]\n"));
  EXPECT_THAT(text,
              HasSubstr("distortion_model: plumb_bob\ndistortion_coefficients:\n  rows: 1\n  cols: "
                        "5\n  data: [-0.28, 0.07, 2.0e-04, 1.0e-05, 0.0]\n"));
  EXPECT_THAT(text,
              HasSubstr("  data: [700.25, 0.0, 641.0, 0.0, 0.0, 699.5, 478.75, 0.0, 0.0, 0.0, 1.0, "
                        "0.0]\n"));
  EXPECT_THAT(text_of(CameraFormat::kRos, kFisheye),
              HasSubstr("distortion_model: equidistant\ndistortion_coefficients:\n  rows: 1\n  "
                        "cols: 4\n  data: [0.003, 7.0e-04, -0.002, 2.0e-04]\n"));
}

TEST(CameraText, KalibrHasTheKeysOfACamchain) {
  EXPECT_EQ(text_of(CameraFormat::kKalibr, kFisheye),
            "cam0:\n  camera_model: pinhole\n  intrinsics: [700.25, 699.5, 641.0, 478.75]\n"
            "  distortion_model: equi\n  distortion_coeffs: [0.003, 7.0e-04, -0.002, 2.0e-04]\n"
            "  resolution: [1280, 960]\n  rostopic: /camera/image_raw\n  cam_overlaps: []\n");
  EXPECT_THAT(text_of(CameraFormat::kKalibr, kRadtan),
              HasSubstr("distortion_model: radtan\n  distortion_coeffs: [-0.28, 0.07, 2.0e-04, "
                        "1.0e-05]\n"));
}

/// The numbers that YAML 1.1 takes for floats (yaml.org/type/float.html) have a point, and a sign
/// in the exponent. PyYAML reads others as text.
TEST(CameraText, NumbersAreFloatsOfYaml) {
  const std::regex number(R"([-+]?[0-9]+\.[0-9]*([eE][-+][0-9]+)?)");
  const std::regex field(R"((?:: |\[|, )([-+0-9][^,\]\n]*))");
  const CameraModel tiny = camera_with(DistortionModel::kRadtan, {1e-12, -3e-7, 0.0, 1e-5, 0.0});
  for (const CameraFormat format :
       {CameraFormat::kOrbSlam2, CameraFormat::kSvo, CameraFormat::kRos, CameraFormat::kKalibr}) {
    const std::string text = text_of(format, tiny);
    int floats = 0;
    for (std::sregex_iterator i(text.begin(), text.end(), field), end; i != end; ++i) {
      const std::string value = (*i)[1];
      if (value.find_first_not_of("0123456789") == std::string::npos) continue;  // sizes
      EXPECT_TRUE(std::regex_match(value, number)) << to_string(format) << ": " << value;
      ++floats;
    }
    EXPECT_GE(floats, 8) << text;
  }
}

TEST(CameraText, RefusesLensesThatAFormatCannotHold) {
  for (const CameraFormat format : {CameraFormat::kOrbSlam2, CameraFormat::kSvo}) {
    const auto text = camera_text(format, kFisheye, "down");
    ASSERT_FALSE(text.ok()) << to_string(format);
    EXPECT_EQ(text.error().code, ErrorCode::kUnsupported);
    EXPECT_THAT(text.error().message, HasSubstr("equidistant"));
  }
  const CameraModel k3 = camera_with(DistortionModel::kRadtan, {-0.2, 0.05, 0.0, 0.0, 0.01});
  for (const CameraFormat format :
       {CameraFormat::kDso, CameraFormat::kSvo, CameraFormat::kKalibr}) {
    const auto text = camera_text(format, k3, "down");
    ASSERT_FALSE(text.ok()) << to_string(format);
    EXPECT_THAT(text.error().message, HasSubstr("k3 = 0.01"));
  }
}

TEST(CameraText, FormatsAreFoundByTheirNames) {
  for (const CameraFormat format : kCameraFormats) {
    EXPECT_EQ(camera_format_from(to_string(format)), format);
  }
  EXPECT_FALSE(camera_format_from("orb").has_value());
}

}  // namespace
}  // namespace overfly::server
