#include "server/logs/log_info.hpp"

#include <algorithm>
#include <cstdio>

#include "core/time.hpp"

namespace overfly::server {
namespace {

using flight::logs::BootInfo;
using flight::logs::HeightDatum;
using flight::logs::LogEvent;
using flight::logs::OpenedLog;
using flight::logs::PositionKind;
using flight::logs::SourceOrigin;
using flight::logs::StreamInfo;
using OrderedJson = nlohmann::ordered_json;

/// Events that the text shows; --json has all.
constexpr std::size_t kShownEvents = 40;

std::string decimals(double value, int places) {
  char text[64];
  std::snprintf(text, sizeof text, "%.*f", places, value);
  return text;
}

std::string padded(std::string text, std::size_t width, bool right) {
  if (text.size() < width) text.insert(right ? 0 : text.size(), width - text.size(), ' ');
  return text;
}

std::string content_of(const StreamInfo& stream) {
  std::string content;
  const auto add = [&](const std::string& word) {
    content += (content.empty() ? "" : ", ") + word;
  };
  if (stream.positions > 0) {
    add(stream.georeferenced ? "position" : "position from an unknown origin");
  }
  if (stream.attitudes > 0) add("attitude");
  if (stream.description.imu) add("imu");
  if (stream.description.origin != SourceOrigin::kNone && !content.empty()) {
    content += std::string(" (") + to_string(stream.description.origin) + ")";
  }
  if (stream.invalid > 0) add(std::to_string(stream.invalid) + " invalid samples");
  return content;
}

std::string stream_line(const StreamInfo& stream, std::size_t name_width) {
  const bool timed = stream.first_ns.has_value();
  const std::string content = content_of(stream);
  return "  " + padded(stream.description.name, name_width, false) +
         padded(std::to_string(stream.messages), 10, true) +
         padded(stream.rate_hz > 0.0 ? decimals(stream.rate_hz, 2) : "-", 10, true) +
         padded(timed ? decimals(s_from_ns(*stream.first_ns), 1) : "-", 14, true) +
         padded(timed ? decimals(s_from_ns(*stream.last_ns), 1) : "-", 14, true) +
         padded(stream.gaps > 0 ? std::to_string(stream.gaps) : "-", 7, true) +
         (content.empty() ? "" : "  " + content) + "\n";
}

std::string event_line(const LogEvent& event) {
  return "  " + padded(event.time ? decimals(s_from_ns(event.time->t_ns), 3) : "-", 14, true) +
         "  " + (event.vehicle.empty() ? "" : event.vehicle + " ") + event.text + "\n";
}

OrderedJson stream_json(const StreamInfo& stream) {
  OrderedJson json{{"name", stream.description.name},
                   {"vehicle", stream.description.vehicle},
                   {"messages", stream.messages},
                   {"rate_hz", stream.rate_hz},
                   {"first_s", nullptr},
                   {"last_s", nullptr},
                   {"gaps", stream.gaps},
                   {"longest_gap_s", s_from_ns(stream.longest_gap_ns)},
                   {"backward", stream.backward},
                   {"imu", stream.description.imu}};
  if (stream.first_ns) {
    json["first_s"] = s_from_ns(*stream.first_ns);
    json["last_s"] = s_from_ns(*stream.last_ns);
  }
  if (stream.description.origin == SourceOrigin::kNone) return json;
  json["origin"] = to_string(stream.description.origin);
  json["positions"] = stream.positions;
  json["attitudes"] = stream.attitudes;
  json["invalid_samples"] = stream.invalid;
  if (stream.positions == 0) return json;
  json["georeferenced"] = stream.georeferenced;
  json["reach_m"] = stream.reach_m;
  const bool local = stream.description.position == PositionKind::kLocal;
  const std::string height = local ? "above_origin_m"
                             : stream.description.height == HeightDatum::kEllipsoid
                                 ? "alt_ellipsoid_m"
                                 : "alt_msl_m";
  json["lowest_" + height] = stream.lowest_m;
  json["highest_" + height] = stream.highest_m;
  json["jumps"] = stream.jumps;
  json["largest_jump_m"] = stream.largest_jump_m;
  return json;
}

std::string name_of(const OpenedLog& log, flight::logs::StreamId id) {
  return log.streams[id].description.name;
}

}  // namespace

std::string log_info_text(const OpenedLog& log) {
  std::string text = log.file.string() + ": " + to_string(log.format) + ", " +
                     decimals(static_cast<double>(log.size_bytes) * 1e-6, 1) + " MB, " +
                     std::to_string(log.streams.size()) + " streams\n";
  std::size_t width = 8;
  for (const StreamInfo& stream : log.streams) {
    width = std::max(width, stream.description.name.size());
  }
  text += "  " + padded("stream", width, false) + padded("messages", 10, true) +
          padded("Hz", 10, true) + padded("from s", 14, true) + padded("to s", 14, true) +
          padded("gaps", 7, true) + "  contents\n";
  for (const StreamInfo& stream : log.streams) {
    // Streams outside of the slice are not listed.
    if (stream.messages > 0 || log.slice.is_whole()) text += stream_line(stream, width);
  }
  if (!log.events.empty()) text += "events:\n";
  for (std::size_t i = 0; i < std::min(kShownEvents, log.events.size()); ++i) {
    text += event_line(log.events[i]);
  }
  if (log.events.size() > kShownEvents) {
    text += "  and " + std::to_string(log.events.size() - kShownEvents) + " more: see --json\n";
  }
  for (const std::string& warning : log.warnings) text += "warning: " + warning + "\n";
  if (!log.truth) return text;
  text += "truth: " + name_of(log, log.truth->position);
  if (!log.truth->attitude) {
    text += ", without any attitude";
  } else if (*log.truth->attitude != log.truth->position) {
    text += " with the attitude of " + name_of(log, *log.truth->attitude);
  }
  return text + ": " + log.truth->reason + "\n";
}

OrderedJson log_info_json(const OpenedLog& log) {
  OrderedJson json{{"file", log.file.string()},
                   {"format", to_string(log.format)},
                   {"size_bytes", log.size_bytes},
                   {"truth", nullptr},
                   {"on_ground", log.on_ground},
                   {"streams", OrderedJson::array()},
                   {"clock_runs", OrderedJson::array()},
                   {"events", OrderedJson::array()},
                   {"warnings", log.warnings}};
  for (const StreamInfo& stream : log.streams) {
    if (stream.messages > 0 || log.slice.is_whole()) json["streams"].push_back(stream_json(stream));
  }
  for (const BootInfo& boot : log.boots) {
    json["clock_runs"].push_back({{"vehicle", boot.vehicle},
                                  {"run", boot.number},
                                  {"first_s", s_from_ns(boot.first_ns)},
                                  {"last_s", s_from_ns(boot.last_ns)},
                                  {"messages", boot.messages}});
  }
  for (const LogEvent& event : log.events) {
    OrderedJson entry{{"t_s", nullptr}, {"kind", to_string(event.kind)}, {"text", event.text}};
    if (event.time) {
      entry["t_s"] = s_from_ns(event.time->t_ns);
      entry["run"] = event.time->boot;
    }
    if (!event.vehicle.empty()) entry["vehicle"] = event.vehicle;
    json["events"].push_back(std::move(entry));
  }
  if (log.truth) {
    json["truth"] = {{"position", name_of(log, log.truth->position)},
                     {"attitude", nullptr},
                     {"reason", log.truth->reason}};
    if (log.truth->attitude) json["truth"]["attitude"] = name_of(log, *log.truth->attitude);
  }
  return json;
}

}  // namespace overfly::server
