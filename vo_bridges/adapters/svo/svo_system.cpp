// SVO (Forster, Pizzoli, Scaramuzza 2014) through its library interface, without its ROS node.
#include <svo/config.h>
#include <svo/depth_filter.h>
#include <svo/feature.h>
#include <svo/frame.h>
#include <svo/frame_handler_mono.h>
#include <svo/map.h>
#include <svo/point.h>
#include <vikit/pinhole_camera.h>

#include <algorithm>
#include <cstdlib>
#include <stdexcept>

#include "vo_bridges/adapters/scene_points.hpp"
#include "vo_bridges/adapters/stopwatch.hpp"
#include "vo_bridges/adapters/upstream_system.hpp"

namespace overfly_adapters {
namespace {

/// Location of a parameter in SVO: global settings of the process.
struct Setting {
  std::size_t* whole;
  double* number;
  int* signed_whole;
};

std::map<std::string, Setting> settings() {
  using svo::Config;
  return {
      {"nPyrLevels", {&Config::nPyrLevels(), nullptr, nullptr}},
      {"gridSize", {&Config::gridSize(), nullptr, nullptr}},
      {"initMinDisparity", {nullptr, &Config::initMinDisparity(), nullptr}},
      {"initMinTracked", {&Config::initMinTracked(), nullptr, nullptr}},
      {"initMinInliers", {&Config::initMinInliers(), nullptr, nullptr}},
      {"kltMaxLevel", {&Config::kltMaxLevel(), nullptr, nullptr}},
      {"kltMinLevel", {&Config::kltMinLevel(), nullptr, nullptr}},
      {"reprojThresh", {nullptr, &Config::reprojThresh(), nullptr}},
      {"poseOptimThresh", {nullptr, &Config::poseOptimThresh(), nullptr}},
      {"poseOptimNumIter", {&Config::poseOptimNumIter(), nullptr, nullptr}},
      {"structureOptimMaxPts", {&Config::structureOptimMaxPts(), nullptr, nullptr}},
      {"structureOptimNumIter", {&Config::structureOptimNumIter(), nullptr, nullptr}},
      {"kfSelectMinDist", {nullptr, &Config::kfSelectMinDist(), nullptr}},
      {"triangMinCornerScore", {nullptr, &Config::triangMinCornerScore(), nullptr}},
      {"maxNKfs", {&Config::maxNKfs(), nullptr, nullptr}},
      {"maxFts", {&Config::maxFts(), nullptr, nullptr}},
      {"qualityMinFts", {&Config::qualityMinFts(), nullptr, nullptr}},
      {"qualityMaxFtsDrop", {nullptr, nullptr, &Config::qualityMaxFtsDrop()}},
  };
}

void write_settings(const ParameterValues& values) {
  for (const auto& named : settings()) {
    const double value = number_of(values, named.first);
    const Setting& setting = named.second;
    if (setting.whole != nullptr) *setting.whole = static_cast<std::size_t>(value);
    if (setting.number != nullptr) *setting.number = value;
    if (setting.signed_whole != nullptr) *setting.signed_whole = static_cast<int>(value);
  }
}

ParameterValues read_settings() {
  ParameterValues values;
  for (const auto& named : settings()) {
    const Setting& setting = named.second;
    const double value = setting.whole != nullptr    ? static_cast<double>(*setting.whole)
                         : setting.number != nullptr ? *setting.number
                                                     : static_cast<double>(*setting.signed_whole);
    values[named.first] = text_of_number(value);
  }
  return values;
}

/// For an odd width its image halving (vikit's halfSample) reads and writes beyond the image.
void check_size(const AdapterCamera& camera) {
  const std::size_t levels = std::max(svo::Config::nPyrLevels(), svo::Config::kltMaxLevel() + 1);
  const std::size_t divisor = std::size_t{1} << (levels - 1);
  if (static_cast<std::size_t>(camera.width_px) % divisor == 0) return;
  throw std::runtime_error(
      "frames of " + std::to_string(camera.width_px) + " x " + std::to_string(camera.height_px) +
      " px: SVO halves them " + std::to_string(levels - 1) +
      " times (nPyrLevels, kltMaxLevel) and would write beyond an image of an odd width; take a "
      "width that " +
      std::to_string(divisor) + " divides");
}

/// SVO writes its timings to a file with a fixed name, by default in /tmp: runs at the same time
/// would write to the same file.
void set_trace_folder() {
  const char* const folder = std::getenv("TMPDIR");
  if (folder != nullptr && *folder != '\0') svo::Config::traceDir() = folder;
}

std::unique_ptr<vk::PinholeCamera> camera_from(const AdapterCamera& camera) {
  std::vector<double> d = camera.distortion_coefficients;
  if (camera.distortion != "none" && camera.distortion != "radtan") {
    throw std::runtime_error("distortion " + camera.distortion +
                             ": must be none or radtan for this adapter");
  }
  d.resize(5, 0.0);
  return std::unique_ptr<vk::PinholeCamera>(new vk::PinholeCamera(camera.width_px,
                                                                  camera.height_px,
                                                                  camera.fx_px,
                                                                  camera.fy_px,
                                                                  camera.cx_px,
                                                                  camera.cy_px,
                                                                  d[0],
                                                                  d[1],
                                                                  d[2],
                                                                  d[3],
                                                                  d[4]));
}

class SvoSystem : public UpstreamSystem {
 public:
  explicit SvoSystem(const Session& session)
      : session_(session),
        depth_filter_thread_(flag_of(session.parameters, "depth_filter_thread", !session.lockstep)),
        restart_when_paused_(flag_of(session.parameters, "restart_when_paused")),
        camera_(camera_from(session.camera)) {
    write_settings(session.parameters);
    check_size(session.camera);
    set_trace_folder();
    handler_.reset(new svo::FrameHandlerMono(camera_.get()));
    // Without its thread the depth filter processes each frame immediately, so that results are
    // reproducible.
    if (!depth_filter_thread_) handler_->depthFilter()->stopThread();
    handler_->start();
  }

  ParameterValues effective_parameters() override {
    ParameterValues values = read_settings();
    values["depth_filter_thread"] = text_of_flag(depth_filter_thread_);
    values["restart_when_paused"] = text_of_flag(restart_when_paused_);
    return values;
  }

  AdapterAnswer track(const AdapterFrame& frame) override {
    // SVO pauses permanently if its two-view initialisation fails, until a key is pressed.
    if (handler_->stage() == svo::FrameHandlerBase::STAGE_PAUSED && restart_when_paused_) {
      handler_->start();
    }
    // SVO copies the image.
    const cv::Mat image(session_.camera.height_px,
                        session_.camera.width_px,
                        CV_8UC1,
                        const_cast<std::uint8_t*>(frame.pixels));
    const Stopwatch stopwatch;
    handler_->addImage(image, frame.t_s);
    const double wall_ms = stopwatch.wall_ms();
    const double cpu_ms = stopwatch.process_cpu_ms();
    AdapterAnswer answer;
    set_state(&answer);
    answer.timings_ms["track"] = wall_ms;
    answer.timings_ms["track_cpu"] = cpu_ms;
    answer.counters["features"] = static_cast<double>(handler_->lastNumObservations());
    answer.counters["keyframes"] = static_cast<double>(handler_->map().size());
    if (answer.state == AdapterState::kTracking) set_pose(&answer, frame.debug_wanted);
    if (frame.debug_wanted) answer.debug_image = debug_image(frame);
    return answer;
  }

 private:
  /// A pose is valid only in the default stage: during relocalisation it is frozen.
  void set_state(AdapterAnswer* answer) {
    switch (handler_->stage()) {
      case svo::FrameHandlerBase::STAGE_DEFAULT_FRAME:
        answer->state = AdapterState::kTracking;
        posed_ = true;
        break;
      case svo::FrameHandlerBase::STAGE_RELOCALIZING:
        answer->state = AdapterState::kLost;
        break;
      default:
        // Back in the initial stage: the previous map and its scale are gone.
        if (posed_) ++map_id_;
        posed_ = false;
        answer->state = AdapterState::kInitialising;
    }
    answer->map_id = map_id_;
  }

  void set_pose(AdapterAnswer* answer, bool debug_wanted) {
    const svo::FramePtr frame = handler_->lastFrame();
    const Sophus::SE3 T_vo_camera = frame->T_f_w_.inverse();
    const Eigen::Quaterniond rotation = T_vo_camera.unit_quaternion().normalized();
    for (int k = 0; k < 3; ++k) {
      answer->position_vo[static_cast<std::size_t>(k)] = T_vo_camera.translation()[k];
    }
    answer->orientation_xyzw = {{rotation.x(), rotation.y(), rotation.z(), rotation.w()}};
    std::vector<double> depths;
    for (const svo::Feature* feature : frame->fts_) {
      if (feature->point == nullptr) continue;
      const Eigen::Vector3d& p_vo = feature->point->pos_;
      depths.push_back(frame->w2f(p_vo).z());
      if (!debug_wanted) continue;
      answer->map_points_vo.push_back({{static_cast<float>(p_vo.x()),
                                        static_cast<float>(p_vo.y()),
                                        static_cast<float>(p_vo.z())}});
    }
    answer->scene_depth = median_depth(depths);
    answer->counters["inliers"] = static_cast<double>(depths.size());
  }

  /// SVO draws no debug image. Draws tracked features in green, those of the initialisation in
  /// yellow.
  RgbImage debug_image(const AdapterFrame& frame) const {
    RgbImage image = rgb_of(frame, session_.camera);
    const svo::FramePtr last = handler_->lastFrame();
    if (last != nullptr) {
      for (const svo::Feature* feature : last->fts_) {
        draw_square(&image, feature->px.x(), feature->px.y(), {{0, 220, 0}});
      }
    }
    if (handler_->stage() == svo::FrameHandlerBase::STAGE_SECOND_FRAME) {
      for (const cv::Point2f& pixel : handler_->initFeatureTrackCurPx()) {
        draw_square(&image, pixel.x, pixel.y, {{230, 220, 0}});
      }
    }
    return image;
  }

  Session session_;
  bool depth_filter_thread_;
  bool restart_when_paused_;
  std::unique_ptr<vk::PinholeCamera> camera_;
  std::unique_ptr<svo::FrameHandlerMono> handler_;
  unsigned map_id_ = 0;
  bool posed_ = false;  ///< the current map has given a pose
};

}  // namespace

std::unique_ptr<UpstreamSystem> create_upstream_system(const Session& session) {
  return std::unique_ptr<UpstreamSystem>(new SvoSystem(session));
}

}  // namespace overfly_adapters
