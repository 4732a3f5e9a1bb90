#include "middleware/ros1/findings.hpp"

#include <ros/common.h>

#include <cstdlib>

#include "middleware/ros1/master.hpp"

namespace overfly::ros1 {
namespace {

std::string variable(const char* name) {
  const char* value = std::getenv(name);
  return value != nullptr ? value : "";
}

}  // namespace

bool is_built_in() { return true; }

Findings findings() {
  Findings found{true,
                 true,
                 "built in (ROS " + std::to_string(ROS_VERSION_MAJOR) + "." +
                     std::to_string(ROS_VERSION_MINOR) + "." + std::to_string(ROS_VERSION_PATCH) +
                     "); ",
                 ""};
  std::string uri = variable("ROS_MASTER_URI");
  const bool named = !uri.empty();
  if (!named) uri = "http://127.0.0.1:11311";
  const auto master = parse_xml_rpc_address(uri);
  if (!master) {
    found.works = false;
    found.finding += "ROS_MASTER_URI = " + master.error().message;
    found.remedy = "unset ROS_MASTER_URI, or set it to http://HOST:11311";
    return found;
  }
  const bool answers = ask_pid(*master, std::chrono::seconds(1)).ok();
  found.finding += answers ? "a master answers at " + uri : "no master at " + uri;
  const std::string own = variable("ROS_HOSTNAME") + variable("ROS_IP");
  if (!own.empty()) found.finding += "; other nodes connect to " + own;
  if (!master->is_loopback() && own.empty()) {
    found.works = false;
    found.remedy =
        "export ROS_IP=(this machine's address), so that nodes on other machines can connect";
  }
  return found;
}

}  // namespace overfly::ros1
