#include "server/scenario/document/flight/scenario_flight.hpp"

#include <utility>

#include "core/motion/pose.hpp"
#include "server/scenario/document/scenario_field.hpp"

namespace overfly::server {
namespace {

using Json = nlohmann::json;

flight::smoothing::SmoothingOptions smoothing_from(const Json& smooth) {
  flight::smoothing::SmoothingOptions options;
  options.jump_m = smooth.at("jump_m").get<double>();
  options.jump_rad = rad_from_deg(smooth.at("jump_deg").get<double>());
  options.jerk_psd = smooth.at("jerk_psd_m2_s5").get<double>();
  options.angular_psd = smooth.at("angular_psd_rad2_s3").get<double>();
  const Json& board = smooth.at("board");
  // Roll, pitch and yaw of the board in the body are those of a body in north-east-down.
  const auto part = [&](const char* name, const Eigen::Vector3d& axis) {
    return Eigen::AngleAxisd(rad_from_deg(board.at(name).get<double>()), axis);
  };
  const Eigen::Quaterniond R_body_board = part("yaw_deg", Eigen::Vector3d::UnitZ()) *
                                          part("pitch_deg", Eigen::Vector3d::UnitY()) *
                                          part("roll_deg", Eigen::Vector3d::UnitX());
  options.R_logged_body = R_body_board.conjugate();
  return options;
}

Status read_rebase(const Json& rebase, LoggedFlight& flight) {
  flight::Rebase result;
  result.point = rebase.at("point") == "start" ? flight::Rebase::Point::kStart
                                               : flight::Rebase::Point::kCentre;
  result.lowest_agl_m = rebase.at("lowest_agl_m").get<double>();
  result.turn_rad = rad_from_deg(rebase.at("turn_deg").get<double>());
  const bool in_world = rebase.contains("east_m");
  const bool on_earth = rebase.contains("lat_deg");
  if (in_world && on_earth) {
    return bad_field(
        "flight.log.rebase.lat_deg", rebase.at("lat_deg"), "not be given with east_m and north_m");
  }
  if (in_world) {
    result.at =
        flight::PlaceInWorld{rebase.at("east_m").get<double>(), rebase.at("north_m").get<double>()};
  } else if (on_earth) {
    result.at = flight::PlaceOnEarth{rad_from_deg(rebase.at("lat_deg").get<double>()),
                                     rad_from_deg(rebase.at("lon_deg").get<double>())};
  }
  flight.rebase_to_imagery = !in_world && !on_earth;
  flight.log.rebase = result;
  return {};
}

Status read_times(const Json& log, flight::LogFlightOptions& options) {
  options.from_s = number_or_none(log, "from_s");
  options.to_s = number_or_none(log, "to_s");
  if (options.from_s && options.to_s && !(*options.from_s < *options.to_s)) {
    return bad_field("flight.log.to_s", log.at("to_s"), "be later than flight.log.from_s");
  }
  if (!log.contains("time_offset_s")) return {};
  const Json& offset = log.at("time_offset_s");
  if (offset.is_string() && !options.smooth) {
    return bad_field("flight.log.time_offset_s", offset, "be a number without flight.log.smooth");
  }
  if (offset.is_string()) {
    options.smooth->time_offset_s.reset();
  } else if (options.smooth) {
    options.smooth->time_offset_s = offset.get<double>();
  } else {
    options.time_offset_s = offset.get<double>();
  }
  return {};
}

}  // namespace

Result<LoggedFlight> logged_flight_from(Json& log, const FileResolver& files) {
  LoggedFlight flight;
  flight.file = files.resolve(log.at("file"));
  flight.camera_poses = log.at("camera_poses").get<bool>();
  for (const auto& [name, value] : log.items()) {
    if (name != "file" && name != "camera_poses") flight.log_fields.push_back(name);
  }
  flight.log.source = log.value("source", "");
  flight.log.geoid_separation_m = number_or_none(log, "geoid_separation_m");
  if (log.contains("smooth")) flight.log.smooth = smoothing_from(log.at("smooth"));
  if (Status status = read_times(log, flight.log); !status) return status.error();
  if (log.contains("rebase")) {
    if (Status status = read_rebase(log.at("rebase"), flight); !status) return status.error();
  }
  return flight;
}

}  // namespace overfly::server
