#include "server/scenario/document/flight/scenario_ros.hpp"

#include <chrono>
#include <cmath>
#include <string>
#include <vector>

#include "core/time.hpp"

namespace overfly::server {

Result<flight::ros_live::RosFlight> read_ros_flight(const nlohmann::json& ros) {
  const auto text = [&ros](const char* field) { return ros.at(field).get<std::string>(); };
  flight::ros_live::RosFlight flight;
  flight.master_uri = text("master_uri");
  flight.node_name = text("node_name");
  flight.pose_topic = text("pose_topic");
  flight.global_topic = text("global_topic");
  flight.imu_topic = text("imu_topic");
  flight.state_topic = text("state_topic");
  flight.sensor_topics = ros.at("sensor_topics").get<std::vector<std::string>>();
  flight.local = text("position") == "pose";
  flight.attitude_of_pose = text("attitude") == "pose";
  if (ros.contains("origin")) {
    if (!flight.local) {
      return Error{
          ErrorCode::kInvalidArgument,
          "flight.ros.origin: applies to position = \"pose\" only: positions of the global "
          "topic are latitude and longitude"};
    }
    const nlohmann::json& origin = ros.at("origin");
    flight.origin = geodetic_from_deg(origin.at("lat_deg").get<double>(),
                                      origin.at("lon_deg").get<double>(),
                                      origin.at("alt_ellipsoid_m").get<double>());
  }
  flight.gap_limit_ns = ns_from_s(ros.at("gap_limit_s").get<double>());
  flight.patience =
      std::chrono::milliseconds(std::llround(1e3 * ros.at("patience_s").get<double>()));
  flight.stop_on_disarm = ros.at("stop").at("on_disarm").get<bool>();
  return flight;
}

}  // namespace overfly::server
