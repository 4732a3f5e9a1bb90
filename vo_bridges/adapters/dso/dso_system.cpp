// DSO (Engel, Koltun, Cremers 2018) through its library interface, without its file reader. Its
// settings and camera are globals: one system with one image size per process.
#include <FullSystem/FullSystem.h>
#include <util/ImageAndExposure.h>
#include <util/settings.h>

#include <algorithm>

#include "vo_bridges/adapters/dso/dso_publications.hpp"
#include "vo_bridges/adapters/dso/dso_settings.hpp"
#include "vo_bridges/adapters/scene_points.hpp"
#include "vo_bridges/adapters/stopwatch.hpp"
#include "vo_bridges/adapters/upstream_system.hpp"

namespace overfly_adapters {
namespace {

class DsoSystem : public UpstreamSystem {
 public:
  explicit DsoSystem(const Session& session)
      : session_(session),
        linearize_(flag_of(session.parameters, "linearizeOperation", session.lockstep)),
        restart_after_loss_(flag_of(session.parameters, "restart_after_loss")) {
    write_dso_settings(session);
    set_dso_camera(session.camera);
    start_over();
  }

  ParameterValues effective_parameters() override {
    ParameterValues values = read_dso_settings();
    values["mode"] = session_.parameters.at("mode");
    values["linearizeOperation"] = text_of_flag(system_->linearizeOperation);
    values["restart_after_loss"] = text_of_flag(restart_after_loss_);
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

 private:
  void start_over() {
    system_.reset();
    publications_.reset(new DsoPublications);
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
    // DSO's identifiers are int; frame numbers may exceed it.
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

  /// Active points observed from the pose: sets the depth and, on request, the map and an image of
  /// the points, red if near, blue if far (DSO draws its own image only at keyframes).
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
  // The system publishes during its destruction, so it is destroyed before its publications.
  std::unique_ptr<DsoPublications> publications_;
  std::unique_ptr<dso::FullSystem> system_;
  int frames_ = 0;
  unsigned map_id_ = 0;
  bool posed_ = false;  ///< the current map has given a pose
};

}  // namespace

std::unique_ptr<UpstreamSystem> create_upstream_system(const Session& session) {
  return std::unique_ptr<UpstreamSystem>(new DsoSystem(session));
}

}  // namespace overfly_adapters
