#include "server/scenario/document/scenario_camera.hpp"

#include <cmath>
#include <set>
#include <utility>

#include "core/time.hpp"
#include "server/scenario/document/scenario_field.hpp"

namespace overfly::server {
namespace {

using Json = nlohmann::json;

Result<PinholeCamera> focal_lengths_from(const Json& camera, const std::string& path) {
  if (camera.contains("fov_deg") || camera.contains("fov_axis")) {
    return bad_field(path + ".fx_px",
                     camera.at("fx_px"),
                     "not be given with " + path + ".fov_deg or " + path + ".fov_axis");
  }
  PinholeCamera pinhole;
  pinhole.width_px = camera.at("width_px").get<int>();
  pinhole.height_px = camera.at("height_px").get<int>();
  pinhole.fx_px = camera.at("fx_px").get<double>();
  pinhole.fy_px = camera.at("fy_px").get<double>();
  pinhole.cx_px = camera.value("cx_px", 0.5 * (pinhole.width_px - 1));
  pinhole.cy_px = camera.value("cy_px", 0.5 * (pinhole.height_px - 1));
  if (Status valid = pinhole.validate(); !valid) return valid.error().in(path);
  return pinhole;
}

Result<PinholeCamera> pinhole_from(Json& camera, const std::string& path) {
  if (camera.contains("fx_px")) return focal_lengths_from(camera, path);
  constexpr double kPaperFovDeg = 84.872;
  if (!camera.contains("fov_deg")) camera["fov_deg"] = kPaperFovDeg;
  if (!camera.contains("fov_axis")) camera["fov_axis"] = "horizontal";
  const std::string axis_name = camera.at("fov_axis").get<std::string>();
  const FovAxis axis = axis_name == "vertical"   ? FovAxis::kVertical
                       : axis_name == "diagonal" ? FovAxis::kDiagonal
                                                 : FovAxis::kHorizontal;
  Result<PinholeCamera> made =
      PinholeCamera::from_fov(camera.at("width_px").get<int>(),
                              camera.at("height_px").get<int>(),
                              rad_from_deg(camera.at("fov_deg").get<double>()),
                              axis);
  if (!made) return made.error().in(path);
  return made;
}

Result<Distortion> distortion_from(const Json& lens, const std::string& path) {
  Distortion distortion;
  const std::string model = lens.at("model").get<std::string>();
  distortion.model = distortion_model_from(model).value_or(DistortionModel::kNone);
  const Json& values = lens.at("coefficients");
  const auto count = static_cast<std::size_t>(coefficient_count(distortion.model));
  // k3 of radtan may be omitted.
  const bool short_radtan = distortion.model == DistortionModel::kRadtan && values.size() == 4;
  if (values.size() != count && !short_radtan) {
    return bad_field(
        path + ".coefficients", values, "have " + std::to_string(count) + " values for " + model);
  }
  for (std::size_t i = 0; i < values.size(); ++i) distortion.k[i] = values[i].get<double>();
  return distortion;
}

Result<CameraModel> model_from(Json& camera, const std::string& path) {
  const Result<PinholeCamera> pinhole = pinhole_from(camera, path);
  if (!pinhole) return pinhole.error();
  Distortion distortion;
  if (camera.contains("distortion")) {
    Result<Distortion> read = distortion_from(camera.at("distortion"), path + ".distortion");
    if (!read) return read.error();
    distortion = *read;
  }
  CameraModel model(*pinhole, distortion);
  if (Status valid = model.validate(); !valid) return valid.error().in(path);
  return model;
}

renderer::Atmosphere atmosphere_from(const Json& air) {
  constexpr double kKoschmieder = 3.912;  // -ln 0.02: contrast at the meteorological visibility
  constexpr float kFullScale = 255.0F;
  renderer::Atmosphere atmosphere;
  atmosphere.extinction_per_m = kKoschmieder / (1000.0 * air.at("visibility_km").get<double>());
  for (std::size_t i = 0; i < atmosphere.airlight_rgb.size(); ++i) {
    atmosphere.airlight_rgb[i] = air.at("airlight_rgb")[i].get<float>() / kFullScale;
  }
  return atmosphere;
}

/// Checks a sensor against the frame period.
Status check_period(const Json& sensor, const std::string& path, const FrameRate& rate) {
  const double period_ms = 1e3 / rate.hz();
  const auto check = [&](const Json& value, const std::string& field) -> Status {
    if (value.get<double>() <= period_ms) return {};
    return bad_field(path + "." + field,
                     value,
                     "be at most the frame's period, " + Json(period_ms).dump() + " ms");
  };
  if (Status s = check(sensor.at("exposure_ms"), "exposure_ms"); !s) return s;
  if (Status s = check(sensor.at("readout_ms"), "readout_ms"); !s) return s;
  if (!sensor.contains("auto_exposure")) return {};
  return check(sensor.at("auto_exposure").at("max_exposure_ms"), "auto_exposure.max_exposure_ms");
}

Status read_sensor(const Json& camera,
                   const std::string& path,
                   const FrameRate& rate,
                   CameraSpec& spec) {
  const int bits = camera.at("bits").get<int>();
  if (!camera.contains("sensor")) {
    if (bits == 8) return {};
    return bad_field(path + ".bits", bits, "be 8 if " + path + ".sensor is not given");
  }
  const std::string place = path + ".sensor";
  if (Status s = check_period(camera.at("sensor"), place, rate); !s) return s;
  Result<sensor::SensorModel> sensor = sensor_from(camera.at("sensor"), place);
  if (!sensor) return sensor.error();
  spec.sensor = *sensor;
  spec.sensor.bits = bits;
  if (Status valid = spec.sensor.validate(); !valid) return valid.error().in(place);
  return {};
}

/// `true`, or an object with defaults.
std::optional<VirtualBoardCalibration> calibrated_from(const Json& camera,
                                                       const CameraModel& truth) {
  const auto asked = camera.find("calibrated");
  if (asked == camera.end() || *asked == false) return std::nullopt;
  const DistortionModel lens = truth.distortion().model;
  const bool wide = lens == DistortionModel::kEquidistant || lens == DistortionModel::kFov;
  VirtualBoardCalibration calibrated;
  calibrated.model = wide ? DistortionModel::kEquidistant : DistortionModel::kRadtan;
  if (!asked->is_object()) return calibrated;
  calibrated.model = distortion_model_from(asked->value("model", "")).value_or(calibrated.model);
  calibrated.views = asked->value("views", calibrated.views);
  return calibrated;
}

Result<CameraSpec> camera_spec_from(Json& camera, const std::string& path, const FrameRate& rate) {
  CameraSpec spec;
  spec.name = camera.at("name").get<std::string>();
  Result<CameraModel> model = model_from(camera, path);
  if (!model) return model.error();
  spec.model = *model;
  spec.calibrated = calibrated_from(camera, spec.model);
  const Result<Pose> mount = mount_from(camera.at("mount"), path + ".mount");
  if (!mount) return mount.error();
  spec.T_body_camera = *mount;
  spec.rgb = camera.at("color") == "rgb";
  if (camera.at("quality") == "reference") spec.quality = renderer::RenderQuality::kReference;
  if (camera.contains("atmosphere")) spec.atmosphere = atmosphere_from(camera.at("atmosphere"));
  if (Status status = read_sensor(camera, path, rate, spec); !status) return status.error();
  if (camera.contains("vibration")) {
    Result<sensor::VibrationModel> vibration =
        vibration_from(camera.at("vibration"), path + ".vibration");
    if (!vibration) return vibration.error();
    spec.vibration = *vibration;
  }
  return spec;
}

Status add_camera(Json& camera, const std::string& path, Scenario& scenario) {
  const Json& rate_hz = camera.at("rate_hz");
  const Result<FrameRate> rate = FrameRate::from_hz(rate_hz.get<double>());
  if (!rate) return rate.error().in(path);
  if (scenario.cameras.empty()) scenario.rate = *rate;
  if (rate->hz() != scenario.rate.hz()) {
    return bad_field(path + ".rate_hz",
                     rate_hz,
                     "be that of the first camera, " + Json(scenario.rate.hz()).dump());
  }
  Result<CameraSpec> spec = camera_spec_from(camera, path, *rate);
  if (!spec) return spec.error();
  for (const CameraSpec& other : scenario.cameras) {
    if (other.name == spec->name) return bad_field(path + ".name", spec->name, "be unique");
  }
  scenario.cameras.push_back(std::move(*spec));
  return {};
}

}  // namespace

Status read_cameras(Json& document, const FileResolver& files, Scenario& scenario) {
  scenario.cameras.clear();
  if (!document.contains("cameras")) {
    if (Status status = add_camera(document.at("camera"), "camera", scenario); !status) {
      return status;
    }
    return read_recorded_images(document, files, scenario);
  }
  if (document.contains("camera")) {
    return Error{ErrorCode::kInvalidArgument, "camera: must not be given with cameras"};
  }
  Json& cameras = document.at("cameras");
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    Status status = add_camera(cameras[i], "cameras." + std::to_string(i), scenario);
    if (!status) return status;
  }
  return read_recorded_images(document, files, scenario);
}

}  // namespace overfly::server
