// overfly track: runs an estimator over recorded images.
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cerrno>
#include <filesystem>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <system_error>

#include "core/motion/trajectory_io.hpp"
#include "server/app/commands/commands.hpp"
#include "server/app/commands/track/track_arguments.hpp"
#include "server/app/commands/track/track_summary.hpp"
#include "server/app/exit_code.hpp"
#include "server/app/output_files.hpp"
#include "server/app/progress.hpp"
#include "server/app/stop_signal.hpp"
#include "server/dataset/open_dataset.hpp"
#include "server/dataset/track_report.hpp"
#include "server/estimators/estimator_factory.hpp"

namespace overfly::app {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

/// The truth, if given.
struct Truth {
  Trajectory T_world_camera;
  bool has_times = true;
};

/// Errors: kIo with the system's reason.
Status check_writable(const fs::path& folder, const std::string& written) {
  if (access(folder.c_str(), W_OK | X_OK) == 0) return {};
  const std::string reason = std::generic_category().message(errno);
  return Error{ErrorCode::kIo,
               written + ": folder " + folder.string() + " cannot be written to: " + reason};
}

/// A file is written as a new one in its folder, which then takes its name.
/// Errors: kNotFound without the folder; kInvalidArgument if it is itself a folder; kIo.
Status check_output_file(const std::string& file) {
  std::error_code failure;
  fs::path folder = fs::path(file).parent_path();
  if (folder.empty()) folder = ".";
  if (!fs::is_directory(folder, failure)) {
    return Error{ErrorCode::kNotFound, file + ": folder " + folder.string() + " does not exist"};
  }
  if (fs::is_directory(file, failure)) {
    return Error{ErrorCode::kInvalidArgument, file + ": is a folder, must be a file"};
  }
  return check_writable(folder, file);
}

/// Checked before the estimator runs, so that no result is lost because its file cannot be written.
Status prepare_outputs(const TrackArguments& arguments) {
  Status others = check_outputs({{"--out", arguments.out},
                                 {"--statuses", arguments.statuses},
                                 {"--points", arguments.points}},
                                {{"--truth", arguments.truth}, {"--times", arguments.times}});
  if (!others) return others;
  for (const std::string& file : {arguments.out, arguments.statuses, arguments.points}) {
    if (file.empty()) continue;
    if (Status status = check_output_file(file); !status) return status;
  }
  for (const std::string& folder : {arguments.debug, arguments.estimator_folder}) {
    if (folder.empty()) continue;
    std::error_code failure;
    fs::create_directories(folder, failure);
    if (failure) {
      return Error{ErrorCode::kIo, folder + ": cannot be created: " + failure.message()};
    }
    if (Status status = check_writable(folder, folder); !status) return status;
  }
  return {};
}

Result<std::optional<Truth>> read_truth(const TrackArguments& arguments, server::Dataset& dataset) {
  if (arguments.truth.empty()) return std::optional<Truth>();
  const Result<TrajectoryFile> file = read_trajectory(arguments.truth);
  if (!file) return file.error();
  if (!file->has_times && !dataset.warnings.empty()) {
    return Error{ErrorCode::kInvalidArgument,
                 arguments.truth + ": has no times, and cannot be matched by number: " +
                     dataset.warnings.front()};
  }
  dataset.warnings.insert(dataset.warnings.end(), file->warnings.begin(), file->warnings.end());
  const Result<Trajectory> camera = server::camera_truth(dataset, *file, dataset.notes);
  if (!camera) return camera.error().in(arguments.truth);
  return std::optional<Truth>(Truth{*camera, file->has_times});
}

/// The truth for the perfect and drifting estimators.
Result<ToyTruthAt> toy_truth(const server::Dataset& dataset,
                             const std::optional<Truth>& truth,
                             double scene_depth_m) {
  if (!truth || !truth->has_times) {
    return Error{ErrorCode::kInvalidArgument, "needs --truth with times, since it gets the truth"};
  }
  for (const server::DatasetImage& image : dataset.images) {
    if (!truth->T_world_camera.at(image.t_ns)) {
      return Error{ErrorCode::kInvalidArgument,
                   image.listed_at + ": the truth has no pose at the image's time"};
    }
  }
  return ToyTruthAt([T_world_camera = truth->T_world_camera,
                     scene_depth_m](std::int64_t t_ns) -> std::optional<ToyTruth> {
    const std::optional<Pose> pose = T_world_camera.at(t_ns);
    if (!pose) return std::nullopt;
    return ToyTruth{*pose, scene_depth_m};
  });
}

Result<std::unique_ptr<VoPort>> create_port(const TrackArguments& arguments,
                                            const server::Dataset& dataset,
                                            const std::optional<Truth>& truth,
                                            const std::atomic<bool>& stop) {
  const Result<server::EstimatorSpec> spec = estimator_from(arguments);
  if (!spec) return spec.error();
  server::EstimatorSetting setting;
  setting.seed = arguments.seed;
  setting.cancel = &stop;
  if (!arguments.estimator_folder.empty()) {
    setting.output_folder = fs::absolute(arguments.estimator_folder);
  }
  if (!server::is_test_estimator(spec->type)) return server::create_estimator(*spec, setting);
  const Result<ToyTruthAt> known = toy_truth(dataset, truth, arguments.init_true_depth_m);
  if (!known) return known.error().in("estimator \"" + spec->name + "\"");
  return server::create_estimator(*spec, setting, *known);
}

Status write_outputs(const TrackArguments& arguments, const server::TrackedDataset& tracked) {
  if (Status status = server::write_track(arguments.out, tracked); !status) return status;
  if (!arguments.statuses.empty()) {
    if (Status status = server::write_statuses(arguments.statuses, tracked); !status) {
      return status;
    }
  }
  if (arguments.points.empty()) return {};
  const int map_id = server::scored_map(tracked).value_or(0);
  return server::write_ply(
      arguments.points, tracked.map.points(map_id), "sparse map in the units of " + arguments.out);
}

Result<server::TrackedDataset> track_shown(const TrackArguments& arguments,
                                           const server::Dataset& dataset,
                                           const std::atomic<bool>& stop,
                                           VoPort& port) {
  ProgressDisplay display(arguments.quiet);
  server::TrackOptions options;
  options.debug_folder = arguments.debug;
  options.map_points = !arguments.points.empty();
  options.cancel = &stop;
  options.log = [&](const std::string& line) {
    const std::string text = "estimator: " + line;
    if (line.find("warning:") == std::string::npos) {
      display.note(text);
    } else {
      display.warn(text);
    }
  };
  options.progress = [&](std::size_t done, std::size_t total, TrackingState state) {
    display.show(
        static_cast<double>(done) / static_cast<double>(total),
        "frame " + std::to_string(done) + " of " + std::to_string(total) + ", " + to_string(state));
  };
  return server::track_dataset(dataset, port, options);
}

int track(const TrackArguments& arguments) {
  const std::atomic<bool>& stop = catch_stop_signals();
  const Result<server::DatasetOptions> options = dataset_options_from(arguments);
  if (!options) return report(options.error());
  if (Status status = prepare_outputs(arguments); !status) return report(status.error());
  Result<server::Dataset> dataset = server::open_dataset(*options);
  if (!dataset) return report(dataset.error());
  const Result<std::optional<Truth>> truth = read_truth(arguments, *dataset);
  if (!truth) return report(truth.error());
  for (const std::string& warning : dataset->warnings) std::cerr << "warning: " << warning << "\n";
  const Result<std::unique_ptr<VoPort>> port = create_port(arguments, *dataset, *truth, stop);
  if (!port) return report(port.error());
  const auto tracked = track_shown(arguments, *dataset, stop, **port);
  if (!tracked) return report(tracked.error());
  if (Status status = write_outputs(arguments, *tracked); !status) return report(status.error());

  std::optional<evaluation::Score> score;
  if (*truth) {
    std::optional<double> depth_m;
    if (arguments.init_true_depth_m > 0.0) depth_m = arguments.init_true_depth_m;
    score = server::score_of(
        *dataset, *tracked, (*truth)->T_world_camera, (*truth)->has_times, depth_m);
  }
  if (arguments.json) {
    Json report = server::report_json(*dataset, *tracked, score);
    report["out"] = arguments.out;
    std::cout << report.dump(2) << "\n";
  } else {
    std::cout << track_summary(*dataset, *tracked, score, arguments.out);
  }
  if (tracked->cancelled) {
    std::cerr << "cancelled after frame " << tracked->records.size() << "\n";
    return kExitCancelled;
  }
  if (const std::string reason = server::never_ran(*tracked); !reason.empty()) {
    return report({ErrorCode::kInternal, "the estimator never ran: " + reason});
  }
  return kExitOk;
}

void add_dataset_options(CLI::App& command, TrackArguments& arguments) {
  command.add_option("--images", arguments.images, "Folder of the images, or of the data set")
      ->required();
  command
      .add_option("--times",
                  arguments.times,
                  "File with the times of a plain folder's images, one per line")
      ->check(CLI::ExistingFile);
  command.add_option("--time-unit", arguments.time_unit, "Unit of --times")
      ->check(CLI::IsMember({"auto", "s", "ns"}))
      ->capture_default_str();
  command.add_option("--camera",
                     arguments.camera,
                     "FX,FY,CX,CY[,WIDTH,HEIGHT] in pixels, pixel centres at integers; replaces "
                     "the data set's own calibration");
  command.add_option("--distortion",
                     arguments.distortion,
                     "radtan:K1,K2,P1,P2[,K3], equidistant:K1,K2,K3,K4 or fov:W; with --camera");
  command
      .add_option("--layout", arguments.layout, "Layout, if it cannot be detected from the files")
      ->check(CLI::IsMember({"images", "euroc", "tum-mono", "tum-rgbd", "kitti", "png"}));
  command.add_option("--camera-name",
                     arguments.camera_name,
                     "One of several cameras: cam1 (EuRoC), image_2 (KITTI)");
  command
      .add_option("--bits",
                  arguments.sample_bits,
                  "Significant bits of 16-bit images; the upper 8 are used")
      ->check(CLI::Range(8, 16))
      ->capture_default_str();
}

void add_estimator_options(CLI::App& command, TrackArguments& arguments) {
  command
      .add_option("--estimator",
                  arguments.estimator,
                  "feature (default), process (default with --command or --listen), lcm, ros1; "
                  "perfect and drifting need --truth")
      ->check(CLI::IsMember({"feature",
                             "baseline_hold",
                             "baseline_homography",
                             "baseline_dead_reckoning",
                             "perfect",
                             "drifting",
                             "process",
                             "lcm",
                             "ros1"}));
  command
      .add_option("--scenario-estimator",
                  arguments.scenario_estimator,
                  "FILE:NAME, an estimator of a scenario; without :NAME its only one")
      ->excludes("--estimator");
  command
      .add_option("--parameter",
                  arguments.parameters,
                  "Parameter KEY=VALUE of the estimator; may be repeated")
      ->allow_extra_args(false);
  command
      .add_option("--set",
                  arguments.sets,
                  "Another field of the estimator as in a scenario: start_timeout_s=60, "
                  "lcm.channel_prefix=MINE_")
      ->allow_extra_args(false);
  command.add_option(
      "--command", arguments.command, "Program and arguments of a process, as one text");
  command.add_option(
      "--listen", arguments.listen, "Where a process connects: unix:PATH or tcp:HOST:PORT");
  command.add_option("--estimator-folder",
                     arguments.estimator_folder,
                     "Working folder of a process; it also gets output.log");
  command.add_option("--seed", arguments.seed, "Seed of an estimator that uses random numbers")
      ->capture_default_str();
}

void add_output_options(CLI::App& command, TrackArguments& arguments) {
  command.add_option("--out", arguments.out, "Trajectory to write (TUM)")->required();
  command.add_option("--statuses", arguments.statuses, "File for one line of JSON per frame");
  command.add_option("--points", arguments.points, "File for the sparse map (PLY)");
  command.add_option("--debug", arguments.debug, "Folder for the debug image of each frame");
  command
      .add_option("--truth", arguments.truth, "Trajectory to score against: TUM, KITTI, EuRoC, CSV")
      ->check(CLI::ExistingFile);
  command
      .add_option("--init-true-depth-m",
                  arguments.init_true_depth_m,
                  "True depth along the optical axis at the first pose, for init_scale")
      ->check(CLI::PositiveNumber);
  command.add_flag("--json", arguments.json, "Print JSON");
  command.add_flag("--quiet", arguments.quiet, "No progress; warnings stay");
}

}  // namespace

void add_track_command(CLI::App& app, int& exit_code) {
  const auto arguments = std::make_shared<TrackArguments>();
  CLI::App* command = app.add_subcommand("track", "Run an estimator over recorded images");
  add_dataset_options(*command, *arguments);
  add_estimator_options(*command, *arguments);
  add_output_options(*command, *arguments);
  command->callback([arguments, &exit_code] { exit_code = track(*arguments); });
}

}  // namespace overfly::app
