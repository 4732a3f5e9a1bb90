// overfly log: lists what a flight log contains, and writes its flight as a trajectory file.
#include <CLI/CLI.hpp>
#include <filesystem>
#include <iostream>
#include <memory>
#include <string>

#include "core/text/number_text.hpp"
#include "flight/logs/truth/log_trajectory.hpp"
#include "server/app/commands/commands.hpp"
#include "server/app/commands/log/log_output.hpp"
#include "server/app/commands/log/log_smooth.hpp"
#include "server/app/exit_code.hpp"
#include "server/app/stop_signal.hpp"
#include "server/logs/log_info.hpp"

namespace overfly::app {
namespace {

namespace fs = std::filesystem;
namespace logs = flight::logs;

struct InfoArguments {
  std::string file;
  bool json = false;
  LogTimes times;
};

int print_log(const InfoArguments& arguments) {
  if (Status status = arguments.times.check(); !status) return report(status.error());
  const Result<logs::OpenedLog> log =
      logs::open_log(arguments.file, &catch_stop_signals(), {.slice = arguments.times.slice()});
  if (!log) return report(log.error());
  std::cout << (arguments.json ? server::log_info_json(*log).dump(2) + "\n"
                               : server::log_info_text(*log));
  return kExitOk;
}

int convert_log(const LogFlightArguments& arguments) {
  if (Status status = check_log_flight(arguments); !status) return report(status.error());
  const logs::LogSlice slice = arguments.times.slice();
  const Result<logs::OpenedLog> log =
      logs::open_log(arguments.file, &catch_stop_signals(), {.slice = slice});
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

}  // namespace

void add_log_command(CLI::App& app, int& exit_code) {
  CLI::App* const log = app.add_subcommand(
      "log", "Flight logs: .tlog, DataFlash .bin, .ulg, .mcap, .bag, LCM event logs, CSV");
  log->require_subcommand(1);
  const auto asked = std::make_shared<InfoArguments>();
  CLI::App* const info =
      log->add_subcommand("info", "List streams, sources of truth, events and damage");
  info->add_option("FILE", asked->file, "Flight log")->required();
  info->add_flag("--json", asked->json, "Print JSON");
  asked->times.add_to(*info);
  info->callback([asked, &exit_code] { exit_code = print_log(*asked); });

  const auto arguments = std::make_shared<LogFlightArguments>();
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
  arguments->times.add_to(*convert);
  convert->add_option("--geoid-separation-m",
                      arguments->geoid_separation_m,
                      "Height of the geoid above the ellipsoid at the place, for a .csv file with "
                      "heights above the ellipsoid, which scenarios can fly");
  convert->callback([arguments, &exit_code] { exit_code = convert_log(*arguments); });
  add_log_smooth(*log, exit_code);
}

}  // namespace overfly::app
