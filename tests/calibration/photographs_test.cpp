// Real photographs: 13 images of OpenCV's left camera with a board of 9 x 6 inner corners and
// squares of 25 mm, with OpenCV's own results for them. Debian's package opencv-doc contains both;
// it is large, so the tests are skipped where it is absent.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgcodecs.hpp>
#include <string>
#include <vector>

#include "calibration/calibrator.hpp"

namespace overfly::calibration {
namespace {

namespace fs = std::filesystem;

fs::path photographs() {
  const char* folder = std::getenv("OVERFLY_OPENCV_SAMPLES");
  return folder != nullptr ? folder : "/usr/share/doc/opencv-doc/examples/data";
}

#define PHOTOGRAPHS_OR_SKIP(side)                                                \
  if (!fs::exists(photographs() / (std::string(side) + "01.jpg"))) {             \
    GTEST_SKIP() << "the package opencv-doc is not installed: " << photographs() \
                 << " is absent; OVERFLY_OPENCV_SAMPLES names another folder";   \
  }

/// Images 01 to 14; there is no 10.
Calibrator calibrator_of(const std::string& side, bool k3) {
  auto calibrator = Calibrator::create({{9, 6, 0.025}, {DistortionModel::kRadtan, k3}, false});
  for (int i = 1; i <= 14; ++i) {
    const std::string name = side + (i < 10 ? "0" : "") + std::to_string(i) + ".jpg";
    if (i == 10) continue;
    const cv::Mat read = cv::imread((photographs() / name).string(), cv::IMREAD_GRAYSCALE);
    Image image(read.cols, read.rows, 1);
    std::copy(read.begin<std::uint8_t>(), read.end<std::uint8_t>(), image.data.begin());
    const auto verdict = calibrator->add(image, name);
    EXPECT_TRUE(verdict.ok() && *verdict == ViewVerdict::kTaken) << name;
  }
  return std::move(*calibrator);
}

struct CvResult {
  CameraModel camera;
  double rms_px = 0.0;
};

CvResult calibrate_by_opencv(const Calibrator& calibrator, int flags) {
  std::vector<std::vector<cv::Point3f>> board;
  std::vector<std::vector<cv::Point2f>> image;
  for (const BoardView& view : calibrator.views()) {
    board.emplace_back();
    image.emplace_back();
    for (const BoardCorner& corner : view.corners) {
      board.back().emplace_back(0.025F * (corner.id % 9), 0.025F * (corner.id / 9), 0.0F);
      image.back().emplace_back(corner.pixel.x(), corner.pixel.y());
    }
  }
  cv::Mat K;
  cv::Mat d;
  std::vector<cv::Mat> r;
  std::vector<cv::Mat> t;
  const cv::TermCriteria end(cv::TermCriteria::COUNT + cv::TermCriteria::EPS, 200, 1e-14);
  const double rms = cv::calibrateCamera(board, image, cv::Size(640, 480), K, d, r, t, flags, end);
  return {{PinholeCamera{640,
                         480,
                         K.at<double>(0, 0),
                         K.at<double>(1, 1),
                         K.at<double>(0, 2),
                         K.at<double>(1, 2)},
           {DistortionModel::kRadtan,
            {d.at<double>(0), d.at<double>(1), d.at<double>(2), d.at<double>(3), d.at<double>(4)}}},
          rms};
}

/// The file left_intrinsics.yml in the folder of the images. It was made with one focal length for
/// both axes and less accurate corners (RMS 0.39 px, one view 1.2 px), so the cameras agree only
/// roughly.
TEST(Photographs, GiveTheCameraThatOpenCvPublishes) {
  PHOTOGRAPHS_OR_SKIP("left");
  cv::FileStorage file((photographs() / "left_intrinsics.yml").string(), cv::FileStorage::READ);
  cv::Mat K;
  file["camera_matrix"] >> K;
  ASSERT_EQ(K.rows, 3);
  const auto found = calibrator_of("left", true).solve();
  ASSERT_TRUE(found.ok()) << found.error().message;
  const PinholeCamera& c = found->camera.pinhole();
  EXPECT_NEAR(c.fx_px / K.at<double>(0, 0), 1.0, 0.01);
  EXPECT_NEAR(c.fy_px / K.at<double>(1, 1), 1.0, 0.01);
  EXPECT_NEAR(c.cx_px, K.at<double>(0, 2), 2.0);
  EXPECT_NEAR(c.cy_px, K.at<double>(1, 2), 2.0);
  EXPECT_NEAR(found->camera.distortion().k[0], -0.266, 0.03);
  EXPECT_LT(found->rms_px, 0.2);  // theirs: 0.393
  ASSERT_EQ(found->views.size(), 13U);
  for (const CalibratedView& view : found->views) EXPECT_FALSE(view.outlier);
}

TEST(Photographs, GiveTheSameMinimumAsOpenCvFromTheSameCorners) {
  for (const char* side : {"left", "right"}) {
    PHOTOGRAPHS_OR_SKIP(side);
    const Calibrator calibrator = calibrator_of(side, false);
    const auto found = calibrator.solve();
    ASSERT_TRUE(found.ok()) << found.error().message;
    const CvResult theirs = calibrate_by_opencv(calibrator, cv::CALIB_FIX_K3);
    EXPECT_NEAR(found->rms_px, theirs.rms_px, 1e-6);
    const PinholeCamera& a = found->camera.pinhole();
    const PinholeCamera& b = theirs.camera.pinhole();
    // OpenCV takes corners as floats and stops before the minimum is exact.
    EXPECT_NEAR(a.fx_px, b.fx_px, 5e-3);
    EXPECT_NEAR(a.fy_px, b.fy_px, 5e-3);
    EXPECT_NEAR(a.cx_px, b.cx_px, 5e-3);
    EXPECT_NEAR(a.cy_px, b.cy_px, 5e-3);
    for (std::size_t i = 0; i < 4; ++i) {
      EXPECT_NEAR(found->camera.distortion().k[i], theirs.camera.distortion().k[i], 1e-4) << i;
    }
  }
}

}  // namespace
}  // namespace overfly::calibration
