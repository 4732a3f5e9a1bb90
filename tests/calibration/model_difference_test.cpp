#include "calibration/model_difference.hpp"

#include <gtest/gtest.h>

namespace overfly::calibration {
namespace {

const PinholeCamera kCamera{641, 481, 500.0, 500.0, 320.0, 240.0};

TEST(ModelDifference, OfEqualModelsIsNothing) {
  const CameraModel camera(kCamera, {DistortionModel::kRadtan, {-0.2, 0.03, 0.001, 0.0, 0.0}});
  const ModelDifference difference = model_difference(camera, camera);
  EXPECT_LT(difference.max_px, 1e-6);
}

TEST(ModelDifference, OfAShiftedPrincipalPointIsTheShift) {
  PinholeCamera other = kCamera;
  other.cx_px += 3.0;
  other.cy_px -= 4.0;
  const ModelDifference difference = model_difference(CameraModel(kCamera), CameraModel(other));
  EXPECT_NEAR(difference.mean_px, 5.0, 1e-9);
  EXPECT_NEAR(difference.max_px, 5.0, 1e-9);
}

TEST(ModelDifference, OfALongerFocalLengthIsLargestInTheCorner) {
  PinholeCamera other = kCamera;
  other.fx_px *= 1.01;
  other.fy_px *= 1.01;
  const ModelDifference difference = model_difference(CameraModel(kCamera), CameraModel(other));
  // 1 % of the half diagonal of 320 x 240 px.
  EXPECT_NEAR(difference.max_px, 4.0, 1e-9);
  EXPECT_LT(difference.mean_px, difference.max_px);
  EXPECT_GT(difference.mean_px, 0.3 * difference.max_px);
}

}  // namespace
}  // namespace overfly::calibration
