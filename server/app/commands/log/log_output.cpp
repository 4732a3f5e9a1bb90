#include "server/app/commands/log/log_output.hpp"

#include <CLI/CLI.hpp>
#include <cmath>
#include <filesystem>
#include <utility>
#include <vector>

#include "core/time.hpp"

namespace overfly::app {
namespace {

namespace fs = std::filesystem;

/// Times of ROS count from 1970.
constexpr double kLatestS = 9e9;
/// The geoid lies between 107 m below and 86 m above WGS84.
constexpr double kGeoidMaxM = 120.0;

}  // namespace

void LogTimes::add_to(CLI::App& command) {
  command.add_option("--from", from_s, "First time by the vehicle's clock [s]");
  command.add_option("--to", to_s, "Last time by the vehicle's clock [s]");
}

Status LogTimes::check() const {
  for (const auto& [option, limit] : {std::pair{"--from ", from_s}, std::pair{"--to ", to_s}}) {
    // Written so that not-a-number is rejected as well.
    if (limit && !(*limit >= 0.0 && *limit <= kLatestS)) {
      return Error{ErrorCode::kInvalidArgument,
                   option + std::to_string(*limit) + ": must be in [0, 9e9] s"};
    }
  }
  if (from_s && to_s && *from_s > *to_s) {
    return Error{
        ErrorCode::kInvalidArgument,
        "--from " + std::to_string(*from_s) + ": must not be after --to " + std::to_string(*to_s)};
  }
  return {};
}

flight::logs::LogSlice LogTimes::slice() const {
  flight::logs::LogSlice slice;
  if (from_s) slice.from_ns = ns_from_s(*from_s);
  if (to_s) slice.to_ns = ns_from_s(*to_s);
  return slice;
}

Status check_log_output(const std::string& log, const std::string& option, const std::string& out) {
  const Result<std::vector<fs::path>> files = flight::logs::files_of_log(log);
  if (!files) return files.error();
  std::error_code failure;
  // The format follows from the content, so that a log may have any name.
  for (const fs::path& file : *files) {
    if (!fs::equivalent(file, out, failure)) continue;
    return Error{ErrorCode::kInvalidArgument,
                 option + " " + out + ": is the log itself, which would be lost"};
  }
  const fs::path folder = fs::path(out).parent_path();
  if (folder.empty() || fs::is_directory(folder, failure)) return {};
  return Error{ErrorCode::kNotFound,
               option + " " + out + ": folder " + folder.string() + " does not exist"};
}

Status check_log_flight(const LogFlightArguments& arguments) {
  const std::string extension = fs::path(arguments.out).extension().string();
  if (extension != ".tum" && extension != ".csv") {
    return Error{ErrorCode::kInvalidArgument,
                 "--out " + arguments.out + ": must end with .tum or .csv"};
  }
  if (arguments.geoid_separation_m && extension != ".csv") {
    return Error{ErrorCode::kInvalidArgument, "--geoid-separation-m: is only used for a .csv file"};
  }
  if (Status status = arguments.times.check(); !status) return status;
  if (arguments.geoid_separation_m && !(std::abs(*arguments.geoid_separation_m) <= kGeoidMaxM)) {
    return Error{ErrorCode::kInvalidArgument,
                 "--geoid-separation-m " + std::to_string(*arguments.geoid_separation_m) +
                     ": must be in [-120, 120]"};
  }
  return check_log_output(arguments.file, "--out", arguments.out);
}

}  // namespace overfly::app
