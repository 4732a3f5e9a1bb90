#include "server/net/stream/series_list.hpp"

#include <algorithm>
#include <span>
#include <string>
#include <utility>

#include "server/net/stream/row_encoder.hpp"

namespace overfly::net {
namespace {

using nlohmann::json;

struct Series {
  const char* column;
  const char* label;
  const char* unit;    ///< of the values as shown
  const char* group;   ///< series of one group share a plot
  double scale = 1.0;  ///< shown value = value of the column * scale
};

constexpr Series kPose[] = {{"x_m", "x (east)", "m", "x"},
                            {"y_m", "y (north)", "m", "y"},
                            {"z_m", "z (up)", "m", "z"},
                            {"roll_deg", "roll", "deg", "roll"},
                            {"pitch_deg", "pitch", "deg", "pitch"},
                            {"yaw_deg", "yaw", "deg", "yaw"}};

constexpr Series kImage[] = {
    {"texels_per_pixel", "texels per pixel", "texel/px", "texels_per_pixel"},
    {"void_fraction", "void", "%", "void", 100.0},
    {"exposure_ns", "exposure", "ms", "exposure", 1e-6},
    {"gain", "gain", "", "gain"},
    {"saturated_fraction", "saturated", "%", "saturated", 100.0},
    {"late_tiles", "late tiles", "", "late_tiles"},
    {"late_frames", "late frames", "frames", "late_frames"},
    {"stamp_offset_ns", "stamp offset", "ms", "stamp_offset", 1e-6}};

constexpr Series kEstimate[] = {
    {"error_m", "position error", "m", "position_error"},
    {"error_along_m", "error along the path", "m", "position_error_parts"},
    {"error_across_m", "error to the right", "m", "position_error_parts"},
    {"error_up_m", "error up", "m", "position_error_parts"},
    {"error_rotation_deg", "rotation error", "deg", "rotation_error"},
    {"error_scale_percent", "scale error over 100 m", "%", "scale_error"},
    {"error_relative_percent", "relative error over 100 m", "%", "relative_error"},
    {"error_relative_deg", "relative rotation over 100 m", "deg", "relative_rotation_error"},
    {"latency_ms", "latency", "ms", "latency"},
    {"dropped_frames", "dropped frames", "frames", "dropped_frames"},
    {"unanswered_frames", "unanswered frames", "frames", "unanswered_frames"}};

constexpr Series kHonesty[] = {{"nees_position", "NEES of the position", "", "nees"},
                               {"nees_low", "95 % band, low", "", "nees"},
                               {"nees_high", "95 % band, high", "", "nees"}};

constexpr Series kVehicle[] = {{"battery_v", "battery", "V", "battery_voltage"},
                               {"battery_percent", "battery", "%", "battery"},
                               {"satellites", "satellites", "", "satellites"},
                               {"messages_per_s", "messages", "1/s", "messages"},
                               {"lost_percent", "lost messages", "%", "lost_messages"},
                               {"clock_rate", "clock rate", "", "clock_rate"},
                               {"round_trip_ms", "round trip", "ms", "round_trip"}};

/// The unit that the name of a counter ends with, and the rest of the name as words.
std::pair<std::string, std::string> label_and_unit(const std::string& counter) {
  constexpr std::pair<const char*, const char*> kUnits[] = {{"_px", "px"},
                                                            {"_mb", "MB"},
                                                            {"_ms", "ms"},
                                                            {"_s", "s"},
                                                            {"_m", "m"},
                                                            {"_deg", "deg"},
                                                            {"_hz", "Hz"},
                                                            {"_percent", "%"}};
  std::string label = counter;
  std::string unit;
  for (const auto& [suffix, name] : kUnits) {
    if (!counter.ends_with(suffix) || counter.size() == std::string(suffix).size()) continue;
    label.resize(counter.size() - std::string(suffix).size());
    unit = name;
  }
  std::replace(label.begin(), label.end(), '_', ' ');
  return {label, unit};
}

void add(const std::string& stream, std::span<const Series> list, json* all) {
  for (const Series& series : list) {
    json entry = {{"stream", stream},
                  {"column", series.column},
                  {"label", series.label},
                  {"unit", series.unit},
                  {"group", series.group}};
    if (series.scale != 1.0) entry["scale"] = series.scale;
    all->push_back(std::move(entry));
  }
}

}  // namespace

json series_json(const server::RunTimeline& timeline) {
  json all = json::array();
  add("truth", kPose, &all);
  add("truth", kImage, &all);
  for (std::size_t i = 0; i < timeline.estimators().size(); ++i) {
    const std::string stream = "estimate/" + timeline.estimators()[i];
    add(stream, kPose, &all);
    add(stream, kEstimate, &all);
    if (timeline.states_covariances(i)) add(stream, kHonesty, &all);
    for (const std::string& counter : timeline.counter_names(i)) {
      const auto [label, unit] = label_and_unit(counter);
      all.push_back({{"stream", stream},
                     {"column", counter_column(counter)},
                     {"label", label},
                     {"unit", unit},
                     {"group", counter_column(counter)}});
    }
  }
  if (!timeline.vehicle_statuses(0, 1).empty()) add("vehicle", kVehicle, &all);
  return all;
}

}  // namespace overfly::net
