#include "server/record/run_manifest.hpp"

#include <utility>

#include "server/record/rows/run_rows.hpp"
#include "server/record/run_folder.hpp"

namespace overfly::server {
namespace {

using Json = nlohmann::json;
using Manifest = RunManifest;

Json text_or_null(const std::string& text) { return text.empty() ? Json(nullptr) : Json(text); }

void put_unless_empty(Json& object, const char* name, const std::string& text) {
  if (!text.empty()) object[name] = text;
}

Json renderer_json(const Manifest::Renderer& renderer) {
  Json value = {{"backend", renderer.backend},
                {"device", renderer.device},
                {"gl_version", renderer.gl_version},
                {"software", renderer.software}};
  put_unless_empty(value, "device_note", renderer.device_note);
  put_unless_empty(value, "camera_note", renderer.camera_note);
  return value;
}

Json file_json(const Manifest::WorldFile& file) {
  return {{"file", file.file}, {"digest", file.digest}};
}

Json world_json(const Manifest::World& world) {
  Json hashes = Json::array();
  for (const Manifest::WorldFile& file : world.data_hashes) hashes.push_back(file_json(file));
  Json value = {{"name", world.name},
                {"attribution", world.attribution},
                {"warnings", world.warnings},
                {"data_hashes", std::move(hashes)}};
  if (world.origin) {
    value["origin"] = {{"lat_deg", deg_from_rad(world.origin->lat_rad)},
                       {"lon_deg", deg_from_rad(world.origin->lon_rad)},
                       {"alt_ellipsoid_m", world.origin->alt_ellipsoid_m}};
  }
  if (world.manifest) value["manifest"] = file_json(*world.manifest);
  put_unless_empty(value, "light", world.light);
  put_unless_empty(value, "detail", world.detail);
  return value;
}

Json camera_json(const Manifest::Camera& camera) {
  Json value = json_from(camera.model);
  value["name"] = camera.name;
  value["rate_hz"] = camera.rate_hz;
  value["T_body_camera"] = json_from(camera.T_body_camera);
  value["color"] = camera.rgb ? "rgb" : "grey";
  value["bits"] = camera.bits;
  value["sensor"] = camera.sensor.has_value();
  if (camera.calibrated) value["calibrated"] = json_from(*camera.calibrated, camera.model);
  if (!camera.sensor) return value;
  value["readout_ns"] = camera.sensor->readout_ns;
  value["gain_dn_per_e"] = camera.sensor->gain_dn_per_e;
  value["adc_bits"] = camera.sensor->adc_bits;
  return value;
}

/// Field `camera`: pinhole model and mount of the main camera.
Json main_camera_json(const Manifest::Camera& camera) {
  Json value = json_from(camera.model.pinhole());
  value["rate_hz"] = camera.rate_hz;
  value["T_body_camera"] = json_from(camera.T_body_camera);
  return value;
}

Json estimator_json(const Manifest::Estimator& estimator) {
  Json value = {{"name", estimator.name},
                {"type", estimator.type},
                {"camera", estimator.camera},
                {"test_estimator", estimator.test_estimator}};
  put_unless_empty(value, "start_error", estimator.start_error);
  if (estimator.parameters) value["parameters"] = *estimator.parameters;
  if (estimator.parameters_at_end) value["parameters_at_end"] = *estimator.parameters_at_end;
  return value;
}

}  // namespace

Json json_from(const RunManifest& manifest) {
  Json estimators = Json::array();
  for (const Manifest::Estimator& estimator : manifest.estimators) {
    estimators.push_back(estimator_json(estimator));
  }
  Json value = {{"format_version", kRunFormatVersion},
                {"status", to_string(manifest.status)},
                {"error", text_or_null(manifest.error)},
                {"scenario", manifest.scenario},
                {"title", manifest.title},
                {"version", manifest.version},
                {"commit", manifest.commit},
                {"seed", manifest.seed},
                {"pacing", manifest.pacing},
                {"duration_ns", manifest.duration_ns},
                {"frames", manifest.frames},
                {"frames_total", manifest.frames_total},
                {"world", manifest.world ? world_json(*manifest.world) : Json::object()},
                {"estimators", std::move(estimators)}};
  if (manifest.texture_limited) value["texture_limited"] = true;
  if (manifest.epoch_utc_ns) value["epoch_utc_ns"] = *manifest.epoch_utc_ns;
  if (manifest.renderer) value["renderer"] = renderer_json(*manifest.renderer);
  if (manifest.flight) {
    value["flight"] = {{"description", manifest.flight->description},
                       {"warnings", manifest.flight->warnings}};
    if (manifest.flight->log_start_ns) {
      value["flight"]["log_start_ns"] = *manifest.flight->log_start_ns;
    }
  }
  if (manifest.cameras.empty()) return value;
  value["camera"] = main_camera_json(manifest.cameras.at(kMainCamera));
  Json cameras = Json::array();
  for (const Manifest::Camera& camera : manifest.cameras) cameras.push_back(camera_json(camera));
  value["cameras"] = std::move(cameras);
  return value;
}

void put_run_info(const RunInfo& info, RunManifest& manifest) {
  manifest.status = info.status;
  manifest.error = info.error;
  manifest.scenario = info.scenario;
  manifest.title = info.title;
  manifest.pacing = info.pacing;
  manifest.duration_ns = info.duration_ns;
  manifest.frames = info.frames;
  manifest.frames_total = info.frames_total;
  manifest.texture_limited = info.texture_limited;
}

void put_description(const RunManifest& manifest, RunInfo* info) {
  info->seed = manifest.seed;
  info->epoch_utc_ns = manifest.epoch_utc_ns;
  if (manifest.flight) info->flight = manifest.flight->description;
  if (!manifest.world) return;
  info->attribution = manifest.world->attribution;
  info->origin = manifest.world->origin;
}

RunInfo run_info_from(const RunManifest& manifest) {
  RunInfo info;
  info.status = manifest.status;
  info.error = manifest.error;
  info.scenario = manifest.scenario;
  info.title = manifest.title;
  info.pacing = manifest.pacing;
  info.duration_ns = manifest.duration_ns;
  info.frames = manifest.frames;
  info.frames_total = manifest.frames_total;
  info.texture_limited = manifest.texture_limited;
  for (const RunManifest::Estimator& estimator : manifest.estimators) {
    info.estimators.push_back(estimator.name);
    info.estimator_cameras.push_back(estimator.camera);
  }
  for (const RunManifest::Camera& camera : manifest.cameras) info.cameras.push_back(camera.name);
  put_description(manifest, &info);
  return info;
}

}  // namespace overfly::server
