#include "server/net/stream/client_message.hpp"

#include <cmath>
#include <functional>
#include <optional>
#include <utility>

#include "core/motion/pose.hpp"
#include "server/net/http/json_text.hpp"
#include "server/net/stream/playback_clock.hpp"

namespace overfly::net {
namespace {

using nlohmann::json;

constexpr std::int64_t kMaxNs = std::int64_t{1} << 62;
constexpr std::int64_t kMaxFrame = std::int64_t{1} << 53;
constexpr std::size_t kMaxStreams = 64;

/// The time of a day, so that offsets cannot add up to more than 64 bits.
constexpr std::int64_t kMaxOffsetNs = 86'400'000'000'000;

ClientCommand read_watch(JsonFields* fields) {
  WatchCommand command;
  command.run_id = require_run(fields);
  command.offset_ns = fields->integer("offset_ns", -kMaxOffsetNs, kMaxOffsetNs);
  if (const json* resume = fields->object("resume")) {
    command.resume.emplace();
    JsonFields counts(*resume, "watch.resume");
    for (const auto& [name, value] : resume->items()) {
      const auto count = counts.integer(name, 0, kMaxFrame);
      (*command.resume)[name] = static_cast<std::size_t>(count.value_or(0));
    }
    if (const Status status = counts.finish(); !status) {
      fields->reject("resume", ": " + status.error().message);
    }
  }
  return command;
}

ClientCommand read_unwatch(JsonFields* fields) { return UnwatchCommand{require_run(fields)}; }

bool same_stream(const StreamRequest& a, const StreamRequest& b) {
  return a.run_id == b.run_id && a.name == b.name && a.camera == b.camera && a.view == b.view;
}

ClientCommand read_subscribe(JsonFields* fields) {
  SubscribeCommand command;
  command.acknowledges = fields->boolean("acknowledge").value_or(false);
  fields->require("pictures");
  const json* pictures = fields->array("pictures");
  if (pictures == nullptr) return command;
  if (pictures->size() > kMaxStreams) {
    fields->reject("pictures", ": must have at most " + std::to_string(kMaxStreams) + " entries");
    return command;
  }
  for (std::size_t i = 0; i < pictures->size(); ++i) {
    Result<StreamRequest> stream = read_stream((*pictures)[i], "pictures." + std::to_string(i));
    if (!stream) {
      fields->reject("pictures", ": " + stream.error().message);
      return command;
    }
    for (const StreamRequest& other : command.pictures) {
      if (same_stream(other, *stream)) {
        fields->reject("pictures",
                       ": " + stream->name + " of run " + stream->run_id + " occurs twice");
      }
    }
    command.pictures.push_back(std::move(*stream));
  }
  return command;
}

std::optional<server::SceneMode> read_mode(JsonFields* fields) {
  using server::SceneMode;
  static const std::map<std::string, SceneMode> kModes = {{"chase", SceneMode::kChase},
                                                          {"orbit", SceneMode::kOrbit},
                                                          {"top", SceneMode::kTop},
                                                          {"onboard", SceneMode::kOnboard},
                                                          {"free", SceneMode::kFree}};
  const auto mode = fields->text("mode");
  if (!mode) return std::nullopt;
  const auto known = kModes.find(*mode);
  if (known != kModes.end()) return known->second;
  fields->reject(
      "mode",
      " = \"" + *mode + "\": must be \"chase\", \"orbit\", \"top\", \"onboard\" or \"free\"");
  return std::nullopt;
}

/// What a scene shows: a list of names; the others are off.
std::optional<server::SceneShow> read_show(JsonFields* fields) {
  using Show = server::SceneShow;
  static const std::map<std::string, bool Show::*> kParts = {
      {"ribbons", &Show::ribbons},
      {"aircraft", &Show::aircraft},
      {"frustum", &Show::frustum},
      {"footprint", &Show::footprint},
      {"points", &Show::points},
      {"image", &Show::image},
      {"errors", &Show::errors},
      {"error_history", &Show::error_history},
      {"labels", &Show::labels}};
  const json* list = fields->array("show");
  if (list == nullptr) return std::nullopt;
  Show show;
  for (const auto& [name, part] : kParts) show.*part = false;
  for (const json& entry : *list) {
    const auto part = entry.is_string() ? kParts.find(entry.get<std::string>()) : kParts.end();
    if (part == kParts.end()) {
      fields->reject("show", ": " + to_text(entry) + " is no part of a scene");
      return std::nullopt;
    }
    show.*(part->second) = true;
  }
  return show;
}

ClientCommand read_shown(JsonFields* fields) {
  ShownCommand command;
  fields->require("pictures");
  const json* pictures = fields->array("pictures");
  if (pictures == nullptr) return command;
  if (pictures->size() > kMaxStreams) {
    fields->reject("pictures", ": must have at most " + std::to_string(kMaxStreams) + " entries");
    return command;
  }
  constexpr std::uint64_t kMost = 0xFFFFFFFFU;
  for (const json& entry : *pictures) {
    const auto number = [&](std::size_t at) { return entry[at].get<std::uint64_t>(); };
    if (!entry.is_array() || entry.size() != 2 || !entry[0].is_number_unsigned() ||
        !entry[1].is_number_unsigned() || number(0) > kMost || number(1) > kMost) {
      fields->reject("pictures", ": " + to_text(entry) + ": must be [stream, sequence]");
      return command;
    }
    command.pictures.emplace_back(static_cast<std::uint32_t>(number(0)),
                                  static_cast<std::uint32_t>(number(1)));
  }
  return command;
}

ClientCommand read_key(JsonFields* fields) {
  fields->require("id");
  return KeyCommand{static_cast<std::uint32_t>(fields->integer("id", 0, 0xFFFFFFFFLL).value_or(0))};
}

/// The viewpoint of the mode "free".
std::optional<Eigen::Vector3d> read_eye(JsonFields* fields) {
  // Beyond it neither the tangent frame nor a map projection describes the ground.
  constexpr double kMostM = 1e6;
  const auto x_m = fields->number("x_m", -kMostM, kMostM);
  const auto y_m = fields->number("y_m", -kMostM, kMostM);
  const auto z_m = fields->number("z_m", -kMostM, kMostM);
  if (!x_m && !y_m && !z_m) return std::nullopt;
  if (!x_m || !y_m || !z_m) {
    fields->reject("x_m", ": a viewpoint needs x_m, y_m and z_m");
    return std::nullopt;
  }
  return Eigen::Vector3d(*x_m, *y_m, *z_m);
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
  command.view = read_name(fields, "view");
  command.mode = read_mode(fields);
  command.azimuth_rad = read_angle_rad(fields, "azimuth_deg", -36000, 36000);
  command.elevation_rad = read_angle_rad(fields, "elevation_deg", -90, 90);
  command.distance_m = fields->number("distance_m", 5, 20000);
  command.follow = fields->boolean("follow");
  command.width_px = read_size_px(fields, "width_px", 1920);
  command.height_px = read_size_px(fields, "height_px", 1440);
  command.eye_world_m = read_eye(fields);
  command.show = read_show(fields);
  return command;
}

ClientCommand read_seek(JsonFields* fields) {
  SeekCommand command;
  command.t_ns = fields->integer("t_ns", -kMaxNs, kMaxNs);
  command.frame = fields->integer("frame", -kMaxFrame, kMaxFrame);
  command.run_id = read_name(fields, "run");
  if (command.t_ns.has_value() == command.frame.has_value()) {
    fields->reject("t_ns", ": either t_ns or frame must be given");
  } else if (command.t_ns && !command.run_id.empty()) {
    fields->reject("run", ": applies only to a frame; t_ns is the time of the clock");
  }
  return command;
}

ClientCommand read_step(JsonFields* fields) {
  fields->require("frames");
  return StepCommand{fields->integer("frames", -kMaxFrame, kMaxFrame).value_or(0),
                     read_name(fields, "run")};
}

ClientCommand read_speed(JsonFields* fields) {
  fields->require("value");
  const double value = fields->number("value", -kMaxSpeed, kMaxSpeed).value_or(1.0);
  if (std::abs(value) < kMinSpeed) {
    fields->reject("value", " = " + to_text(value) + ": must be at least 0.1, or at most -0.1");
  }
  return SpeedCommand{value};
}

ClientCommand read_range(JsonFields* fields) {
  const auto begin_ns = fields->integer("begin_ns", -kMaxNs, kMaxNs);
  const auto end_ns = fields->integer("end_ns", -kMaxNs, kMaxNs);
  RangeCommand command;
  if (!begin_ns && !end_ns) return command;
  if (!begin_ns || !end_ns || *begin_ns >= *end_ns) {
    fields->reject("end_ns", ": a range needs begin_ns and an end_ns after it");
    return command;
  }
  command.range = PlaybackClock::Range{*begin_ns, *end_ns};
  return command;
}

ClientCommand read_loop(JsonFields* fields) {
  fields->require("value");
  return LoopCommand{fields->boolean("value").value_or(false)};
}

ClientCommand read_align(JsonFields* fields) {
  fields->require("mode");
  return AlignCommand{require_run(fields), fields->text("mode").value_or("")};
}

template <typename Command>
ClientCommand read_plain(JsonFields* /*fields*/) {
  return Command{};
}

const std::map<std::string, std::function<ClientCommand(JsonFields*)>>& readers() {
  static const std::map<std::string, std::function<ClientCommand(JsonFields*)>> table = {
      {"watch", read_watch},
      {"unwatch", read_unwatch},
      {"subscribe", read_subscribe},
      {"shown", read_shown},
      {"key", read_key},
      {"view", read_view},
      {"play", read_plain<PlayCommand>},
      {"pause", read_plain<PauseCommand>},
      {"seek", read_seek},
      {"step", read_step},
      {"speed", read_speed},
      {"loop", read_loop},
      {"range", read_range},
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
