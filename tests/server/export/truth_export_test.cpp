// Truth images as OpenCV reads them, against closed forms and against each other.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <opencv2/imgcodecs.hpp>
#include <set>

#include "server/export/truth_writer.hpp"
#include "tests/server/export/export_fixture.hpp"

namespace overfly::server {
namespace {

namespace fs = std::filesystem;
using overfly::testing::read_text;
using overfly::testing::TemporaryFolder;
using testing::export_options;
using testing::exported;
using testing::read_picture;
using testing::read_points;
using testing::small_source;

struct Flow {
  int width = 0;
  int height = 0;
  std::vector<float> data;
  [[nodiscard]] Eigen::Vector2d at(int x, int y) const {
    const std::size_t i = 2 * (static_cast<std::size_t>(y) * width + x);
    return {data[i], data[i + 1]};
  }
};

/// As the Middlebury format is described: "PIEH", width, height, pairs of floats.
Flow read_flow(const fs::path& file) {
  const std::string bytes = read_text(file);
  Flow flow;
  if (bytes.size() < 12 || bytes.substr(0, 4) != "PIEH") {
    ADD_FAILURE() << file << " is no .flo file";
    return flow;
  }
  std::memcpy(&flow.width, bytes.data() + 4, 4);
  std::memcpy(&flow.height, bytes.data() + 8, 4);
  flow.data.resize((bytes.size() - 12) / 4);
  EXPECT_EQ(flow.data.size(), 2U * flow.width * flow.height);
  std::memcpy(flow.data.data(), bytes.data() + 12, bytes.size() - 12);
  return flow;
}

class TruthExport : public ::testing::Test {
 protected:
  void export_all(const std::vector<std::string>& overrides) {
    source_ = small_source(overrides);
    ExportOptions options = export_options(folder_.path() / "d", DatasetFormat::kPng);
    options.truth = {TruthKind::kDepth,
                     TruthKind::kRange,
                     TruthKind::kNormal,
                     TruthKind::kFlow,
                     TruthKind::kWorld,
                     TruthKind::kMask};
    exported(source_, options);
    frames_ = testing::frames_of(source_.scenario);
  }
  [[nodiscard]] fs::path file(const std::string& kind, int frame) const {
    char name[32];
    const char* ending = kind == "flow" ? "flo" : kind == "mask" ? "png" : "tif";
    std::snprintf(name, sizeof name, "%06d.%s", frame, ending);
    return folder_.path() / "d" / "truth" / kind / "camera0" / name;
  }
  [[nodiscard]] const CameraModel& camera() const { return source_.scenario.cameras.front().model; }
  [[nodiscard]] const CameraShot& shot(int frame) const {
    return frames_.at(static_cast<std::size_t>(frame)).shots.front();
  }

  TemporaryFolder folder_;
  ExportSource source_;
  std::vector<MadeFrame> frames_;
};

constexpr const char* kLens =
    R"(camera.distortion={"model":"radtan","coefficients":[-0.15,0.02,0.001,-0.001]})";

TEST_F(TruthExport, RangeAndWorldAreDepthAlongTheRay) {
  export_all({"duration_s=0.2", kLens});
  const cv::Mat depth = read_picture(file("depth", 1));
  const cv::Mat range = read_picture(file("range", 1));
  const cv::Mat world = read_points(file("world", 1));
  ASSERT_EQ(depth.type(), CV_32FC1);
  ASSERT_EQ(range.type(), CV_32FC1);
  ASSERT_EQ(world.type(), CV_64FC3);
  const Pose& T_world_camera = shot(1).drawn.T_world_camera;
  int ground = 0;
  for (int y = 0; y < depth.rows; y += 7) {
    for (int x = 0; x < depth.cols; x += 7) {
      const auto ray = camera().ray({x, y});
      const float z_m = depth.at<float>(y, x);
      if (!ray || !std::isfinite(z_m)) continue;
      ++ground;
      EXPECT_NEAR(range.at<float>(y, x), z_m * ray->norm(), 1e-4 * z_m);
      const auto& p = world.at<cv::Vec3d>(y, x);
      const Eigen::Vector3d expected = T_world_camera * (z_m * *ray);
      EXPECT_LT((Eigen::Vector3d(p[0], p[1], p[2]) - expected).norm(), 1e-6);
    }
  }
  EXPECT_GT(ground, 300);
}

TEST_F(TruthExport, HeightsAndNormalsAreThoseOfTheGround) {
  export_all({"duration_s=0.1"});
  const cv::Mat world = read_points(file("world", 0));
  const cv::Mat normal = cv::imread(file("normal", 0).string(), cv::IMREAD_UNCHANGED);
  const cv::Mat mask = read_picture(file("mask", 0));
  ASSERT_EQ(normal.type(), CV_32FC3);
  ASSERT_EQ(mask.type(), CV_8UC1);
  FrameMakerOptions making;
  making.renderer_factory = testing::noop_factory();
  const auto maker = FrameMaker::open(source_.scenario, making);
  ASSERT_TRUE(maker.ok());
  const terrain::TileSource& tiles = *(*maker)->world().tiles;
  int with_imagery = 0;
  for (int y = 0; y < world.rows; y += 5) {
    for (int x = 0; x < world.cols; x += 5) {
      const auto& p = world.at<cv::Vec3d>(y, x);
      const double e = p[0], n = p[1];
      // The drawn surface keeps within its screen-space error of the ground that is asked.
      EXPECT_NEAR(p[2], tiles.ground_up_m(e, n), 1.0);
      // OpenCV turns the order of the channels.
      const auto& drawn = normal.at<cv::Vec3f>(y, x);
      const Eigen::Vector3d up =
          Eigen::Vector3d(tiles.ground_up_m(e - 0.5, n) - tiles.ground_up_m(e + 0.5, n),
                          tiles.ground_up_m(e, n - 0.5) - tiles.ground_up_m(e, n + 0.5),
                          1.0)
              .normalized();
      EXPECT_LT((Eigen::Vector3d(drawn[2], drawn[1], drawn[0]) - up).norm(), 1e-5);
      with_imagery += mask.at<std::uint8_t>(y, x) == renderer::kMaskImagery;
    }
  }
  EXPECT_GT(with_imagery, 100);
}

TEST_F(TruthExport, FlowLeadsToTheSameGroundInTheNextImage) {
  export_all({"duration_s=0.3", kLens});
  for (const int k : {0, 2}) {
    const Flow flow = read_flow(file("flow", k));
    const cv::Mat world = read_points(file("world", k));
    const Pose T_next_world = shot(k + 1).drawn.T_world_camera.inverse();
    const Image& now = shot(k).image;
    const Image& next = shot(k + 1).image;
    int seen = 0;
    double warped_error = 0.0, still_error = 0.0;
    for (int y = 0; y < flow.height; ++y) {
      for (int x = 0; x < flow.width; ++x) {
        const Eigen::Vector2d motion = flow.at(x, y);
        if (motion.x() > 1e9) continue;  // "unknown": out of the image
        const auto& p = world.at<cv::Vec3d>(y, x);
        const auto there = camera().project(T_next_world * Eigen::Vector3d(p[0], p[1], p[2]));
        ASSERT_TRUE(there.has_value());
        EXPECT_LT((*there - Eigen::Vector2d(x, y) - motion).norm(), 1e-3) << x << ", " << y;
        const int left = static_cast<int>(there->x());
        const int top = static_cast<int>(there->y());
        if (left < 0 || top < 0 || left + 1 >= flow.width || top + 1 >= flow.height) continue;
        const double u = there->x() - left, v = there->y() - top;
        const double value =
            (1 - v) * ((1 - u) * next.at(left, top) + u * next.at(left + 1, top)) +
            v * ((1 - u) * next.at(left, top + 1) + u * next.at(left + 1, top + 1));
        warped_error += std::abs(value - now.at(x, y));
        still_error += std::abs(double(next.at(x, y)) - now.at(x, y));
        ++seen;
      }
    }
    ASSERT_GT(seen, flow.width * flow.height * 3 / 4);
    std::printf("[ FLOW     ] mean difference %.2f grey along the flow, %.2f without it\n",
                warped_error / seen,
                still_error / seen);
    EXPECT_LT(warped_error / seen, 0.4 * still_error / seen);
  }
  EXPECT_FALSE(fs::exists(file("flow", 3))) << "the last image has no next one";
}

TEST_F(TruthExport, RollingShutterHasATruthOfItsOwnInEveryRow) {
  export_all({"duration_s=0.2", R"(camera.sensor={"exposure_ms":1,"readout_ms":60})"});
  const cv::Mat world = read_points(file("world", 1));
  const cv::Mat depth = read_picture(file("depth", 1));
  const renderer::CameraRequest& request = shot(1).request;
  for (const int y : {0, 60, 119}) {
    const Pose T_world_camera = request.T_world_camera.at(request.row_time_ns(y));
    const auto ray = camera().ray({80, y});
    const Eigen::Vector3d expected = T_world_camera * (double(depth.at<float>(y, 80)) * *ray);
    const auto& p = world.at<cv::Vec3d>(y, 80);
    EXPECT_LT((Eigen::Vector3d(p[0], p[1], p[2]) - expected).norm(), 1e-6) << "row " << y;
  }
  // 25 m/s for 60 ms: the first and the last row were taken 1.5 m apart.
  const Pose first = request.T_world_camera.at(request.row_time_ns(0));
  const Pose last = request.T_world_camera.at(request.row_time_ns(119));
  EXPECT_NEAR((last.translation - first.translation).norm(), 1.5, 0.05);
}

TEST_F(TruthExport, IsNamedAsTheImagesAndLeftOutWithThem) {
  source_ = small_source(
      {"duration_s=0.5", R"(faults=[{"kind":"dropped_frames","at_s":0.15,"duration_s":0.1}])"});
  ExportOptions options = export_options(folder_.path() / "d", DatasetFormat::kKitti);
  options.truth = {TruthKind::kDepth, TruthKind::kFlow};
  exported(source_, options);
  const auto stems = [](const fs::path& folder) {
    std::set<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder)) {
      names.insert(entry.path().stem().string());
    }
    return names;
  };
  const fs::path root = folder_.path() / "d";
  const auto images = stems(root / "image_0");
  EXPECT_EQ(images.size(), 5U);
  EXPECT_EQ(stems(root / "truth" / "depth" / "camera0"), images);
  EXPECT_EQ(stems(root / "truth" / "flow" / "camera0").size(), 4U);
  // The flow over the lost image goes to the one that follows: twice as far.
  const double one = read_flow(root / "truth/flow/camera0/000000.flo").at(80, 60).norm();
  const double two = read_flow(root / "truth/flow/camera0/000001.flo").at(80, 60).norm();
  EXPECT_NEAR(two / one, 2.0, 0.1);
}

}  // namespace
}  // namespace overfly::server
