// Recorded images of a camera.
#include <map>
#include <utility>

#include "core/time.hpp"
#include "server/scenario/document/scenario_camera.hpp"
#include "server/scenario/document/scenario_field.hpp"

namespace overfly::server {
namespace {

using Json = nlohmann::json;

Result<ImageClock> clock_from(const Json& images,
                              const std::string& path,
                              const Scenario& scenario) {
  static const std::map<std::string, ImageClock> kClocks = {
      {"flight", ImageClock::kFlight},
      {"utc", ImageClock::kUtc},
      {"log", ImageClock::kLog},
      {"first_image", ImageClock::kFirstImage}};
  const Json& name = images.at("clock");
  const ImageClock clock = kClocks.at(name.get<std::string>());
  if (clock == ImageClock::kUtc && !scenario.epoch_utc_ns) {
    return bad_field(path + ".clock", name, "be given together with epoch_utc_s");
  }
  if (clock == ImageClock::kLog && !std::holds_alternative<LoggedFlight>(scenario.flight)) {
    return bad_field(path + ".clock", name, "be given together with flight.log");
  }
  return clock;
}

/// Frames of the two cameras must show the same if the images agree.
Result<std::size_t> counterpart(const Json& name,
                                const std::string& path,
                                std::size_t camera,
                                const Scenario& scenario) {
  const CameraSpec& real = scenario.cameras[camera];
  for (std::size_t i = 0; i < scenario.cameras.size(); ++i) {
    const CameraSpec& other = scenario.cameras[i];
    if (i == camera || name != other.name) continue;
    const bool same_place =
        (other.T_body_camera.translation - real.T_body_camera.translation).norm() < 1e-9 &&
        rotation_angle_rad(other.T_body_camera.rotation, real.T_body_camera.rotation) < 1e-9;
    if (same_place && other.model == real.model) return i;
    return bad_field(path, name, "name a camera of the same model and mount");
  }
  return bad_field(path, name, "name another camera of the scenario");
}

Status read_images(Json& camera,
                   const std::string& path,
                   std::size_t index,
                   const FileResolver& files,
                   Scenario& scenario) {
  Json& images = camera.at("images");
  for (const char* field : {"sensor", "vibration", "atmosphere", "calibrated"}) {
    if (!camera.contains(field)) continue;
    return Error{ErrorCode::kInvalidArgument,
                 path + "." + field + ": must not be given with " + path + ".images"};
  }
  if (scenario.is_live()) {
    return Error{ErrorCode::kInvalidArgument,
                 path + ".images: recorded images do not belong to a live flight"};
  }
  if (camera.at("color") != "grey") {
    return bad_field(path + ".color", camera.at("color"), "be grey with " + path + ".images");
  }
  const std::string place = path + ".images";
  RecordedImages recorded;
  recorded.source = files.resolve(images.at("source"));
  recorded.topic = images.value("topic", "");
  if (images.contains("times")) recorded.times = files.resolve(images.at("times"));
  const Result<ImageClock> clock = clock_from(images, place, scenario);
  if (!clock) return clock.error();
  recorded.clock = *clock;
  recorded.time_offset_ns = ns_from_s(images.at("time_offset_s").get<double>());
  if (images.contains("compare_with")) {
    const Result<std::size_t> other =
        counterpart(images.at("compare_with"), place + ".compare_with", index, scenario);
    if (!other) return other.error();
    recorded.compare_with = *other;
  }
  scenario.cameras[index].images = std::move(recorded);
  return {};
}

}  // namespace

Status read_recorded_images(Json& document, const FileResolver& files, Scenario& scenario) {
  if (!document.contains("cameras")) {
    Json& camera = document.at("camera");
    return camera.contains("images") ? read_images(camera, "camera", 0, files, scenario) : Status();
  }
  Json& cameras = document.at("cameras");
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    if (!cameras[i].contains("images")) continue;
    const std::string path = "cameras." + std::to_string(i);
    if (scenario.recorded_camera() != nullptr) {
      return Error{ErrorCode::kInvalidArgument,
                   path + ".images: only one camera can have recorded images"};
    }
    if (Status status = read_images(cameras[i], path, i, files, scenario); !status) return status;
  }
  return {};
}

}  // namespace overfly::server
