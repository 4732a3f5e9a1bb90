#include "server/trajectories/served_trajectory.hpp"

namespace overfly::server {

Error no_such_trajectory(const std::string& name) {
  constexpr std::size_t kShown = 200;
  return {ErrorCode::kNotFound,
          "trajectory \"" + name.substr(0, kShown) + "\": no such trajectory"};
}

Result<TrajectoryReference> trajectory_reference_from(const std::string& text) {
  const std::size_t colon = text.find(':');
  if (colon == std::string::npos) return no_such_trajectory(text);
  const std::string kind = text.substr(0, colon);
  const std::string rest = text.substr(colon + 1);
  if (kind == "file") return TrajectoryReference{TrajectoryReference::Kind::kFile, rest, ""};
  const bool log = kind == "log";
  if (!log && kind != "run") return no_such_trajectory(text);
  const std::size_t end = rest.find(log ? '?' : '/');
  if (end == std::string::npos && !log) return no_such_trajectory(text);
  return TrajectoryReference{
      log ? TrajectoryReference::Kind::kLog : TrajectoryReference::Kind::kRun,
      rest.substr(0, end),
      end == std::string::npos ? std::string() : rest.substr(end + 1)};
}

}  // namespace overfly::server
