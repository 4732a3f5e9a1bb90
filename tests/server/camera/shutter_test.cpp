// What an open shutter and a row-wise readout make of known motions, from the flight's poses to
// the sensor's numbers, on both renderers.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <functional>

#include "server/camera/frame_maker.hpp"
#include "tests/renderer/procedural_ground.hpp"
#include "tests/server/support/server_fixture.hpp"

namespace overfly::server {
namespace {

using overfly::testing::ProceduralGround;
using testing::small_scenario;

constexpr double kHeightM = 100.0;
constexpr double kStampS = 1.0;  ///< of the frame that is looked at, the tenth

class Shutter : public ::testing::TestWithParam<const char*> {
 protected:
  /// A flight by a file of body poses every 10 ms for 2 s; nose to the north.
  Scenario flown(const std::function<Pose(double)>& T_world_body, const std::string& camera) {
    std::string text;
    for (int i = 0; i <= 200; ++i) {
      const Pose pose = T_world_body(0.01 * i);
      const Eigen::Vector3d& p = pose.translation;
      const Eigen::Quaterniond& q = pose.rotation;
      char line[256];
      std::snprintf(line,
                    sizeof line,
                    "%.2f %.12f %.12f %.12f %.15f %.15f %.15f %.15f\n",
                    0.01 * i,
                    p.x(),
                    p.y(),
                    p.z(),
                    q.x(),
                    q.y(),
                    q.z(),
                    q.w());
      text += line;
    }
    const auto file = folder_.path() / "flight.tum";
    overfly::testing::write_text(file, text);
    return small_scenario({R"(flight={"log":{"file":")" + file.string() + R"("}})",
                           "camera=" + camera,
                           std::string("renderer.camera=") + GetParam()});
  }

  /// The image at kStampS over painted flat ground, in linear numbers of 12 bit.
  Image16 image(const Scenario& scenario, const std::function<double(double, double)>& paint) {
    ProceduralGround::Options ground;
    ground.texel_m = 0.1;
    ground.curved = false;
    ground.paint = paint;
    FrameMakerOptions options;
    options.renderer_factory = [&](const auto&) {
      renderer::RendererOptions drawing;
      drawing.camera_backend = std::string(GetParam()) == "egl" ? renderer::CameraBackend::kEgl
                                                                : renderer::CameraBackend::kRaycast;
      return renderer::create_renderer(std::make_shared<ProceduralGround>(ground), drawing);
    };
    auto maker = FrameMaker::open(scenario, options);
    if (!maker) throw std::runtime_error(maker.error().message);
    auto made = (*maker)->make(std::llround(kStampS * scenario.rate.hz()));
    if (!made) throw std::runtime_error(made.error().message);
    if (!*made) throw std::runtime_error("the flight has ended");
    return std::move((*made)->shots.front().image16);
  }

  void SetUp() override {
    if (std::string(GetParam()) != "egl") return;
    const auto egl = renderer::create_egl_renderer(std::make_shared<ProceduralGround>(
        ProceduralGround::Options{.paint = [](double, double) { return 0.0; }}));
    if (!egl) GTEST_SKIP() << egl.error().message;
  }

 private:
  overfly::testing::TemporaryFolder folder_;
};

/// Standard deviation of the light along the image's y axis.
double spread_y_px(const Image16& image) {
  double sum = 0.0;
  double first = 0.0;
  double second = 0.0;
  for (int y = 0; y < image.height_px; ++y) {
    for (int x = 0; x < image.width_px; ++x) {
      const double light = image.at(x, y);
      sum += light;
      first += light * y;
      second += light * y * y;
    }
  }
  const double mean = first / sum;
  return std::sqrt(second / sum - mean * mean);
}

double dot(double east_m, double north_m) {
  return 250.0 * std::exp(-(east_m * east_m + north_m * north_m) / (2.0 * 0.4 * 0.4));
}

TEST_P(Shutter, StreakIsAsLongAsTheWayWhileItIsOpen) {
  const auto camera = [](double exposure_ms) {
    return R"({"width_px":200,"height_px":200,"fov_deg":30,"rate_hz":10,"bits":12,
               "sensor":{"motion_blur":true,"response":{"shape":"gamma","gamma":1},
                         "exposure_ms":)" +
           std::to_string(exposure_ms) + "}}";
  };
  const double f_px = 100.0 / std::tan(rad_from_deg(15.0));
  for (const double speed_m_s : {20.0, 45.0}) {
    const auto northward = [&](double t_s) {
      return Pose{R_world_body_from({}), {0.0, speed_m_s * (t_s - kStampS), kHeightM}};
    };
    const double still_px = spread_y_px(image(flown(northward, camera(0.001)), dot));
    for (const double exposure_ms : {20.0, 60.0}) {
      const double spread_px = spread_y_px(image(flown(northward, camera(exposure_ms)), dot));
      // An even streak of length L adds the variance L^2 / 12.
      const double length_px = std::sqrt(12.0 * (spread_px * spread_px - still_px * still_px));
      const double expected_px = speed_m_s * 1e-3 * exposure_ms * f_px / kHeightM;
      EXPECT_NEAR(length_px, expected_px, 0.05 * expected_px)
          << speed_m_s << " m/s, " << exposure_ms << " ms";
    }
  }
}

/// Slope of a bright line's centre over the rows, by least squares, times the image's height.
double skew_px(const Image16& image, double around_px) {
  constexpr int kHalf = 14;
  double n = 0.0;
  double sum_y = 0.0;
  double sum_x = 0.0;
  double sum_yy = 0.0;
  double sum_xy = 0.0;
  for (int y = 0; y < image.height_px; ++y) {
    double light = 0.0;
    double moment = 0.0;
    const int middle = static_cast<int>(std::lround(around_px));
    for (int x = middle - kHalf; x <= middle + kHalf; ++x) {
      light += image.at(x, y);
      moment += static_cast<double>(image.at(x, y)) * x;
    }
    const double centre = moment / light;
    n += 1.0;
    sum_y += y;
    sum_x += centre;
    sum_yy += static_cast<double>(y) * y;
    sum_xy += centre * y;
  }
  return (n * sum_xy - sum_x * sum_y) / (n * sum_yy - sum_y * sum_y) * (image.height_px - 1);
}

TEST_P(Shutter, RollSkewsByRateReadoutAndFocalLengthMoreTowardsTheEdges) {
  constexpr double kRateRadS = 0.8;
  constexpr double kReadoutS = 0.03;
  const double f_px = 200.0 / std::tan(rad_from_deg(42.436));
  const Scenario scenario = flown(
      [](double t_s) {
        return Pose{R_world_body_from({kRateRadS * (t_s - kStampS), 0.0, 0.0}),
                    {0.0, 0.0, kHeightM}};
      },
      R"({"width_px":400,"height_px":120,"fov_deg":84.872,"rate_hz":10,"bits":12,
          "sensor":{"readout_ms":30,"response":{"shape":"gamma","gamma":1}}})");
  const std::vector<double> places_m = {-75.0, -40.0, 0.0, 40.0, 75.0};
  // Lines to the north stay upright in the image under roll at every place.
  const Image16 rolled = image(scenario, [&](double east_m, double) {
    double value = 0.0;
    for (const double place_m : places_m) {
      const double off_m = (east_m - place_m) / 1.0;
      value += 250.0 * std::exp(-0.5 * off_m * off_m);
    }
    return std::min(value, 250.0);
  });
  for (const double place_m : places_m) {
    // Right wing down swings the axis to the left: x = f tan(theta + phi), and
    // dx / dphi = f (1 + x^2 / f^2).
    const double x_px = f_px * place_m / kHeightM;
    const double expected_px = kRateRadS * kReadoutS * f_px * (1.0 + x_px * x_px / (f_px * f_px));
    const double measured_px = skew_px(rolled, 199.5 + x_px);
    EXPECT_NEAR(measured_px, expected_px, 0.05 * expected_px) << "line at " << place_m;
  }
}

INSTANTIATE_TEST_SUITE_P(Renderers, Shutter, ::testing::Values("raycast", "egl"));

}  // namespace
}  // namespace overfly::server
