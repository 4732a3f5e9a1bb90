#include "server/record/run_folder.hpp"

#include <gtest/gtest.h>

#include "server/record/run_info.hpp"

namespace overfly::server {
namespace {

TEST(CameraFiles, OfTheMainCameraHaveNoName) {
  const CameraFiles files("r", kMainCamera, "nadir");
  EXPECT_EQ(files.rows(), "r/frames.jsonl");
  EXPECT_EQ(files.truth(), "r/truth.tum");
  EXPECT_EQ(files.image(7), "r/frames/000007.jpg");
  EXPECT_EQ(files.deep_image(7), "r/frames16/000007.png");
  EXPECT_EQ(CameraFiles::of_main_camera("r").rows(), files.rows());
}

TEST(CameraFiles, OfAnyOtherCameraHaveItsName) {
  const CameraFiles files("r", 1, "tilted");
  EXPECT_EQ(files.rows(), "r/cameras/tilted.jsonl");
  EXPECT_EQ(files.truth(), "r/cameras/tilted.tum");
  EXPECT_EQ(files.image(1234567), "r/frames/tilted/1234567.jpg");
  EXPECT_EQ(files.deep_image(0), "r/frames16/tilted/000000.png");
}

}  // namespace
}  // namespace overfly::server
