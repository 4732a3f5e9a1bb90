#include "server/app/commands/log/log_smooth.hpp"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "core/text/number_text.hpp"
#include "core/time.hpp"
#include "flight/replay/smooth_log.hpp"
#include "server/app/commands/log/log_output.hpp"
#include "server/app/exit_code.hpp"
#include "server/app/output_files.hpp"
#include "server/app/stop_signal.hpp"

namespace overfly::app {
namespace {

namespace fs = std::filesystem;
namespace logs = flight::logs;
namespace smoothing = flight::smoothing;
using OrderedJson = nlohmann::ordered_json;

/// Jumps that the text shows; --json has all.
constexpr std::size_t kShownJumps = 20;

struct SmoothArguments {
  LogFlightArguments flight;
  std::string time_offset = "0";
  double rate_hz = 50.0;
  std::string residuals;
  bool json = false;
};

Result<std::optional<double>> time_offset_from(const std::string& text) {
  if (text == "auto") return std::optional<double>();
  char* end = nullptr;
  const double offset_s = std::strtod(text.c_str(), &end);
  if (end == text.c_str() || *end != '\0') {
    return Error{ErrorCode::kInvalidArgument,
                 "--time-offset-s " + text + ": must be a number or auto"};
  }
  return std::optional(offset_s);
}

std::string places_text(double value, int decimals) {
  char text[64];
  std::snprintf(text, sizeof text, "%.*f", decimals, value);
  return text;
}

std::string counts_text(const smoothing::FitReport& report) {
  return std::to_string(report.used) + " used (" + std::to_string(report.shifted) + " shifted), " +
         std::to_string(report.left_out) + " left out, longest gap " +
         places_text(report.longest_gap_s, 2) + " s";
}

std::string report_text(const flight::SmoothedLog& log) {
  const smoothing::SmoothedMotion& smoothed = log.smoothed;
  std::string text =
      "positions of " + log.position_source + ": " + counts_text(smoothed.positions) + "; noise " +
      places_text(smoothed.position_noise.horizontal_m, 3) + " m horizontally, " +
      places_text(smoothed.position_noise.vertical_m, 3) + " m vertically; residuals " +
      places_text(smoothed.positions.rms, 3) + " m RMS\n";
  text += "attitudes of " + log.attitude_source + ": " + counts_text(smoothed.attitudes) +
          "; noise " + places_text(deg_from_rad(smoothed.attitude_noise_rad), 3) +
          " deg; residuals " + places_text(deg_from_rad(smoothed.attitudes.rms), 3) + " deg RMS\n";
  text += "time offset of the attitudes: " + places_text(smoothed.motion.time_offset_s, 3) + " s";
  if (smoothed.estimated_offset) {
    text += " (estimated, standard deviation " +
            places_text(smoothed.estimated_offset->sigma_s, 3) + " s)";
  }
  text +=
      "\n" + counted(smoothed.jumps.size(), "jump") + (smoothed.jumps.empty() ? "" : ":") + "\n";
  for (std::size_t i = 0; i < std::min(kShownJumps, smoothed.jumps.size()); ++i) {
    text += "  " + flight::jump_text(log, smoothed.jumps[i]) + "\n";
  }
  if (smoothed.jumps.size() > kShownJumps) {
    text += "  and " + std::to_string(smoothed.jumps.size() - kShownJumps) + " more: see --json\n";
  }
  return text;
}

OrderedJson fit_json(const smoothing::FitReport& report, const char* rms_name, double rms) {
  return {{"used", report.used},
          {"shifted", report.shifted},
          {"left_out", report.left_out},
          {"longest_gap_s", report.longest_gap_s},
          {rms_name, rms}};
}

OrderedJson report_json(const flight::SmoothedLog& log, std::size_t poses) {
  const smoothing::SmoothedMotion& smoothed = log.smoothed;
  OrderedJson positions = fit_json(smoothed.positions, "residual_rms_m", smoothed.positions.rms);
  positions["source"] = log.position_source;
  positions["noise_horizontal_m"] = smoothed.position_noise.horizontal_m;
  positions["noise_vertical_m"] = smoothed.position_noise.vertical_m;
  OrderedJson attitudes =
      fit_json(smoothed.attitudes, "residual_rms_deg", deg_from_rad(smoothed.attitudes.rms));
  attitudes["source"] = log.attitude_source;
  attitudes["noise_deg"] = deg_from_rad(smoothed.attitude_noise_rad);
  OrderedJson json{{"poses", poses},
                   {"first_s", s_from_ns(log.begin_ns())},
                   {"last_s", s_from_ns(log.end_ns())},
                   {"positions", std::move(positions)},
                   {"attitudes", std::move(attitudes)},
                   {"time_offset_s", smoothed.motion.time_offset_s},
                   {"time_offset_sigma_s", nullptr},
                   {"jumps", OrderedJson::array()},
                   {"warnings", log.warnings}};
  if (smoothed.estimated_offset) json["time_offset_sigma_s"] = smoothed.estimated_offset->sigma_s;
  for (const smoothing::Jump& jump : smoothed.jumps) {
    const bool metres = jump.kind == smoothing::JumpKind::kPositionOutliers ||
                        jump.kind == smoothing::JumpKind::kPositionStep;
    json["jumps"].push_back(
        {{"t_s", s_from_ns(log.epoch_ns + ns_from_s(jump.t_s))},
         {"kind", to_string(jump.kind)},
         {metres ? "size_m" : "size_deg", metres ? jump.size : deg_from_rad(jump.size)},
         {"samples_left_out", jump.samples}});
  }
  return json;
}

Result<flight::SmoothedLog> smooth(const SmoothArguments& arguments) {
  if (Status status = check_log_flight(arguments.flight); !status) return status.error();
  if (!arguments.residuals.empty()) {
    if (Status status = check_log_output(arguments.flight.file, "--residuals", arguments.residuals);
        !status) {
      return status.error();
    }
    if (Status status =
            check_other_output("--residuals", arguments.residuals, "--out", arguments.flight.out);
        !status) {
      return status.error();
    }
  }
  const Result<std::optional<double>> offset_s = time_offset_from(arguments.time_offset);
  if (!offset_s) return offset_s.error();
  smoothing::SmoothingOptions options;
  options.time_offset_s = *offset_s;
  if (Status status = options.validate(); !status) return status.error();
  const logs::LogSlice slice = arguments.flight.times.slice();
  const Result<logs::OpenedLog> log =
      logs::open_log(arguments.flight.file, &catch_stop_signals(), {.slice = slice});
  if (!log) return log.error();
  for (const std::string& warning : log->warnings) std::cerr << "warning: " << warning << "\n";
  const logs::TrajectoryRequest request{arguments.flight.source, slice.from_ns, slice.to_ns};
  return flight::smooth_log(*log,
                            request,
                            options,
                            arguments.flight.geoid_separation_m.value_or(0.0),
                            &catch_stop_signals());
}

Status write_smoothed(const SmoothArguments& arguments,
                      const flight::SmoothedLog& log,
                      const logs::LogTrajectory& trajectory) {
  const fs::path out = arguments.flight.out;
  Status status = out.extension() == ".csv"
                      ? write_log_csv(out, trajectory, arguments.flight.geoid_separation_m)
                      : write_log_tum(out, trajectory);
  if (status && !arguments.residuals.empty()) {
    status = flight::write_residuals(arguments.residuals, log);
  }
  return status;
}

int run_smooth(const SmoothArguments& arguments) {
  const Result<flight::SmoothedLog> log = smooth(arguments);
  if (!log) return report(log.error());
  for (const std::string& warning : log->warnings) std::cerr << "warning: " << warning << "\n";
  const Result<logs::LogTrajectory> trajectory =
      flight::sampled_trajectory(*log, arguments.rate_hz);
  if (!trajectory) return report(trajectory.error().in("--rate-hz"));
  if (Status status = write_smoothed(arguments, *log, *trajectory); !status) {
    return report(status.error());
  }
  const std::size_t poses = trajectory->poses.size();
  if (arguments.json) {
    std::cout << report_json(*log, poses).dump(2) << "\n";
    return kExitOk;
  }
  std::cout << report_text(*log) << arguments.flight.out << ": " << poses << " poses, "
            << s_from_ns(log->begin_ns()) << " to " << s_from_ns(log->end_ns())
            << " s of the vehicle's clock\n";
  return kExitOk;
}

}  // namespace

void add_log_smooth(CLI::App& log, int& exit_code) {
  const auto arguments = std::make_shared<SmoothArguments>();
  LogFlightArguments& flight = arguments->flight;
  CLI::App* const smooth_command = log.add_subcommand(
      "smooth", "Write the flight as one smooth trajectory, without outliers and steps");
  smooth_command->add_option("FILE", flight.file, "Flight log")->required();
  smooth_command->add_option("--source", flight.source, "Stream of the positions, as for convert");
  smooth_command
      ->add_option("--out",
                   flight.out,
                   "File.tum: poses T_world_body; file.csv: latitude, longitude, height, angles")
      ->required();
  flight.times.add_to(*smooth_command);
  smooth_command->add_option("--geoid-separation-m",
                             flight.geoid_separation_m,
                             "Height of the geoid above the ellipsoid at the place, for a .csv "
                             "file that scenarios can fly");
  smooth_command->add_option("--time-offset-s",
                             arguments->time_offset,
                             "Added to the times of attitudes; auto: estimated from the turns");
  smooth_command->add_option("--rate-hz", arguments->rate_hz, "Rate of the poses");
  smooth_command->add_option(
      "--residuals", arguments->residuals, "CSV file for the residuals of all samples");
  smooth_command->add_flag("--json", arguments->json, "Print JSON");
  smooth_command->callback([arguments, &exit_code] { exit_code = run_smooth(*arguments); });
}

}  // namespace overfly::app
