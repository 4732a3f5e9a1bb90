// Each field that a renderer cannot draw is refused by name, with its value and its limit.
#include "renderer/request_check.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "tests/renderer/procedural_ground.hpp"

namespace overfly::renderer {
namespace {

constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();
constexpr double kEndless = std::numeric_limits<double>::infinity();

class RequestCheck : public ::testing::Test {
 protected:
  using Change = std::function<void(CameraRequest&)>;

  static PinholeCamera pinhole() {
    return PinholeCamera::from_fov(64, 48, 1.2, FovAxis::kHorizontal).value();
  }
  static Pose pose() {
    return {R_world_body_from({0.1, 0.2, 0.3}) * R_body_camera_nadir(), {10.0, 20.0, 100.0}};
  }
  /// The error's text; empty if the request is accepted.
  std::string refusal(const Change& change) {
    CameraRequest request = CameraRequest::still(pinhole(), pose(), 5, PixelFormat::kGrey8);
    change(request);
    const Status status = check_camera_request(ground_, request);
    if (status) return "";
    EXPECT_EQ(status.error().code, ErrorCode::kInvalidArgument);
    return status.error().message;
  }
  std::string refusal_of_pinhole(const std::function<void(PinholeCamera&)>& change) {
    return refusal([&](CameraRequest& request) {
      PinholeCamera changed = pinhole();
      change(changed);
      request.camera = changed;
    });
  }
  std::string refusal_of_pose(const std::function<void(Pose&)>& change) {
    return refusal([&](CameraRequest& request) {
      Pose changed = pose();
      change(changed);
      request.T_world_camera = changed;
    });
  }

  overfly::testing::ProceduralGround ground_{{}};
};

void expect_parts(const std::string& message, const std::vector<std::string>& parts) {
  for (const std::string& part : parts) {
    EXPECT_NE(message.find(part), std::string::npos) << '"' << part << "\" in: " << message;
  }
}

TEST_F(RequestCheck, AcceptsAGoodRequestAndEachLimitItself) {
  EXPECT_EQ(refusal([](CameraRequest&) {}), "");
  EXPECT_EQ(refusal([](CameraRequest& r) { r.exposure_ns = r.readout_ns = 1'000'000'000; }), "");
  EXPECT_EQ(refusal([](CameraRequest& r) { r.atmosphere.extinction_per_m = 1.0; }), "");
  EXPECT_EQ(refusal([](CameraRequest& r) { r.atmosphere.airlight_rgb = {0.0F, 1.0F, 0.5F}; }), "");
  EXPECT_EQ(refusal([](CameraRequest& r) { r.velocity_world_m_s = {1e4, -1e4, 0.0}; }), "");
  EXPECT_EQ(refusal_of_pinhole([](PinholeCamera& c) { c.width_px = kMaxImageSidePx; }), "");
  EXPECT_EQ(refusal_of_pose([](Pose& p) { p.translation.z() = 1e6; }), "");
  EXPECT_EQ(refusal_of_pose([](Pose& p) { p.rotation.coeffs() *= 1.0009; }), "");
}

TEST_F(RequestCheck, RefusesCamerasByField) {
  const auto refused = [&](const auto& change, const std::vector<std::string>& parts) {
    expect_parts(refusal_of_pinhole(change), parts);
  };
  refused([](PinholeCamera& c) { c.width_px = 0; }, {"camera", "width_px = 0", "[1, 16384]"});
  refused([](PinholeCamera& c) { c.height_px = -7; }, {"height_px = -7", "[1, 16384]"});
  refused([](PinholeCamera& c) { c.width_px = 2'000'000'000; }, {"width_px = 2000000000"});
  refused([](PinholeCamera& c) { c.width_px = 8193; }, {"8193 x 48 px", "[1, 8192]"});
  refused([](PinholeCamera& c) { c.height_px = 8193; }, {"64 x 8193 px", "[1, 8192]"});
  for (const double value : {0.0, -1.0, kNotANumber, kEndless}) {
    refused([=](PinholeCamera& c) { c.fx_px = value; }, {"fx_px = ", "positive and finite"});
    refused([=](PinholeCamera& c) { c.fy_px = value; }, {"fy_px = ", "positive and finite"});
  }
  for (const double value : {kNotANumber, kEndless, -kEndless}) {
    refused([=](PinholeCamera& c) { c.cx_px = value; }, {"cx_px = ", "finite"});
    refused([=](PinholeCamera& c) { c.cy_px = value; }, {"cy_px = ", "finite"});
  }
  const auto lens = [&](double k1) {
    return refusal([&](CameraRequest& r) {
      r.camera = CameraModel(pinhole(), {DistortionModel::kRadtan, {k1, 0.0, 0.0, 0.0, 0.0}});
    });
  };
  expect_parts(lens(kEndless), {"distortion coefficient 0 = inf", "finite"});
  expect_parts(lens(-2.0), {"radtan", "folds the image", "corner"});
}

TEST_F(RequestCheck, RefusesTimesAirAndVelocityByField) {
  const auto refused = [&](const Change& change, const std::vector<std::string>& parts) {
    expect_parts(refusal(change), parts);
  };
  const std::string time_limit = "[0, 1000000000]";
  refused([](CameraRequest& r) { r.exposure_ns = -1; }, {"exposure_ns = -1 ns", time_limit});
  refused([](CameraRequest& r) { r.readout_ns = 1'000'000'001; },
          {"readout_ns = 1000000001 ns", time_limit});
  refused([](CameraRequest& r) { r.readout_ns = std::numeric_limits<std::int64_t>::min(); },
          {"readout_ns = -9223372036854775808 ns", time_limit});
  for (const double value : {-1e-9, 1.5, kNotANumber, kEndless}) {
    refused([=](CameraRequest& r) { r.atmosphere.extinction_per_m = value; },
            {"extinction_per_m = ", "[0, 1]"});
  }
  for (std::size_t channel = 0; channel < 3; ++channel) {
    for (const float value : {-0.5F, 1.5F, std::nanf("")}) {
      refused([=](CameraRequest& r) { r.atmosphere.airlight_rgb[channel] = value; },
              {"airlight_rgb", std::to_string(value), "[0, 1]"});
    }
  }
  for (const double value : {10001.0, kNotANumber, -kEndless}) {
    refused([=](CameraRequest& r) { r.velocity_world_m_s.y() = value; },
            {"velocity_world_m_s = (", "[-10000, 10000]"});
  }
}

TEST_F(RequestCheck, RefusesPosesByField) {
  const auto refused = [&](const auto& change, const std::vector<std::string>& parts) {
    expect_parts(refusal_of_pose(change), parts);
  };
  for (int i = 0; i < 3; ++i) {
    for (const double value : {kNotANumber, kEndless}) {
      refused([=](Pose& p) { p.translation[i] = value; }, {"T_world_camera is not finite"});
      refused([=](Pose& p) { p.rotation.coeffs()[i] = value; }, {"T_world_camera is not finite"});
    }
    for (const double value : {1.1e6, 1e15, -1e300}) {
      refused([=](Pose& p) { p.translation[i] = value; },
              {"T_world_camera.translation = (", "[-1000000, 1000000]"});
    }
  }
  refused([](Pose& p) { p.rotation.coeffs() *= 2.0; }, {"rotation has norm 2", "must be 1"});
  refused([](Pose& p) { p.rotation.coeffs().setZero(); }, {"rotation has norm 0", "must be 1"});
  const double ground_m = ground_.ground_up_m(10.0, 20.0);
  refused([=](Pose& p) { p.translation.z() = ground_m - 1.5; },
          {"1.5", "below the ground", "at most 1"});
  // Any pose of a motion, not only the one at mid exposure.
  const std::string moving = refusal([&](CameraRequest& request) {
    Pose far = pose();
    far.translation.x() = 2e6;
    request.T_world_camera =
        CameraMotion::from_poses({{0, pose()}, {10, pose()}, {20, far}}).value();
  });
  expect_parts(moving, {"T_world_camera.translation = (2000000"});
}

TEST_F(RequestCheck, RefusesSceneViewsByField) {
  SceneView good;
  good.T_world_camera = pose();
  ASSERT_TRUE(camera_of(good).ok());
  EXPECT_NEAR(camera_of(good)->fy_px, 0.5 * good.height_px / std::tan(0.5 * good.fov_y_rad), 1e-9);
  const auto refused = [&](const auto& change, const std::vector<std::string>& parts) {
    SceneView view = good;
    change(view);
    const auto camera = camera_of(view);
    ASSERT_FALSE(camera.ok());
    EXPECT_EQ(camera.error().code, ErrorCode::kInvalidArgument);
    expect_parts(camera.error().message, parts);
  };
  refused([](SceneView& v) { v.width_px = 0; }, {"0 x 720 px", "[1, 8192]"});
  refused([](SceneView& v) { v.height_px = 9000; }, {"960 x 9000 px", "[1, 8192]"});
  for (const double fov_rad : {0.0, -1.0, 3.2, kNotANumber}) {
    refused([=](SceneView& v) { v.fov_y_rad = fov_rad; }, {"fov_y_rad", "(0, 180)"});
  }
  refused([](SceneView& v) { v.T_world_camera.translation.x() = kNotANumber; },
          {"T_world_camera is not finite"});
  refused([](SceneView& v) { v.T_world_camera.translation.x() = 1e12; },
          {"T_world_camera.translation", "[-1000000, 1000000]"});
}

TEST_F(RequestCheck, RowTimesRunFromTheFirstRowToTheLast) {
  CameraRequest request = CameraRequest::still(pinhole(), pose(), 1'000, PixelFormat::kGrey8);
  EXPECT_EQ(request.row_time_ns(0.0), 1'000);
  request.readout_ns = 470;  // 10 ns from row to row of 48
  EXPECT_EQ(request.row_time_ns(0.0), 765);
  EXPECT_EQ(request.row_time_ns(23.5), 1'000);
  EXPECT_EQ(request.row_time_ns(47.0), 1'235);
  EXPECT_EQ(request.row_time_ns(30.0) - request.row_time_ns(29.0), 10);
}

}  // namespace
}  // namespace overfly::renderer
