#include "server/net/stream/stream_request.hpp"

#include <charconv>
#include <optional>
#include <system_error>
#include <utility>

namespace overfly::net {
namespace {

using nlohmann::json;

constexpr std::size_t kMaxNameBytes = 200;
/// As many runs as a viewer can watch.
constexpr std::size_t kMaxSceneRuns = 16;
constexpr std::int64_t kMaxColour = 1000;
constexpr std::size_t kMaxTracks = 64;  ///< of a run, with a look of their own

bool is_picture_stream(const std::string& name) {
  if (name == "camera" || name == "scene" || name == "depth" || name == "error") return true;
  const bool of_estimator = name.starts_with("debug/") || name.starts_with("error/");
  return of_estimator && name.size() > 6 && name.size() <= kMaxNameBytes;
}

/// Whether one of several cameras can be chosen for a stream.
bool has_camera(const std::string& name) {
  return name == "camera" || name == "depth" || name == "error";
}

/// "#rrggbb"; empty if it is none.
std::optional<server::TrackRgb> rgb_from(const json& text) {
  if (!text.is_string()) return std::nullopt;
  const auto& colour = text.get_ref<const std::string&>();
  if (colour.size() != 7 || colour.front() != '#') return std::nullopt;
  server::TrackRgb rgb{};
  for (std::size_t i = 0; i < rgb.size(); ++i) {
    const char* const begin = colour.data() + 1 + 2 * i;
    int value = 0;
    const auto [end, error] = std::from_chars(begin, begin + 2, value, 16);
    if (error != std::errc() || end != begin + 2 || value < 0) return std::nullopt;
    rgb.at(i) = static_cast<float>(value) / 255.0F;
  }
  return rgb;
}

/// `first_colour`, `hide` and `colours`.
server::TrackLook read_look(JsonFields* fields) {
  server::TrackLook look;
  look.first_colour =
      static_cast<std::size_t>(fields->integer("first_colour", 0, kMaxColour).value_or(0));
  const json* hide = fields->array("hide");
  const json* colours = fields->object("colours");
  if (hide != nullptr) {
    for (const json& name : *hide) {
      if (!name.is_string() || name.get_ref<const std::string&>().size() > kMaxNameBytes ||
          hide->size() > kMaxTracks) {
        fields->reject("hide", ": must be at most " + std::to_string(kMaxTracks) + " names");
        return look;
      }
      look.hidden.insert(name.get<std::string>());
    }
  }
  if (colours == nullptr) return look;
  for (const auto& [name, text] : colours->items()) {
    const auto rgb = rgb_from(text);
    if (!rgb || name.size() > kMaxNameBytes || colours->size() > kMaxTracks) {
      fields->reject("colours",
                     ": must be at most " + std::to_string(kMaxTracks) +
                         " names with colours like \"#1a2b3c\"");
      return look;
    }
    look.colours[name] = *rgb;
  }
  return look;
}

/// Other runs whose tracks a scene shows.
std::vector<SceneRun> read_with(JsonFields* fields) {
  std::vector<SceneRun> runs;
  const json* with = fields->array("with");
  if (with == nullptr) return runs;
  if (with->size() > kMaxSceneRuns) {
    fields->reject("with", ": must have at most " + std::to_string(kMaxSceneRuns) + " entries");
    return runs;
  }
  for (std::size_t i = 0; i < with->size(); ++i) {
    const std::string where = "with." + std::to_string(i);
    if (!(*with)[i].is_object()) {
      fields->reject(where, ": must be an object");
      return runs;
    }
    JsonFields entry((*with)[i], where);
    SceneRun run;
    run.run_id = require_run(&entry);
    run.look = read_look(&entry);
    if (const Status status = entry.finish(); !status) {
      fields->reject("with", ": " + status.error().message);
      return runs;
    }
    runs.push_back(std::move(run));
  }
  return runs;
}

}  // namespace

std::string read_name(JsonFields* fields, const char* field) {
  std::string name = fields->text(field).value_or("");
  if (name.size() > kMaxNameBytes) {
    fields->reject(field, ": must have at most " + std::to_string(kMaxNameBytes) + " bytes");
  }
  return name;
}

std::string require_run(JsonFields* fields) {
  fields->require("run");
  return read_name(fields, "run");
}

Result<StreamRequest> read_stream(const json& entry, const std::string& where) {
  if (!entry.is_object()) {
    return Error{ErrorCode::kInvalidArgument, where + ": must be an object"};
  }
  JsonFields fields(entry, where);
  StreamRequest stream;
  stream.run_id = require_run(&fields);
  fields.require("name");
  stream.name = fields.text("name").value_or("");
  if (!is_picture_stream(stream.name)) {
    fields.reject("name",
                  ": must be \"camera\", \"scene\", \"depth\", \"error\", \"error/NAME\" or "
                  "\"debug/NAME\"");
  }
  stream.camera = read_name(&fields, "camera");
  if (!stream.camera.empty() && !has_camera(stream.name)) {
    fields.reject("camera", ": applies only to the streams \"camera\", \"depth\" and \"error\"");
  }
  stream.view = read_name(&fields, "view");
  if (!stream.view.empty() && stream.name != "scene") {
    fields.reject("view", ": applies only to the stream \"scene\"");
  }
  stream.look = read_look(&fields);
  stream.with = read_with(&fields);
  stream.compared = read_name(&fields, "compared");
  if (stream.name != "scene") {
    for (const char* name : {"first_colour", "hide", "colours", "with", "compared"}) {
      if (entry.contains(name)) fields.reject(name, ": applies only to the stream \"scene\"");
    }
  }
  stream.max_hz = fields.number("max_hz", 0.1, 120.0).value_or(stream.max_hz);
  stream.quality = static_cast<int>(fields.integer("quality", 1, 100).value_or(stream.quality));
  stream.max_width_px =
      static_cast<int>(fields.integer("max_width_px", 16, 8192).value_or(stream.max_width_px));
  if (const auto encoding = fields.text("encoding")) {
    stream.video = *encoding == "vp8";
    if (!stream.video && *encoding != "jpeg") {
      fields.reject("encoding", " = \"" + *encoding + "\": must be \"jpeg\" or \"vp8\"");
    }
  }
  if (const Status status = fields.finish(); !status) return status.error();
  return stream;
}

}  // namespace overfly::net
