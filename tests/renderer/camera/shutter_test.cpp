// Motion blur and rolling shutter against their closed forms, on painted edges.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <vector>

#include "renderer/renderer.hpp"
#include "tests/renderer/procedural_ground.hpp"

namespace overfly::renderer {
namespace {

using overfly::testing::ProceduralGround;

constexpr double kShutterHeightM = 200.0;
constexpr double kShutterFocalPx = 350.0;
constexpr double kEdgesM = 50.0;  // between the painted edges
constexpr double kSoftM = 1.0;

/// The camera's top is the nose, which points north: image x grows to the east.
const PinholeCamera kCamera{641, 241, kShutterFocalPx, kShutterFocalPx, 320.0, 120.0};

/// Stripes from south to north whose edges lie at multiples of kEdgesM, soft enough for the place
/// of an edge between two pixels not to matter; level ground.
std::shared_ptr<ProceduralGround> striped_ground() {
  ProceduralGround::Options options;
  options.texel_m = 0.25;
  options.curved = false;
  options.paint = [](double east_m, double) {
    return 120.0 + 80.0 * std::tanh(std::sin(kPi * east_m / kEdgesM) * kEdgesM / (kPi * kSoftM));
  };
  return std::make_shared<ProceduralGround>(options);
}

Pose rolled_pose(double roll_rad, double east_m) {
  return {R_world_body_from({roll_rad, 0.0, 0.0}) * R_body_camera_nadir(),
          {east_m, 0.0, kShutterHeightM}};
}

/// The picture's change from pixel to pixel around a column, as a distribution: its mean is the
/// edge's place, its variance the edge's width squared.
struct Edge {
  double x_px = 0.0;
  double variance_px2 = 0.0;
};

Edge edge_near(const RadianceImage& image, int row, double x_px, int reach_px) {
  double sum = 0.0, first = 0.0, second = 0.0;
  const int middle = static_cast<int>(std::lround(x_px));
  for (int x = middle - reach_px; x < middle + reach_px; ++x) {
    const double step = image.at(x + 1, row) - image.at(x, row);
    sum += step;
    first += step * (x + 0.5);
    second += step * (x + 0.5) * (x + 0.5);
  }
  const double mean = first / sum;
  return {mean, second / sum - mean * mean};
}

class Shutter : public ::testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    const auto tiles = striped_ground();
    if (std::string(GetParam()) == "raycast") {
      renderer_ = create_raycast_renderer(tiles);
      return;
    }
    auto egl = create_egl_renderer(tiles);
    if (!egl.ok()) GTEST_SKIP() << "no EGL: " << egl.error().message;
    renderer_ = std::move(*egl);
  }

  /// Radiance, whose values are not rounded: far from an edge a step of one digital number would
  /// count.
  RadianceImage draw(const std::vector<StampedPose>& poses,
                     std::int64_t exposure_ns,
                     std::int64_t readout_ns) {
    CameraRequest request;
    request.camera = kCamera;
    request.T_world_camera = CameraMotion::from_poses(poses).value();
    request.t_ns = 50'000'000;
    request.exposure_ns = exposure_ns;
    request.readout_ns = readout_ns;
    request.format = PixelFormat::kGreyLinear;
    const auto frame = renderer_->render_camera(request);
    EXPECT_TRUE(frame.ok()) << frame.error().message;
    return frame.ok() ? frame->radiance : RadianceImage();
  }

  std::unique_ptr<Renderer> renderer_;
};

TEST_P(Shutter, StreaksAreSpeedTimesExposureTimesFocalLengthOverHeight) {
  for (const double speed_m_s : {25.0, 60.0}) {
    const auto flight = [&](double s) { return rolled_pose(0.0, speed_m_s * s); };
    const std::vector<StampedPose> poses{{0, flight(-0.05)}, {100'000'000, flight(0.05)}};
    for (const std::int64_t exposure_ns : {40'000'000LL, 100'000'000LL}) {
      const RadianceImage sharp = draw(poses, 0, 0);
      const RadianceImage blurred = draw(poses, exposure_ns, 0);
      const double expected_px =
          speed_m_s * 1e-9 * static_cast<double>(exposure_ns) * kShutterFocalPx / kShutterHeightM;
      const double before = edge_near(sharp, 120, 320.0, 30).variance_px2;
      const double after = edge_near(blurred, 120, 320.0, 30).variance_px2;
      // A box of length L has the variance L^2 / 12.
      const double length_px = std::sqrt(12.0 * (after - before));
      std::printf("[ STREAK   ] %s: %.2f px of %.2f\n", GetParam(), length_px, expected_px);
      EXPECT_NEAR(length_px, expected_px, 0.05 * expected_px);
    }
  }
}

TEST_P(Shutter, SkewIsRateTimesReadoutTimesFocalLengthAndGrowsOffTheAxis) {
  constexpr double kRateRadS = 0.6;
  constexpr std::int64_t kReadoutNs = 30'000'000;
  const std::vector<StampedPose> poses{{0, rolled_pose(-0.05 * kRateRadS, 0.0)},
                                       {100'000'000, rolled_pose(0.05 * kRateRadS, 0.0)}};
  const RadianceImage image = draw(poses, 0, kReadoutNs);
  for (const int edge : {0, 1, 2, 3, -3}) {
    const double x_px = kShutterFocalPx * kEdgesM * edge / kShutterHeightM;
    const double top_px = edge_near(image, 2, 320.0 + x_px, 24).x_px;
    const double bottom_px = edge_near(image, 238, 320.0 + x_px, 24).x_px;
    const double skew_px = std::abs(bottom_px - top_px) * 240.0 / 236.0;
    const double tangent = x_px / kShutterFocalPx;
    const double expected_px =
        kRateRadS * 1e-9 * kReadoutNs * kShutterFocalPx * (1.0 + tangent * tangent);
    std::printf("[ SKEW     ] %s, x / f = %.2f: %.2f px of %.2f\n",
                GetParam(),
                tangent,
                skew_px,
                expected_px);
    EXPECT_NEAR(skew_px, expected_px, 0.05 * expected_px);
  }
}

INSTANTIATE_TEST_SUITE_P(Renderers,
                         Shutter,
                         ::testing::Values("egl", "raycast"),
                         [](const auto& suite) { return std::string(suite.param); });

}  // namespace
}  // namespace overfly::renderer
