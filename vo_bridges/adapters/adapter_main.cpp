// An adapter: a separate program that connects an upstream library to the process protocol
// (docs/VO_PROTOCOL.md). Linked with one *_system.cpp. If the library calls exit() or abort(), this
// process ends, which the door reports as a crash.
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <stdexcept>
#include <string>

#include "vo_bridges/adapters/upstream_system.hpp"
#include "vo_bridges/client/overfly_vo.hpp"

namespace overfly_adapters {
namespace {

class Adapter : public overfly_vo::Estimator {
 public:
  std::string name() const override { return upstream_name(); }
  std::string version() const override { return OVERFLY_ADAPTER_VERSION; }

  overfly_vo::Parameters configure(const overfly_vo::Parameters& wanted) override {
    session_.parameters = upstream_parameters().resolve(wanted);
    asked_for_ = upstream_parameters().asked_for(wanted);
    session_.lockstep = lockstep();
    // Values chosen by the adapter are known once the system runs; calibrate() reports them.
    overfly_vo::Parameters in_force = decided(session_.parameters);
    const auto preset = wanted.find("preset");
    if (preset != wanted.end()) in_force["preset"] = preset->second;
    return in_force;
  }

  void calibrate(const overfly_vo::Calibration& calibration) override {
    if (system_ != nullptr) {
      throw std::runtime_error(name() +
                               " has one camera for the life of the process: another camera "
                               "needs another process");
    }
    AdapterCamera& camera = session_.camera;
    camera.width_px = calibration.width_px;
    camera.height_px = calibration.height_px;
    camera.fx_px = calibration.fx_px;
    camera.fy_px = calibration.fy_px;
    camera.cx_px = calibration.cx_px;
    camera.cy_px = calibration.cy_px;
    camera.distortion = calibration.distortion;
    camera.distortion_coefficients = calibration.distortion_coefficients;
    camera.rate_hz = calibration.rate_hz;
    system_ = create_upstream_system(session_);
    const ParameterValues effective = system_->effective_parameters();
    check_in_force(asked_for_, effective);
    tell_parameters(effective);
  }

  overfly_vo::Answer track(const overfly_vo::Frame& frame) override {
    const AdapterCamera& camera = session_.camera;
    if (frame.width_px != camera.width_px || frame.height_px != camera.height_px) {
      throw std::runtime_error(
          "frame " + std::to_string(frame.index) + " is " + std::to_string(frame.width_px) + " x " +
          std::to_string(frame.height_px) + " px: must be " + std::to_string(camera.width_px) +
          " x " + std::to_string(camera.height_px));
    }
    AdapterFrame given;
    given.index = frame.index;
    given.t_s = 1e-9 * static_cast<double>(frame.t_ns);
    given.exposure_ms = 1e-6 * static_cast<double>(frame.exposure_ns);
    given.pixels = frame.pixels;
    given.debug_wanted = frame.debug_wanted;
    return answer_from(system_->track(given));
  }

 private:
  static overfly_vo::Answer answer_from(AdapterAnswer from) {
    overfly_vo::Answer answer;
    switch (from.state) {
      case AdapterState::kInitialising:
        answer.state = overfly_vo::State::kInitialising;
        break;
      case AdapterState::kTracking:
        answer.state = overfly_vo::State::kTracking;
        break;
      case AdapterState::kLost:
        answer.state = overfly_vo::State::kLost;
        break;
    }
    answer.map_id = from.map_id;
    answer.position = from.position_vo;
    answer.quaternion_xyzw = from.orientation_xyzw;
    answer.scene_depth = from.scene_depth;
    answer.counters = std::move(from.counters);
    answer.timings_ms = std::move(from.timings_ms);
    answer.debug_image.width_px = from.debug_image.width_px;
    answer.debug_image.height_px = from.debug_image.height_px;
    answer.debug_image.pixels = std::move(from.debug_image.pixels);
    answer.map_points = std::move(from.map_points_vo);
    return answer;
  }

  Session session_;
  ParameterValues asked_for_;
  std::unique_ptr<UpstreamSystem> system_;
};

}  // namespace
}  // namespace overfly_adapters

int main() {
  static overfly_adapters::Adapter adapter;
  const int code = overfly_vo::run(adapter);
  // Threads of the library may still run, so exit without running destructors.
  std::fflush(nullptr);
  std::_Exit(code);
}
