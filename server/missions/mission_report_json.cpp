#include "server/missions/mission_report_json.hpp"

#include <cmath>
#include <optional>

#include "core/motion/pose.hpp"

namespace overfly::server {
namespace {

using Json = nlohmann::json;

/// Rounded so that the text is short; null for what is not finite. @param step  a part of 1
Json number(double value, double step) {
  if (!std::isfinite(value)) return nullptr;
  const double parts = std::round(1.0 / step);
  return std::round(value * parts) / parts;
}
Json number(const std::optional<double>& value, double step) {
  return value ? number(*value, step) : Json(nullptr);
}
Json report_degrees(double angle_rad) { return number(deg_from_rad(angle_rad), 1e-8); }

Json pair_json(const Geodetic& place) {
  return Json::array({report_degrees(place.lat_rad), report_degrees(place.lon_rad)});
}

Json samples_json(const MissionReport& report) {
  Json columns = Json::object();
  const auto add = [&](const char* name, const Json& value) { columns[name].push_back(value); };
  for (const char* name : {"t_s",
                           "distance_m",
                           "lat_deg",
                           "lon_deg",
                           "alt_ellipsoid_m",
                           "ground_ellipsoid_m",
                           "height_agl_m",
                           "roll_deg",
                           "pitch_deg",
                           "yaw_deg",
                           "airspeed_m_s",
                           "ground_speed_m_s",
                           "climb_m_s",
                           "item",
                           "phase",
                           "overlap",
                           "texels_px",
                           "imagery",
                           "rotation_px",
                           "translation_px"}) {
    columns[name] = Json::array();
  }
  for (const MissionSample& sample : report.samples) {
    const autopilot::PreviewState& state = sample.state;
    add("t_s", number(state.t_s, 0.1));
    add("distance_m", number(sample.distance_m, 0.1));
    add("lat_deg", report_degrees(sample.place.lat_rad));
    add("lon_deg", report_degrees(sample.place.lon_rad));
    add("alt_ellipsoid_m", number(sample.place.alt_ellipsoid_m, 0.01));
    add("ground_ellipsoid_m", number(sample.place.alt_ellipsoid_m - sample.clearance_m, 0.01));
    add("height_agl_m", number(sample.clearance_m, 0.01));
    add("roll_deg", number(deg_from_rad(state.attitude.roll_rad), 0.01));
    add("pitch_deg", number(deg_from_rad(state.attitude.pitch_rad), 0.01));
    add("yaw_deg", number(deg_from_rad(state.attitude.yaw_rad), 0.01));
    add("airspeed_m_s", number(state.airspeed_m_s, 0.01));
    add("ground_speed_m_s", number(state.ground_speed_m_s, 0.01));
    add("climb_m_s", number(state.v_world_m_s.z(), 0.01));
    add("item", sample.item ? Json(*sample.item) : Json(nullptr));
    add("phase", autopilot::name_of(state.phase));
    add("overlap", number(sample.overlap, 0.01));
    add("texels_px", number(sample.texels_px, 0.001));
    add("imagery", number(sample.imagery, 0.01));
    add("rotation_px", number(sample.rotation_px, 0.01));
    add("translation_px", number(sample.translation_px, 0.01));
  }
  return columns;
}

Json places_json(const MissionReport& report) {
  Json places = Json::array();
  for (const MissionPlace& place : report.places) {
    places.push_back({{"item", place.number},
                      {"lat_deg", report_degrees(place.place.lat_rad)},
                      {"lon_deg", report_degrees(place.place.lon_rad)},
                      {"alt_ellipsoid_m", number(place.place.alt_ellipsoid_m, 0.01)},
                      {"ground_ellipsoid_m", number(place.ground_ellipsoid_m, 0.01)},
                      {"height_agl_m", number(place.height_agl_m, 0.01)},
                      {"height_above_home_m", number(place.height_above_home_m, 0.01)},
                      {"reached_s", number(place.reached_s, 0.1)},
                      {"turn_radius_m", number(place.turn_radius_m, 0.1)},
                      {"turn_bank_deg", number(place.turn_bank_deg, 0.1)}});
  }
  return places;
}

Json start_json(const std::optional<StartLeg>& start) {
  if (!start) return nullptr;
  return {{"from_s", number(start->from_s, 0.1)},
          {"to_s", number(start->to_s, 0.1)},
          {"length_m", number(start->length_m, 0.1)},
          {"height_agl_m", number(start->height_agl_m, 0.1)},
          {"baseline", number(start->baseline(), 0.001)},
          {"enough", start->enough}};
}

const char* name_of_end(autopilot::FlightEnd end) {
  switch (end) {
    case autopilot::FlightEnd::kMissionDone:
      return "done";
    case autopilot::FlightEnd::kLanded:
      return "landed";
    case autopilot::FlightEnd::kHitGround:
      return "hit_ground";
    case autopilot::FlightEnd::kTimeLimit:
      return "time_limit";
  }
  return "done";
}

}  // namespace

Json json_from(const MissionReport& report) {
  Json footprints = Json::array();
  for (const Footprint& footprint : report.footprints) {
    Json corners = Json::array();
    for (const Geodetic& corner : footprint.corners) corners.push_back(pair_json(corner));
    footprints.push_back({{"t_s", number(footprint.t_s, 0.1)}, {"corners", std::move(corners)}});
  }
  Json warnings = Json::array();
  for (const MissionWarning& warning : report.warnings) {
    warnings.push_back({{"kind", warning.kind},
                        {"text", warning.text},
                        {"from_s", number(warning.from_s, 0.1)},
                        {"to_s", number(warning.to_s, 0.1)},
                        {"item", warning.item ? Json(*warning.item) : Json(nullptr)},
                        {"value", number(warning.value, 0.001)},
                        {"limit", number(warning.limit, 0.001)}});
  }
  return {{"end", name_of_end(report.end)},
          {"duration_s", number(report.duration_s, 0.1)},
          {"distance_m", number(report.distance_m, 0.1)},
          {"roll_limit_deg", number(report.roll_limit_deg, 0.1)},
          {"camera", report.camera},
          {"samples", samples_json(report)},
          {"items", places_json(report)},
          {"footprints", std::move(footprints)},
          {"start", start_json(report.start)},
          {"warnings", std::move(warnings)}};
}

}  // namespace overfly::server
