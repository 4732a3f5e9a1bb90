#include "server/scoring/camera_metrics.hpp"

#include <gtest/gtest.h>

namespace overfly::server {
namespace {

TEST(CameraMetrics, CountTheFramesThatAreMostlyWithoutImagery) {
  CameraRecords camera;
  camera.frames.resize(5);
  const std::vector<double> fractions = {0.0, 0.5, 0.51, 1.0, 1.0};
  for (std::size_t i = 0; i < fractions.size(); ++i) {
    camera.frames[i].void_fraction = fractions[i];
    camera.frames[i].texels_per_pixel_median = fractions[i] < 1.0 ? 2.0 : 0.0;
  }
  const CameraMetrics metrics = camera_metrics_from(camera);
  EXPECT_EQ(metrics.mostly_void_frames, 3);
  EXPECT_EQ(metrics.void_fraction_max, 1.0);
  EXPECT_EQ(metrics.texture.texels_per_pixel_median, 2.0);
}

TEST(CameraMetrics, ImageryIsReportedAsMissingInMoreThanATenthOfTheFrames) {
  CameraMetrics metrics;
  metrics.frames = 100;
  metrics.mostly_void_frames = 10;
  EXPECT_EQ(void_words("the camera", metrics), "");
  metrics.mostly_void_frames = 34;
  EXPECT_EQ(void_words("the camera", metrics),
            "in 34 % of the frames more than half of the image of the camera is without imagery");
  EXPECT_EQ(void_words("the camera", CameraMetrics{}), "");
}

}  // namespace
}  // namespace overfly::server
