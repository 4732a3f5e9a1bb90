#include "server/net/stream/client_message.hpp"

#include <functional>
#include <utility>

#include "core/motion/pose.hpp"
#include "server/net/http/json_text.hpp"
#include "server/net/stream/playback_cursor.hpp"

namespace overfly::net {
namespace {

using nlohmann::json;

constexpr std::int64_t kMaxNs = std::int64_t{1} << 62;
constexpr std::int64_t kMaxFrame = std::int64_t{1} << 53;
constexpr std::size_t kMaxStreams = 16;
constexpr std::size_t kMaxNameBytes = 200;

ClientCommand read_attach(JsonFields* fields) {
  AttachCommand command;
  fields->require("run");
  command.run_id = fields->text("run").value_or("");
  if (const json* resume = fields->object("resume")) {
    JsonFields counts(*resume, "attach.resume");
    for (const auto& [name, value] : resume->items()) {
      const auto count = counts.integer(name, 0, kMaxFrame);
      command.resume[name] = static_cast<std::size_t>(count.value_or(0));
    }
    if (const Status status = counts.finish(); !status) {
      fields->reject("resume", ": " + status.error().message);
    }
  }
  return command;
}

bool is_picture_stream(const std::string& name) {
  if (name == "camera" || name == "scene") return true;
  return name.starts_with("debug/") && name.size() > 6 && name.size() <= kMaxNameBytes;
}

Result<StreamRequest> read_stream(const json& entry, const std::string& where) {
  if (!entry.is_object()) {
    return Error{ErrorCode::kInvalidArgument, where + ": must be an object"};
  }
  JsonFields fields(entry, where);
  StreamRequest stream;
  fields.require("name");
  stream.name = fields.text("name").value_or("");
  if (!is_picture_stream(stream.name)) {
    fields.reject("name", ": must be \"camera\", \"scene\" or \"debug/NAME\"");
  }
  stream.camera = fields.text("camera").value_or("");
  if (stream.camera.size() > kMaxNameBytes) fields.reject("camera", ": the name is too long");
  if (!stream.camera.empty() && stream.name != "camera") {
    fields.reject("camera", ": applies only to the stream \"camera\"");
  }
  stream.max_hz = fields.number("max_hz", 0.1, 120.0).value_or(stream.max_hz);
  stream.quality = static_cast<int>(fields.integer("quality", 1, 100).value_or(stream.quality));
  stream.max_width_px =
      static_cast<int>(fields.integer("max_width_px", 16, 8192).value_or(stream.max_width_px));
  if (const Status status = fields.finish(); !status) return status.error();
  return stream;
}

ClientCommand read_subscribe(JsonFields* fields) {
  SubscribeCommand command;
  fields->require("streams");
  const json* streams = fields->array("streams");
  if (streams == nullptr) return command;
  if (streams->size() > kMaxStreams) {
    fields->reject("streams", ": must have at most " + std::to_string(kMaxStreams) + " entries");
    return command;
  }
  for (std::size_t i = 0; i < streams->size(); ++i) {
    Result<StreamRequest> stream = read_stream((*streams)[i], "streams." + std::to_string(i));
    if (!stream) {
      fields->reject("streams", ": " + stream.error().message);
      return command;
    }
    for (const StreamRequest& other : command.streams) {
      if (other.name == stream->name && other.camera == stream->camera) {
        fields->reject("streams", ": " + stream->name + " occurs twice");
      }
    }
    command.streams.push_back(std::move(*stream));
  }
  return command;
}

std::optional<server::SceneMode> read_mode(JsonFields* fields) {
  const auto mode = fields->text("mode");
  if (!mode) return std::nullopt;
  if (*mode == "chase") return server::SceneMode::kChase;
  if (*mode == "orbit") return server::SceneMode::kOrbit;
  if (*mode == "top") return server::SceneMode::kTop;
  fields->reject("mode", " = \"" + *mode + "\": must be \"chase\", \"orbit\" or \"top\"");
  return std::nullopt;
}

std::optional<double> read_angle_rad(JsonFields* fields, const char* name, double min, double max) {
  const auto angle_deg = fields->number(name, min, max);
  return angle_deg ? std::optional<double>(rad_from_deg(*angle_deg)) : std::nullopt;
}

std::optional<int> read_size_px(JsonFields* fields, const char* name, int max) {
  const auto size_px = fields->integer(name, 64, max);
  return size_px ? std::optional<int>(static_cast<int>(*size_px)) : std::nullopt;
}

ClientCommand read_view(JsonFields* fields) {
  ViewCommand command;
  command.mode = read_mode(fields);
  command.azimuth_rad = read_angle_rad(fields, "azimuth_deg", -36000, 36000);
  command.elevation_rad = read_angle_rad(fields, "elevation_deg", -11, 90);
  command.distance_m = fields->number("distance_m", 5, 20000);
  command.follow = fields->boolean("follow");
  command.width_px = read_size_px(fields, "width_px", 1920);
  command.height_px = read_size_px(fields, "height_px", 1440);
  return command;
}

ClientCommand read_seek(JsonFields* fields) {
  SeekCommand command;
  command.t_ns = fields->integer("t_ns", -kMaxNs, kMaxNs);
  command.frame = fields->integer("frame", -kMaxFrame, kMaxFrame);
  if (command.t_ns.has_value() == command.frame.has_value()) {
    fields->reject("t_ns", ": either t_ns or frame must be given");
  }
  return command;
}

ClientCommand read_step(JsonFields* fields) {
  fields->require("frames");
  return StepCommand{fields->integer("frames", -kMaxFrame, kMaxFrame).value_or(0)};
}

ClientCommand read_speed(JsonFields* fields) {
  fields->require("value");
  return SpeedCommand{fields->number("value", kMinSpeed, kMaxSpeed).value_or(1.0)};
}

ClientCommand read_loop(JsonFields* fields) {
  fields->require("value");
  return LoopCommand{fields->boolean("value").value_or(false)};
}

ClientCommand read_align(JsonFields* fields) {
  fields->require("mode");
  return AlignCommand{fields->text("mode").value_or("")};
}

template <typename Command>
ClientCommand read_plain(JsonFields* /*fields*/) {
  return Command{};
}

const std::map<std::string, std::function<ClientCommand(JsonFields*)>>& readers() {
  static const std::map<std::string, std::function<ClientCommand(JsonFields*)>> table = {
      {"attach", read_attach},
      {"detach", read_plain<DetachCommand>},
      {"subscribe", read_subscribe},
      {"view", read_view},
      {"play", read_plain<PlayCommand>},
      {"pause", read_plain<PauseCommand>},
      {"seek", read_seek},
      {"step", read_step},
      {"speed", read_speed},
      {"loop", read_loop},
      {"live", read_plain<LiveCommand>},
      {"align", read_align}};
  return table;
}

Status read_command(const json& message, ClientCommand* command) {
  const auto type = message.find("type");
  if (type == message.end() || !type->is_string()) {
    return Error{ErrorCode::kInvalidArgument, "type: is required and must be a string"};
  }
  const auto reader = readers().find(type->get<std::string>());
  if (reader == readers().end()) {
    return Error{ErrorCode::kInvalidArgument, "type = " + to_text(*type) + ": is not a known type"};
  }
  JsonFields fields(message, reader->first);
  fields.allow("type");
  fields.integer("request", -kMaxFrame, kMaxFrame);
  *command = reader->second(&fields);
  return fields.finish();
}

}  // namespace

ClientMessage parse_client_message(const std::string& text) {
  ClientMessage parsed;
  const Result<json> message = parse_object(text, "the message");
  if (message) {
    JsonFields fields(*message, "");
    parsed.request = fields.integer("request", -kMaxFrame, kMaxFrame);
    parsed.status = read_command(*message, &parsed.command);
  } else {
    parsed.status = message.error();
  }
  return parsed;
}

}  // namespace overfly::net
