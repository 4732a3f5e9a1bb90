// Writes TUM trajectory files.
#include <unistd.h>

#include <cstdint>
#include <fstream>
#include <string>
#include <system_error>

#include "core/motion/trajectory_io.hpp"
#include "core/text/number_text.hpp"

namespace overfly {
namespace {

namespace fs = std::filesystem;

}  // namespace

std::string tum_text(const Trajectory& trajectory,
                     const std::map<std::string, std::string>& comments) {
  std::string text;
  for (const auto& [key, value] : comments) text += "# " + key + " " + value + "\n";
  for (const StampedPose& stamped : trajectory.poses()) {
    const Eigen::Vector3d& p = stamped.pose.translation;
    const Eigen::Quaterniond& q = stamped.pose.rotation;
    text += seconds_text(stamped.t_ns);
    for (const double value : {p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), q.w()}) {
      text += ' ' + number_text(value);
    }
    text += '\n';
  }
  return text;
}

Status write_tum(const fs::path& file,
                 const Trajectory& trajectory,
                 const std::map<std::string, std::string>& comments) {
  const auto failed = [&](const std::string& what) {
    return Error{ErrorCode::kIo, file.string() + ": " + what};
  };
  for (const auto& [key, value] : comments) {
    if (key.empty() || key.find_first_of(" \t\r\n") != std::string::npos ||
        value.find_first_of("\r\n") != std::string::npos) {
      return failed("the comment '" + key + "' needs a key without spaces and a value on one line");
    }
  }
  const fs::path unfinished = file.string() + ".part" + std::to_string(getpid());
  std::error_code error;
  {
    std::ofstream out(unfinished, std::ios::binary | std::ios::trunc);
    out << tum_text(trajectory, comments);
    if (!out.flush()) {
      out.close();
      fs::remove(unfinished, error);
      return failed("cannot be written");
    }
  }
  fs::rename(unfinished, file, error);
  if (!error) return {};
  std::error_code ignored;
  fs::remove(unfinished, ignored);
  return failed("cannot be written: " + error.message());
}

}  // namespace overfly
