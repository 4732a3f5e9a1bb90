// overfly calibrate: a camera's intrinsics from images of a board.
#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "server/app/commands/calibrate/calibration_summary.hpp"
#include "server/app/commands/commands.hpp"
#include "server/app/exit_code.hpp"
#include "server/app/output_files.hpp"
#include "server/app/progress.hpp"
#include "server/app/stop_signal.hpp"
#include "server/calibration/calibrate_images.hpp"
#include "server/calibration/calibration_record.hpp"
#include "server/calibration/camera_text.hpp"
#include "server/files/whole_file.hpp"
#include "server/scenario/document/scenario_faults.hpp"
#include "server/scenario/document/scenario_file.hpp"
#include "server/scenario/document/scenario_override.hpp"

namespace overfly::app {
namespace {

using calibration::CalibratorOptions;
using server::CalibrationRecord;

struct CalibrateArguments {
  std::string images;
  std::string scenario;
  std::vector<std::string> sets;
  std::string camera;
  std::string board;
  double square_m = 0.0;
  std::string charuco;  ///< "4x4", "5x5", "6x6"; empty = no markers
  double marker_m = 0.0;
  std::string model = "radtan";
  bool k3 = false;
  bool accept_symmetric = false;
  int views = 20;
  std::uint64_t seed = 1;
  std::string save_images;
  std::string out;
  std::vector<std::string> exports;
  bool json = false;
  bool quiet = false;
};

/// "FORMAT=FILE".
struct ExportRequest {
  server::CameraFormat format;
  std::string file;
};

Result<std::vector<ExportRequest>> exports_from(const std::vector<std::string>& texts) {
  std::vector<ExportRequest> requests;
  for (const std::string& text : texts) {
    const std::size_t equals = text.find('=');
    const auto format = server::camera_format_from(text.substr(0, equals));
    if (!format || equals == std::string::npos || equals + 1 == text.size()) {
      return Error{ErrorCode::kInvalidArgument,
                   "--export " + text +
                       ": must be FORMAT=FILE, FORMAT one of orb-slam2, dso, svo, ros, kalibr"};
    }
    requests.push_back({*format, text.substr(equals + 1)});
  }
  return requests;
}

Result<CalibratorOptions> options_from(const CalibrateArguments& arguments) {
  const auto board = calibration::board_from_text(arguments.board, arguments.square_m);
  if (!board) return board.error();
  CalibratorOptions options;
  options.board = *board;
  if (!arguments.charuco.empty()) {
    options.board.markers =
        calibration::BoardMarkers{arguments.charuco.front() - '0', arguments.marker_m};
  }
  options.accept_symmetric = arguments.accept_symmetric;
  options.lens = {distortion_model_from(arguments.model).value_or(DistortionModel::kRadtan),
                  arguments.k3};
  if (arguments.k3 && options.lens.model != DistortionModel::kRadtan) {
    return Error{ErrorCode::kInvalidArgument, "--k3: must be given with --model radtan only"};
  }
  return options;
}

Result<CalibrationRecord> calibrate_scenario(const CalibrateArguments& arguments,
                                             const CalibratorOptions& options,
                                             const server::CalibrationProgress& progress) {
  const auto overrides = server::parse_overrides(arguments.sets);
  if (!overrides) return overrides.error();
  const auto scenario = server::load_scenario(arguments.scenario, *overrides);
  if (!scenario) return scenario.error();
  std::size_t index = 0;
  if (!arguments.camera.empty()) {
    const auto found = server::camera_index(*scenario, arguments.camera, "--camera");
    if (!found) return found.error();
    index = *found;
  }
  const server::CameraSpec& camera = scenario->cameras[index];
  server::VirtualCalibration request;
  request.camera = {camera.model, camera.sensor, arguments.views, arguments.seed};
  request.images = arguments.save_images;
  Result<CalibrationRecord> record = server::calibrate_virtual(request, options, progress);
  if (record) record->source = arguments.scenario + ", camera " + camera.name;
  return record;
}

Result<CalibrationRecord> calibrate_shown(const CalibrateArguments& arguments,
                                          const CalibratorOptions& options) {
  ProgressDisplay display(arguments.quiet || arguments.json);
  server::CalibrationProgress progress;
  progress.cancel = &catch_stop_signals();
  progress.show = [&](std::size_t done, std::size_t total, const std::string& what) {
    display.show(static_cast<double>(done) / static_cast<double>(total),
                 "image " + std::to_string(done) + " of " + std::to_string(total) + ", " + what);
  };
  if (!arguments.scenario.empty()) return calibrate_scenario(arguments, options, progress);
  return server::calibrate_images(arguments.images, options, progress);
}

Status write_files(const CalibrateArguments& arguments,
                   const std::vector<ExportRequest>& requests,
                   const CalibrationRecord& record) {
  if (!arguments.out.empty()) {
    Status status = server::write_json(arguments.out, server::json_from(record));
    if (!status) return status;
  }
  for (const ExportRequest& request : requests) {
    const auto text = server::camera_text(request.format, record.result.camera, "camera");
    if (!text) {
      // The format cannot hold this lens: another option, not another machine, helps.
      return Error{ErrorCode::kInvalidArgument,
                   text.error().in("--export " + request.file).message};
    }
    if (Status status = server::write_whole(request.file, *text); !status) return status;
  }
  return {};
}

Status check_files(const CalibrateArguments& arguments,
                   const std::vector<ExportRequest>& requests) {
  std::vector<NamedFile> written{{"--out", arguments.out}};
  for (const ExportRequest& request : requests) written.push_back({"--export", request.file});
  return check_outputs(written, {{"--scenario", arguments.scenario}});
}

int calibrate(const CalibrateArguments& arguments) {
  if (arguments.images.empty() == arguments.scenario.empty()) {
    return report({ErrorCode::kInvalidArgument, "one of --images and --scenario must be given"});
  }
  const auto requests = exports_from(arguments.exports);
  if (!requests) return report(requests.error());
  if (Status status = check_files(arguments, *requests); !status) return report(status.error());
  const auto options = options_from(arguments);
  if (!options) return report(options.error());
  const auto record = calibrate_shown(arguments, *options);
  if (!record) return report(record.error());
  if (Status status = write_files(arguments, *requests, *record); !status) {
    return report(status.error());
  }
  for (const std::string& warning : server::warnings_of(*record)) {
    std::cerr << "warning: " << warning << "\n";
  }
  if (arguments.json) {
    std::cout << server::json_from(*record).dump(2) << "\n";
  } else {
    std::cout << calibration_summary(*record);
  }
  return kExitOk;
}

void add_virtual_options(CLI::App& command, CalibrateArguments& arguments) {
  command.add_option("--scenario",
                     arguments.scenario,
                     "Scenario file: calibrates its camera from images of a virtual board");
  command.add_option("--set", arguments.sets, "Override a field of the scenario: path=value")
      ->allow_extra_args(false);
  command.add_option("--camera", arguments.camera, "Camera of the scenario; default: its first");
  command.add_option("--views", arguments.views, "Images of the virtual board")
      ->capture_default_str();
  command.add_option("--seed", arguments.seed, "Of the virtual board's poses and the noise")
      ->capture_default_str();
  command.add_option(
      "--save-images", arguments.save_images, "Folder for the images of the virtual board");
}

}  // namespace

void add_calibrate_command(CLI::App& app, int& exit_code) {
  const auto arguments = std::make_shared<CalibrateArguments>();
  CLI::App* command = app.add_subcommand(
      "calibrate", "Estimate a camera's intrinsics from images of a chequerboard or ChArUco board");
  command->add_option("--images", arguments->images, "Folder of the images");
  add_virtual_options(*command, *arguments);
  command->add_option("--board", arguments->board, "COLSxROWS, the board's inner corners")
      ->required();
  command->add_option("--square-m", arguments->square_m, "Side of a square [m]")->required();
  CLI::Option* charuco =
      command->add_option("--charuco", arguments->charuco, "ChArUco board: cells of its markers")
          ->check(CLI::IsMember({"4x4", "5x5", "6x6"}));
  CLI::Option* marker =
      command->add_option("--marker-m", arguments->marker_m, "Side of a marker [m]");
  charuco->needs(marker);
  marker->needs(charuco);
  command->add_option("--model", arguments->model, "Distortion model")
      ->check(CLI::IsMember({"none", "radtan", "equidistant"}))
      ->capture_default_str();
  command->add_flag("--k3", arguments->k3, "Estimate k3 of radtan too");
  command->add_flag("--accept-symmetric",
                    arguments->accept_symmetric,
                    "Take a board that looks the same after half a turn");
  command->add_option("--out", arguments->out, "Calibration file to write (JSON)");
  command
      ->add_option("--export",
                   arguments->exports,
                   "FORMAT=FILE: orb-slam2, dso, svo, ros or kalibr; may be repeated")
      ->allow_extra_args(false);
  command->add_flag("--json", arguments->json, "Print JSON");
  command->add_flag("--quiet", arguments->quiet, "No progress");
  command->callback([arguments, &exit_code] { exit_code = calibrate(*arguments); });
}

}  // namespace overfly::app
