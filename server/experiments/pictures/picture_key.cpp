#include "server/experiments/pictures/picture_key.hpp"

#include <algorithm>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <span>
#include <variant>

#include "core/measure/sha256.hpp"

namespace overfly::server::experiments {
namespace {

using Json = nlohmann::json;

/// The exposure that acts on the picture, by motion blur, follows from the images before.
bool is_adaptive(const CameraSpec& camera) {
  return camera.sensor.enabled && camera.sensor.motion_blur && camera.sensor.auto_exposure;
}

bool is_noisy(const sensor::SensorModel& sensor) {
  return sensor.shot_noise || sensor.prnu > 0.0 || sensor.dsnu_e > 0.0 || sensor.read_noise_e > 0.0;
}

bool has_turbulence(const Scenario& scenario) {
  if (scenario.course_dynamics && scenario.course_dynamics->airframe.turbulence) return true;
  const auto* mission = std::get_if<ScenarioMission>(&scenario.flight);
  return mission != nullptr && mission->airframe.turbulence.has_value();
}

bool uses_seed(const Scenario& scenario) {
  return has_turbulence(scenario) ||
         std::any_of(
             scenario.cameras.begin(), scenario.cameras.end(), [](const CameraSpec& camera) {
               return camera.vibration.enabled || (is_adaptive(camera) && is_noisy(camera.sensor));
             });
}

/// Leaves what acts on the rendered light.
void reduce_camera(Json& document, const CameraSpec& camera) {
  for (const char* name : {"name", "calibrated"}) document.erase(name);
  if (is_adaptive(camera)) return;
  const sensor::SensorModel& sensor = camera.sensor;
  for (const char* name : {"sensor", "bits"}) document.erase(name);
  document["linear"] = sensor.enabled;
  if (!sensor.enabled) return;
  document["readout_s"] = sensor.readout_s;
  document["blur_s"] = sensor.motion_blur ? sensor.exposure_s : 0.0;
}

}  // namespace

std::string picture_key(const Scenario& scenario) {
  Json document = scenario.resolved;
  for (const char* name :
       {"$schema", "name", "title", "description", "estimators", "sensors", "recording"}) {
    document.erase(name);
  }
  if (std::none_of(scenario.cameras.begin(), scenario.cameras.end(), is_adaptive)) {
    document.erase("faults");
  }
  if (!uses_seed(scenario)) document.erase("seed");
  if (const auto camera = document.find("camera"); camera != document.end()) {
    reduce_camera(*camera, scenario.main_camera());
  } else if (const auto cameras = document.find("cameras"); cameras != document.end()) {
    const std::size_t known = std::min(cameras->size(), scenario.cameras.size());
    for (std::size_t i = 0; i < known; ++i) reduce_camera(cameras->at(i), scenario.cameras[i]);
  }
  const std::string text = document.dump();
  return sha256_hex({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
}

}  // namespace overfly::server::experiments
