// Parts of scenario_camera.hpp: sensor, vibration and mount.
#include <Eigen/Geometry>
#include <cmath>
#include <utility>

#include "server/scenario/document/scenario_camera.hpp"
#include "server/scenario/document/scenario_field.hpp"

namespace overfly::server {
namespace {

using Json = nlohmann::json;

Result<sensor::ResponseCurve> response_from(const Json& response, const std::string& path) {
  sensor::ResponseCurve curve;
  const std::string shape = response.at("shape").get<std::string>();
  curve.shape = sensor::response_shape_from(shape).value_or(sensor::ResponseShape::kSrgb);
  const auto belongs = [&](const char* field, const char* to) -> Status {
    if (response.contains(field) == (shape == to)) return {};
    if (shape != to) {
      return bad_field(path + "." + field, response.at(field), std::string("go with shape ") + to);
    }
    return Error{ErrorCode::kInvalidArgument,
                 path + "." + field + ": must be given with shape " + to};
  };
  if (Status s = belongs("gamma", "gamma"); !s) return s.error();
  if (Status s = belongs("table", "table"); !s) return s.error();
  if (shape == "gamma") curve.gamma = response.at("gamma").get<double>();
  if (shape == "table") curve.table = response.at("table").get<std::vector<double>>();
  return curve;
}

sensor::AutoExposure auto_exposure_from(const Json& automatic) {
  sensor::AutoExposure exposure;
  exposure.target_mean = automatic.at("target_mean").get<double>();
  exposure.min_exposure_s = 1e-3 * automatic.at("min_exposure_ms").get<double>();
  exposure.max_exposure_s = 1e-3 * automatic.at("max_exposure_ms").get<double>();
  exposure.max_gain = automatic.at("max_gain").get<double>();
  exposure.settle_frames = automatic.at("settle_frames").get<int>();
  return exposure;
}

std::vector<double> scaled(const Json& values, double factor) {
  std::vector<double> result;
  for (const Json& value : values) result.push_back(factor * value.get<double>());
  return result;
}

std::array<double, 3> scaled_xyz(const Json& values, double factor) {
  return {factor * values[0].get<double>(),
          factor * values[1].get<double>(),
          factor * values[2].get<double>()};
}

/// R_body_camera of a camera that looks along a body axis. The image's top points to the sky; for a
/// nadir camera to the nose.
Eigen::Quaterniond R_body_camera_facing(const std::string& facing) {
  if (facing == "nadir") return R_body_camera_nadir();
  // Forward: camera x (right) = body y, y (down) = body z, z = body x.
  Eigen::Matrix3d R_forward;
  R_forward << 0, 0, 1, 1, 0, 0, 0, 1, 0;
  const double yaw_rad = facing == "right"      ? 0.5 * kPi
                         : facing == "backward" ? kPi
                         : facing == "left"     ? -0.5 * kPi
                                                : 0.0;
  return Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ()) * Eigen::Quaterniond(R_forward);
}

/// Rotation of the camera by yaw, pitch and roll, in the aircraft's convention (intrinsic Z-Y-X).
Eigen::Quaterniond R_body_turned(const Json& mount) {
  const auto angle = [&](const char* field) { return rad_from_deg(mount.value(field, 0.0)); };
  return Eigen::AngleAxisd(angle("yaw_deg"), Eigen::Vector3d::UnitZ()) *
         Eigen::AngleAxisd(angle("pitch_deg"), Eigen::Vector3d::UnitY()) *
         Eigen::AngleAxisd(angle("roll_deg"), Eigen::Vector3d::UnitX());
}

}  // namespace

Result<sensor::SensorModel> sensor_from(const Json& sensor, const std::string& path) {
  sensor::SensorModel model;
  model.enabled = true;
  model.defocus_sigma_px = sensor.at("defocus_sigma_px").get<double>();
  if (sensor.contains("vignette")) {
    model.vignette = sensor::Vignette{scaled_xyz(sensor.at("vignette"), 1.0)};
  }
  model.exposure_s = 1e-3 * sensor.at("exposure_ms").get<double>();
  model.readout_s = 1e-3 * sensor.at("readout_ms").get<double>();
  model.motion_blur = sensor.at("motion_blur").get<bool>();
  model.electrons_per_s = sensor.at("electrons_per_s").get<double>();
  model.shot_noise = sensor.at("shot_noise").get<bool>();
  model.prnu = sensor.at("prnu").get<double>();
  model.dsnu_e = sensor.at("dsnu_e").get<double>();
  model.full_well_e = sensor.at("full_well_e").get<double>();
  model.read_noise_e = sensor.at("read_noise_e").get<double>();
  model.gain_dn_per_e = sensor.at("gain_dn_per_e").get<double>();
  model.black_level_dn = sensor.at("black_level_dn").get<double>();
  model.adc_bits = sensor.at("adc_bits").get<int>();
  if (sensor.contains("response")) {
    Result<sensor::ResponseCurve> response =
        response_from(sensor.at("response"), path + ".response");
    if (!response) return response.error();
    model.response = std::move(*response);
  }
  if (sensor.contains("auto_exposure")) {
    model.auto_exposure = auto_exposure_from(sensor.at("auto_exposure"));
  }
  return model;
}

Result<sensor::VibrationModel> vibration_from(const Json& vibration, const std::string& path) {
  sensor::VibrationModel model;
  model.enabled = true;
  model.engine_rpm = vibration.at("engine_rpm").get<double>();
  model.engine_rotation_rms_rad = scaled(vibration.at("engine_rotation_rms_mrad"), 1e-3);
  model.engine_translation_rms_m = scaled(vibration.at("engine_translation_rms_mm"), 1e-3);
  model.noise_rotation_rms_rad = scaled_xyz(vibration.at("noise_rotation_rms_mrad"), 1e-3);
  model.noise_translation_rms_m = scaled_xyz(vibration.at("noise_translation_rms_mm"), 1e-3);
  model.noise_low_hz = vibration.at("noise_low_hz").get<double>();
  model.noise_high_hz = vibration.at("noise_high_hz").get<double>();
  model.mount_natural_hz = vibration.at("mount_natural_hz").get<double>();
  model.mount_damping = vibration.at("mount_damping").get<double>();
  if (Status valid = model.validate(); !valid) return valid.error().in(path);
  return model;
}

Result<Pose> mount_from(const Json& mount, const std::string& path) {
  const Json& p = mount.at("p_body_m");
  Pose T_body_camera;
  T_body_camera.translation = {p[0].get<double>(), p[1].get<double>(), p[2].get<double>()};
  if (!mount.contains("q_xyzw")) {
    T_body_camera.rotation =
        R_body_turned(mount) * R_body_camera_facing(mount.value("facing", "nadir"));
    return T_body_camera;
  }
  for (const char* field : {"facing", "roll_deg", "pitch_deg", "yaw_deg"}) {
    if (!mount.contains(field)) continue;
    return bad_field(path + "." + field, mount.at(field), "not be given with " + path + ".q_xyzw");
  }
  const Json& q = mount.at("q_xyzw");
  T_body_camera.rotation = Eigen::Quaterniond(
      q[3].get<double>(), q[0].get<double>(), q[1].get<double>(), q[2].get<double>());
  constexpr double kNormTolerance = 1e-3;  // numbers are rounded to three digits or more
  if (std::abs(T_body_camera.rotation.norm() - 1.0) > kNormTolerance) {
    return bad_field(path + ".q_xyzw", q, "have length 1");
  }
  T_body_camera.rotation.normalize();
  return T_body_camera;
}

}  // namespace overfly::server
