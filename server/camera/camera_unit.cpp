#include "server/camera/camera_unit.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/time.hpp"
#include "server/camera/faults/lens_fault.hpp"

namespace overfly::server {
namespace {

/// Seed of one of a camera's random number streams.
std::uint64_t stream_seed(std::uint64_t seed, std::size_t camera, std::uint64_t stream) {
  constexpr std::uint64_t kGolden = 0x9E3779B97F4A7C15ULL;
  return (seed + kGolden * (2 * camera + stream + 1)) ^ (seed >> 32U);
}

/// The highest frequency of the mount's motion; 0 = it does not move.
double fastest_hz(const sensor::VibrationModel& model) {
  const auto any = [](const auto& values) {
    return std::any_of(values.begin(), values.end(), [](double v) { return v != 0.0; });
  };
  double f_hz = 0.0;
  if (any(model.noise_rotation_rms_rad) || any(model.noise_translation_rms_m)) {
    f_hz = model.noise_high_hz;
  }
  const std::size_t lines =
      std::max(model.engine_rotation_rms_rad.size(), model.engine_translation_rms_m.size());
  return std::max(f_hz, static_cast<double>(lines) * model.engine_rpm / 60.0);
}

renderer::PixelFormat format_of(const CameraSpec& spec) {
  using renderer::PixelFormat;
  if (spec.sensor.enabled) return spec.rgb ? PixelFormat::kRgbLinear : PixelFormat::kGreyLinear;
  return spec.rgb ? PixelFormat::kRgb8 : PixelFormat::kGrey8;
}

bool same(const Pose& a, const Pose& b) {
  return a.translation == b.translation && a.rotation.coeffs() == b.rotation.coeffs();
}

}  // namespace

Result<std::unique_ptr<CameraUnit>> CameraUnit::create(const CameraSpec& spec,
                                                       std::size_t index,
                                                       std::uint64_t seed) {
  const std::string what = "camera \"" + spec.name + "\"";
  std::unique_ptr<CameraUnit> unit(new CameraUnit(spec, stream_seed(seed, index, 0)));
  if (spec.sensor.enabled) {
    auto sensor = sensor::Sensor::create(spec.sensor, spec.model, unit->seed_);
    if (!sensor) return sensor.error().in(what + ": sensor");
    unit->sensor_ = std::move(*sensor);
  }
  if (spec.vibration.enabled) {
    auto vibration = sensor::MountVibration::create(spec.vibration, stream_seed(seed, index, 1));
    if (!vibration) return vibration.error().in(what + ": vibration");
    unit->vibration_ = std::move(*vibration);
  }
  unit->plan_window();
  return unit;
}

void CameraUnit::plan_window() {
  const sensor::SensorModel& sensor = spec_.sensor;
  if (!sensor.enabled) return;
  double longest_s = sensor.readout_s;
  if (sensor.motion_blur) {
    longest_s += sensor.auto_exposure ? sensor.auto_exposure->max_exposure_s : sensor.exposure_s;
  }
  half_window_ns_ = static_cast<std::int64_t>(std::ceil(0.5e9 * longest_s));
  constexpr double kSamplesPerPeriod = 10.0;
  const double f_hz = spec_.vibration.enabled ? fastest_hz(spec_.vibration) : 0.0;
  if (f_hz <= 0.0) return;
  raster_ns_ =
      std::clamp<std::int64_t>(std::llround(1e9 / (kSamplesPerPeriod * f_hz)), 1000, raster_ns_);
}

Pose CameraUnit::T_world_camera(const Pose& T_world_body, std::int64_t t_ns) const {
  const Pose T_world_mount = T_world_body * spec_.T_body_camera;
  return vibration_ ? T_world_mount * vibration_->T_mount_camera(t_ns) : T_world_mount;
}

std::optional<sensor::ExposureSetting> CameraUnit::next_setting() const {
  if (!sensor_) return std::nullopt;
  return sensor_->next_setting();
}

Result<renderer::CameraRequest> CameraUnit::request(
    const std::vector<AircraftState>& states,
    std::int64_t t_ns,
    const std::optional<sensor::ExposureSetting>& setting) const {
  std::vector<StampedPose> poses;
  poses.reserve(states.size());
  for (const AircraftState& state : states) {
    poses.push_back({state.t_ns, T_world_camera(state.T_world_body, state.t_ns)});
  }
  const AircraftState& middle = states[states.size() / 2];
  const Pose& T_middle = poses[poses.size() / 2].pose;
  const bool still =
      half_window_ns_ == 0 || std::all_of(poses.begin(), poses.end(), [&](const StampedPose& p) {
        return same(p.pose, T_middle);
      });
  renderer::CameraRequest request;
  request.camera = spec_.model;
  request.T_world_camera = CameraMotion(T_middle);
  if (!still) {
    Result<CameraMotion> motion = CameraMotion::from_poses(poses);
    if (!motion) return motion.error();
    request.T_world_camera = std::move(*motion);
  }
  request.t_ns = t_ns;
  if (spec_.sensor.enabled) {
    const sensor::ExposureSetting used = setting.value_or(sensor_->next_setting());
    request.exposure_ns = spec_.sensor.motion_blur ? used.exposure_ns : 0;
    request.readout_ns = ns_from_s(spec_.sensor.readout_s);
  }
  request.format = format_of(spec_);
  request.quality = spec_.quality;
  request.atmosphere = spec_.atmosphere;
  request.velocity_world_m_s = middle.v_body_world_m_s;
  return request;
}

Status CameraUnit::develop(renderer::CameraFrame drawn,
                           const FrameFaults& faults,
                           std::int64_t frame,
                           CameraShot& shot,
                           const std::optional<sensor::ExposureSetting>& setting) {
  if (sensor_) {
    RadianceImage radiance = std::move(drawn.radiance);
    for (const FaultSpec* fault : faults.on_lens) sensor::apply_fault(fault->image, radiance);
    sensor::SensorImage made;
    if (setting) {
      Result<sensor::SensorImage> exposed = exposed_with(*setting, radiance, frame);
      if (!exposed) return exposed.error();
      made = std::move(*exposed);
    } else {
      made = sensor_->expose(radiance, frame);
    }
    shot.image = std::move(made.image);
    shot.image16 = std::move(made.image16);
    shot.setting = made.setting;
    shot.saturated_fraction = made.saturated_fraction;
  } else {
    shot.image = faults.on_lens.empty() ? std::move(drawn.image)
                                        : with_lens_faults(drawn.image, faults.on_lens);
  }
  drawn.image = {};
  drawn.radiance = {};
  shot.drawn = std::move(drawn);
  if (setting || !keeps_last_) return {};
  if (faults.frozen && !last_image_.empty()) {
    shot.image = last_image_;
    shot.image16 = last_image16_;
  } else {
    last_image_ = shot.image;
    last_image16_ = shot.image16;
  }
  return {};
}

sensor::SensorModel CameraUnit::fixed_at(const sensor::ExposureSetting& setting) const {
  sensor::SensorModel model = spec_.sensor;
  model.gain_dn_per_e = model.effective_gain_dn_per_e() * setting.gain;
  model.exposure_s = s_from_ns(setting.exposure_ns);
  model.auto_exposure.reset();
  return model;
}

/// The noise is that of the frame.
Result<sensor::SensorImage> CameraUnit::exposed_with(const sensor::ExposureSetting& setting,
                                                     const RadianceImage& radiance,
                                                     std::int64_t frame) const {
  auto sensor = sensor::Sensor::create(fixed_at(setting), spec_.model, seed_);
  if (!sensor) return sensor.error();
  return (*sensor)->expose(radiance, frame);
}

Result<Image> CameraUnit::ideal(const Pose& T_world_camera,
                                std::int64_t t_ns,
                                std::int64_t frame,
                                const std::optional<sensor::ExposureSetting>& setting,
                                renderer::Renderer& renderer) const {
  auto request =
      renderer::CameraRequest::still(spec_.model, T_world_camera, t_ns, format_of(spec_));
  request.quality = spec_.quality;
  request.atmosphere = spec_.atmosphere;
  Result<renderer::CameraFrame> drawn = renderer.render_camera(request);
  if (!drawn) return drawn.error();
  if (!spec_.sensor.enabled) return std::move(drawn->image);
  sensor::SensorModel model =
      fixed_at(setting.value_or(sensor::ExposureSetting{ns_from_s(spec_.sensor.exposure_s), 1.0}));
  model.defocus_sigma_px = 0.0;
  model.vignette.reset();
  model.shot_noise = false;
  model.prnu = 0.0;
  model.dsnu_e = 0.0;
  model.read_noise_e = 0.0;
  auto sensor = sensor::Sensor::create(model, spec_.model, seed_);
  if (!sensor) return sensor.error();
  return std::move((*sensor)->expose(drawn->radiance, frame).image);
}

ShutterWindow ShutterWindow::of(const std::vector<std::unique_ptr<CameraUnit>>& cameras) {
  ShutterWindow window;
  for (const auto& camera : cameras) {
    window.half_ns = std::max(window.half_ns, camera->half_window_ns());
    window.raster_ns = std::min(window.raster_ns, camera->raster_ns());
  }
  return window;
}

}  // namespace overfly::server
