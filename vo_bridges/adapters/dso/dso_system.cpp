// DSO (Engel, Koltun, Cremers 2018) through its library's interface, without its reader of files.
// Its settings and its camera are globals: one system of one image size in a process.
#include <FullSystem/FullSystem.h>
#include <FullSystem/HessianBlocks.h>
#include <IOWrapper/Output3DWrapper.h>
#include <util/FrameShell.h>
#include <util/ImageAndExposure.h>
#include <util/globalCalib.h>
#include <util/settings.h>

#include <algorithm>
#include <cmath>
#include <mutex>
#include <stdexcept>

#include "vo_bridges/adapters/scene_points.hpp"
#include "vo_bridges/adapters/stopwatch.hpp"
#include "vo_bridges/adapters/upstream_system.hpp"

namespace overfly_adapters {
namespace {

using Points = std::vector<Eigen::Vector3d, Eigen::aligned_allocator<Eigen::Vector3d>>;

/// Takes what DSO publishes. In real time its mapping publishes from a thread of its own.
class Publications : public dso::IOWrap::Output3DWrapper {
 public:
  EIGEN_MAKE_ALIGNED_OPERATOR_NEW
  void begin_frame(int id) {
    const std::lock_guard<std::mutex> lock(mutex_);
    id_ = id;
    shell_ = nullptr;
  }

  void publishCamPose(dso::FrameShell* frame, dso::CalibHessian* /*calibration*/) override {
    const std::lock_guard<std::mutex> lock(mutex_);
    take_pose(frame);
  }

  void publishKeyframes(std::vector<dso::FrameHessian*>& frames,
                        bool final,
                        dso::CalibHessian* calibration) override {
    if (final) return;
    const std::lock_guard<std::mutex> lock(mutex_);
    points_vo_.clear();
    for (dso::FrameHessian* frame : frames) {
      add_points(*frame, calibration);
      // The frame that completes the start is a keyframe at once, without publishCamPose.
      if (shell_ == nullptr) take_pose(frame->shell);
    }
    keyframes_ = std::max(keyframes_, frames.empty() ? 0 : frames.back()->frameID + 1);
  }

  /// Of the frame that began; false without one. `current`: as mapping has refined it by now.
  bool pose(bool current, dso::SE3* T_vo_camera) const {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (shell_ == nullptr || !shell_->poseValid) return false;
    *T_vo_camera = current ? shell_->camToWorld : tracked_;
    return T_vo_camera->matrix().allFinite();
  }
  Points points_vo() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return points_vo_;
  }
  int keyframes() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return keyframes_;
  }

 private:
  void take_pose(dso::FrameShell* frame) {
    if (frame->incoming_id != id_) return;
    shell_ = frame;
    tracked_ = frame->camToWorld;
  }

  void add_points(const dso::FrameHessian& frame, dso::CalibHessian* calibration) {
    for (const dso::PointHessian* point : frame.pointHessians) {
      if (!(point->idepth_scaled > 0.0F)) continue;
      const double depth = 1.0 / static_cast<double>(point->idepth_scaled);
      const Eigen::Vector3d p_camera(
          depth * static_cast<double>((point->u - calibration->cxl()) / calibration->fxl()),
          depth * static_cast<double>((point->v - calibration->cyl()) / calibration->fyl()),
          depth);
      points_vo_.push_back(frame.shell->camToWorld * p_camera);
    }
  }

  mutable std::mutex mutex_;
  int id_ = -1;
  dso::FrameShell* shell_ = nullptr;  ///< of the frame that began; lives as long as its system
  dso::SE3 tracked_;
  Points points_vo_;
  int keyframes_ = 0;
};

/// As DSO's command line does for mode=N.
void set_photometric_mode(int mode) {
  dso::setting_photometricCalibration = mode == 0 ? 2 : 0;
  const std::array<float, 3> affine_a = {{1e12F, 0.0F, -1.0F}};
  const std::array<float, 3> affine_b = {{1e8F, 0.0F, -1.0F}};
  dso::setting_affineOptModeA = affine_a[static_cast<std::size_t>(mode)];
  dso::setting_affineOptModeB = affine_b[static_cast<std::size_t>(mode)];
  dso::setting_minGradHistAdd = mode == 2 ? 3.0F : 7.0F;
}

void write_settings(const Session& session) {
  const ParameterValues& values = session.parameters;
  // With its log it would begin by removing folders named logs and mats from where it runs.
  dso::setting_logStuff = false;
  dso::setting_debugout_runquiet = true;
  dso::disableAllDisplay = true;
  dso::multiThreading = flag_of(values, "multiThreading", !session.lockstep);
  // The mode first: what is asked for by name must not be overwritten by it.
  set_photometric_mode(static_cast<int>(number_of(values, "mode")));
  if (values.at("setting_minGradHistAdd") != "auto") {
    dso::setting_minGradHistAdd = static_cast<float>(number_of(values, "setting_minGradHistAdd"));
  }
  const auto number = [&](const char* name) { return static_cast<float>(number_of(values, name)); };
  const auto whole = [&](const char* name) { return static_cast<int>(number_of(values, name)); };
  dso::setting_minGradHistCut = number("setting_minGradHistCut");
  dso::setting_desiredImmatureDensity = number("setting_desiredImmatureDensity");
  dso::setting_desiredPointDensity = number("setting_desiredPointDensity");
  dso::setting_kfGlobalWeight = number("setting_kfGlobalWeight");
  dso::setting_minFrames = whole("setting_minFrames");
  dso::setting_maxFrames = whole("setting_maxFrames");
  dso::setting_maxOptIterations = whole("setting_maxOptIterations");
  dso::setting_minOptIterations = whole("setting_minOptIterations");
}

void set_camera(const AdapterCamera& camera) {
  if (camera.distortion != "none") {
    throw std::runtime_error("distortion " + camera.distortion +
                             ": DSO takes rectified images only (distortion none)");
  }
  Eigen::Matrix3f K = Eigen::Matrix3f::Identity();
  K(0, 0) = static_cast<float>(camera.fx_px);
  K(1, 1) = static_cast<float>(camera.fy_px);
  // Both have the centre of a pixel at whole numbers here: the half pixel that DSO takes off the
  // centre in calibration files (whose origin is the corner) must not be taken off again.
  K(0, 2) = static_cast<float>(camera.cx_px);
  K(1, 2) = static_cast<float>(camera.cy_px);
  dso::setGlobalCalib(camera.width_px, camera.height_px, K);
  if (dso::wG[0] != camera.width_px || dso::hG[0] != camera.height_px ||
      dso::benchmarkSetting_width != 0 || dso::benchmarkSetting_height != 0) {
    throw std::runtime_error("DSO has resized the frames from " + std::to_string(camera.width_px) +
                             " x " + std::to_string(camera.height_px) + " to " +
                             std::to_string(dso::wG[0]) + " x " + std::to_string(dso::hG[0]) +
                             ": the run's camera would not be the scenario's");
  }
  if (dso::pyrLevelsUsed < 3) {
    throw std::runtime_error("frames of " + std::to_string(camera.width_px) + " x " +
                             std::to_string(camera.height_px) +
                             " px: DSO needs 3 halvings without a"
                             " rest; take a size that 8 divides, and at least 160 x 120");
  }
}

class DsoSystem : public UpstreamSystem {
 public:
  explicit DsoSystem(const Session& session)
      : session_(session),
        linearize_(flag_of(session.parameters, "linearizeOperation", session.lockstep)),
        restart_after_loss_(flag_of(session.parameters, "restart_after_loss")) {
    write_settings(session);
    set_camera(session.camera);
    start_over();
  }

  ParameterValues effective_parameters() override {
    ParameterValues values;
    values["mode"] = session_.parameters.at("mode");
    values["linearizeOperation"] = text_of_flag(system_->linearizeOperation);
    values["multiThreading"] = text_of_flag(dso::multiThreading);
    values["restart_after_loss"] = text_of_flag(restart_after_loss_);
    const auto tell = [&](const char* name, double value) { values[name] = text_of_number(value); };
    tell("setting_minGradHistAdd", dso::setting_minGradHistAdd);
    tell("setting_minGradHistCut", single(dso::setting_minGradHistCut));
    tell("setting_desiredImmatureDensity", dso::setting_desiredImmatureDensity);
    tell("setting_desiredPointDensity", dso::setting_desiredPointDensity);
    tell("setting_kfGlobalWeight", single(dso::setting_kfGlobalWeight));
    tell("setting_minFrames", dso::setting_minFrames);
    tell("setting_maxFrames", dso::setting_maxFrames);
    tell("setting_maxOptIterations", dso::setting_maxOptIterations);
    tell("setting_minOptIterations", dso::setting_minOptIterations);
    tell("setting_photometricCalibration", dso::setting_photometricCalibration);
    tell("setting_affineOptModeA", dso::setting_affineOptModeA);
    tell("setting_affineOptModeB", dso::setting_affineOptModeB);
    tell("wG", dso::wG[0]);
    tell("hG", dso::hG[0]);
    tell("fxG", single(dso::fxG[0]));
    tell("fyG", single(dso::fyG[0]));
    tell("cxG", single(dso::cxG[0]));
    tell("cyG", single(dso::cyG[0]));
    return values;
  }

  AdapterAnswer track(const AdapterFrame& frame) override {
    const bool ended = system_->isLost ? restart_after_loss_ : system_->initFailed;
    if (ended) {
      if (posed_) ++map_id_;
      start_over();
    }
    const Stopwatch stopwatch;
    add_frame(frame);
    const double wall_ms = stopwatch.wall_ms();
    const double cpu_ms = stopwatch.process_cpu_ms();
    AdapterAnswer answer;
    answer.map_id = map_id_;
    answer.timings_ms["track"] = wall_ms;
    answer.timings_ms["track_cpu"] = cpu_ms;
    answer.counters["keyframes"] = publications_->keyframes();
    dso::SE3 T_vo_camera;
    if (system_->isLost) {
      answer.state = AdapterState::kLost;
    } else if (publications_->pose(linearize_, &T_vo_camera)) {
      answer.state = AdapterState::kTracking;
      posed_ = true;
      set_pose(T_vo_camera, &answer);
      see_points(T_vo_camera, frame, &answer);
    } else {
      answer.state = posed_ ? AdapterState::kLost : AdapterState::kInitialising;
    }
    if (frame.debug_wanted && answer.debug_image.pixels.empty()) {
      answer.debug_image = rgb_of(frame, session_.camera);
    }
    return answer;
  }

  void reset() override {
    start_over();
    map_id_ = 0;
  }

 private:
  /// A float as the decimal that it was read from, within its seven digits.
  static double single(float value) {
    const double scale = std::pow(10.0, 6.0 - std::floor(std::log10(std::fabs(value) + 1e-30)));
    return std::round(static_cast<double>(value) * scale) / scale;
  }

  void start_over() {
    system_.reset();
    publications_.reset(new Publications);
    system_.reset(new dso::FullSystem);
    system_->linearizeOperation = linearize_;
    if (dso::setting_photometricCalibration != 0) {
      std::array<float, 256> response;
      for (std::size_t i = 0; i < response.size(); ++i) response[i] = static_cast<float>(i);
      system_->setGammaFunction(response.data());
    }
    system_->outputWrapper.push_back(publications_.get());
    posed_ = false;
  }

  void add_frame(const AdapterFrame& frame) {
    dso::ImageAndExposure image(session_.camera.width_px, session_.camera.height_px, frame.t_s);
    const int count = image.w * image.h;
    std::copy(frame.pixels, frame.pixels + count, image.image);
    if (frame.exposure_ms > 0.0) image.exposure_time = static_cast<float>(frame.exposure_ms);
    // Its identifiers are int; ours may not be.
    publications_->begin_frame(++frames_);
    system_->addActiveFrame(&image, frames_);
  }

  static void set_pose(const dso::SE3& T_vo_camera, AdapterAnswer* answer) {
    const Eigen::Quaterniond rotation = T_vo_camera.unit_quaternion().normalized();
    for (int k = 0; k < 3; ++k) {
      answer->position_vo[static_cast<std::size_t>(k)] = T_vo_camera.translation()[k];
    }
    answer->orientation_xyzw = {{rotation.x(), rotation.y(), rotation.z(), rotation.w()}};
  }

  /// Active points seen from the pose: depth, and on demand the map and an image of them, red where
  /// near, blue where far (DSO's own image exists at keyframes only).
  void see_points(const dso::SE3& T_vo_camera, const AdapterFrame& frame, AdapterAnswer* answer) {
    const dso::SE3 T_camera_vo = T_vo_camera.inverse();
    const AdapterCamera& camera = session_.camera;
    Points seen_camera;
    std::vector<double> depths;
    for (const Eigen::Vector3d& p_vo : publications_->points_vo()) {
      const Eigen::Vector3d p_camera = T_camera_vo * p_vo;
      if (!(p_camera.z() > 0.0)) continue;
      const double x = camera.fx_px * p_camera.x() / p_camera.z() + camera.cx_px;
      const double y = camera.fy_px * p_camera.y() / p_camera.z() + camera.cy_px;
      if (x < 0.0 || y < 0.0 || x > camera.width_px - 1 || y > camera.height_px - 1) continue;
      seen_camera.push_back(Eigen::Vector3d(x, y, p_camera.z()));
      depths.push_back(p_camera.z());
      if (!frame.debug_wanted) continue;
      answer->map_points_vo.push_back({{static_cast<float>(p_vo.x()),
                                        static_cast<float>(p_vo.y()),
                                        static_cast<float>(p_vo.z())}});
    }
    answer->scene_depth = median_depth(depths);
    answer->counters["points"] = static_cast<double>(depths.size());
    if (!frame.debug_wanted) return;
    answer->debug_image = rgb_of(frame, camera);
    for (const Eigen::Vector3d& seen : seen_camera) {
      const double far = std::min(1.0, std::max(0.0, seen.z() / answer->scene_depth - 0.5));
      const auto blue = static_cast<std::uint8_t>(255.0 * far);
      draw_square(&answer->debug_image,
                  seen.x(),
                  seen.y(),
                  {{static_cast<std::uint8_t>(255 - blue), 60, blue}});
    }
  }

  Session session_;
  bool linearize_;
  bool restart_after_loss_;
  // The system publishes while it is destroyed: it goes first.
  std::unique_ptr<Publications> publications_;
  std::unique_ptr<dso::FullSystem> system_;
  int frames_ = 0;
  unsigned map_id_ = 0;
  bool posed_ = false;  ///< the map of now has given a pose
};

}  // namespace

std::unique_ptr<UpstreamSystem> create_upstream_system(const Session& session) {
  return std::unique_ptr<UpstreamSystem>(new DsoSystem(session));
}

}  // namespace overfly_adapters
