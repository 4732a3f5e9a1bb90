// overfly log: lists what a flight log contains, and converts its flight to a trajectory file.
#include <CLI/CLI.hpp>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "core/text/number_text.hpp"
#include "core/time.hpp"
#include "flight/logs/log_trajectory.hpp"
#include "server/app/commands/commands.hpp"
#include "server/app/commands/log_info.hpp"
#include "server/app/exit_code.hpp"
#include "server/app/stop_signal.hpp"

namespace overfly::app {
namespace {

namespace fs = std::filesystem;
namespace logs = flight::logs;

/// Times of ROS count from 1970.
constexpr double kLatestS = 9e9;
/// The geoid lies between 107 m below and 86 m above WGS84.
constexpr double kGeoidMaxM = 120.0;

struct LogArguments {
  std::string file;
  bool json = false;
  std::string source;
  std::string out;
  std::optional<double> from_s;
  std::optional<double> to_s;
  std::optional<double> geoid_separation_m;
};

Status check_times(const LogArguments& arguments) {
  for (const auto& [option, limit] :
       {std::pair{"--from ", arguments.from_s}, std::pair{"--to ", arguments.to_s}}) {
    // Written so that not-a-number is rejected as well.
    if (limit && !(*limit >= 0.0 && *limit <= kLatestS)) {
      return Error{ErrorCode::kInvalidArgument,
                   option + std::to_string(*limit) + ": must be in [0, 9e9] s"};
    }
  }
  if (arguments.from_s && arguments.to_s && *arguments.from_s > *arguments.to_s) {
    return Error{ErrorCode::kInvalidArgument,
                 "--from " + std::to_string(*arguments.from_s) + ": must not be after --to " +
                     std::to_string(*arguments.to_s)};
  }
  return {};
}

/// @pre check_times()
logs::LogSlice slice_of(const LogArguments& arguments) {
  logs::LogSlice slice;
  if (arguments.from_s) slice.from_ns = ns_from_s(*arguments.from_s);
  if (arguments.to_s) slice.to_ns = ns_from_s(*arguments.to_s);
  return slice;
}

int print_log(const LogArguments& arguments) {
  if (Status status = check_times(arguments); !status) return report(status.error());
  const Result<logs::OpenedLog> log =
      logs::open_log(arguments.file, &catch_stop_signals(), slice_of(arguments));
  if (!log) return report(log.error());
  std::cout << (arguments.json ? log_info_json(*log).dump(2) + "\n" : log_info_text(*log));
  return kExitOk;
}

Status check_convert(const LogArguments& arguments) {
  const std::string extension = fs::path(arguments.out).extension().string();
  if (extension != ".tum" && extension != ".csv") {
    return Error{ErrorCode::kInvalidArgument,
                 "--out " + arguments.out + ": must end with .tum or .csv"};
  }
  if (arguments.geoid_separation_m && extension != ".csv") {
    return Error{ErrorCode::kInvalidArgument, "--geoid-separation-m: is only used for a .csv file"};
  }
  if (Status status = check_times(arguments); !status) return status;
  if (arguments.geoid_separation_m && !(std::abs(*arguments.geoid_separation_m) <= kGeoidMaxM)) {
    return Error{ErrorCode::kInvalidArgument,
                 "--geoid-separation-m " + std::to_string(*arguments.geoid_separation_m) +
                     ": must be in [-120, 120]"};
  }
  std::error_code failure;
  // The format follows from the content, so that a log may have any name.
  if (fs::equivalent(arguments.file, arguments.out, failure)) {
    return Error{ErrorCode::kInvalidArgument,
                 "--out " + arguments.out + ": is the log itself, which would be lost"};
  }
  const fs::path folder = fs::path(arguments.out).parent_path();
  if (folder.empty() || fs::is_directory(folder, failure)) return {};
  return Error{ErrorCode::kNotFound,
               "--out " + arguments.out + ": folder " + folder.string() + " does not exist"};
}

int convert_log(const LogArguments& arguments) {
  if (Status status = check_convert(arguments); !status) return report(status.error());
  const logs::LogSlice slice = slice_of(arguments);
  const Result<logs::OpenedLog> log = logs::open_log(arguments.file, &catch_stop_signals(), slice);
  if (!log) return report(log.error());
  const logs::TrajectoryRequest request{arguments.source, slice.from_ns, slice.to_ns};
  const Result<logs::LogTrajectory> trajectory =
      logs::read_log_trajectory(*log, request, &catch_stop_signals());
  if (!trajectory) return report(trajectory.error());
  for (const auto& warnings : {log->warnings, trajectory->warnings}) {
    for (const std::string& warning : warnings) std::cerr << "warning: " << warning << "\n";
  }
  const bool csv = fs::path(arguments.out).extension() == ".csv";
  const Status written =
      csv ? logs::write_log_csv(arguments.out, *trajectory, arguments.geoid_separation_m)
          : logs::write_log_tum(arguments.out, *trajectory);
  if (!written) return report(written.error());
  const auto& poses = trajectory->poses;
  std::cout << arguments.out << ": " << poses.size() << " poses of " << trajectory->position_source
            << " with the attitude of " << trajectory->attitude_source << ", "
            << seconds_text(poses.front().t_ns) << " to " << seconds_text(poses.back().t_ns)
            << " s of the vehicle's clock\n";
  return kExitOk;
}

void add_time_options(CLI::App& command, LogArguments& arguments) {
  command.add_option("--from", arguments.from_s, "First time by the vehicle's clock [s]");
  command.add_option("--to", arguments.to_s, "Last time by the vehicle's clock [s]");
}

}  // namespace

void add_log_command(CLI::App& app, int& exit_code) {
  CLI::App* const log = app.add_subcommand(
      "log", "Flight logs: .tlog, DataFlash .bin, .ulg, .mcap, .bag, LCM event logs");
  log->require_subcommand(1);
  const auto arguments = std::make_shared<LogArguments>();
  CLI::App* const info =
      log->add_subcommand("info", "List streams, sources of truth, events and damage");
  info->add_option("FILE", arguments->file, "Flight log")->required();
  info->add_flag("--json", arguments->json, "Print JSON");
  add_time_options(*info, *arguments);
  info->callback([arguments, &exit_code] { exit_code = print_log(*arguments); });

  CLI::App* const convert = log->add_subcommand("convert", "Write the flight as a trajectory file");
  convert->add_option("FILE", arguments->file, "Flight log")->required();
  convert->add_option("--source",
                      arguments->source,
                      "Stream of the positions, as listed by `log info`; by default the "
                      "recommended truth");
  convert
      ->add_option("--out",
                   arguments->out,
                   "File.tum: poses T_world_body; file.csv: latitude, longitude, height, angles")
      ->required();
  add_time_options(*convert, *arguments);
  convert->add_option("--geoid-separation-m",
                      arguments->geoid_separation_m,
                      "Height of the geoid above the ellipsoid at the place, for a .csv file with "
                      "heights above the ellipsoid, which scenarios can fly");
  convert->callback([arguments, &exit_code] { exit_code = convert_log(*arguments); });
}

}  // namespace overfly::app
