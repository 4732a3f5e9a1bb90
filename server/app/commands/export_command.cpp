// overfly export: writes a run or scenario as a data set in a common format, or as a video.
#include <CLI/CLI.hpp>
#include <functional>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "server/app/commands/commands.hpp"
#include "server/app/exit_code.hpp"
#include "server/app/progress.hpp"
#include "server/app/stop_signal.hpp"
#include "server/export/dataset_export.hpp"
#include "server/export/video_export.hpp"
#include "server/scenario/document/scenario_list.hpp"
#include "server/scenario/document/scenario_override.hpp"

namespace overfly::app {
namespace {

struct ExportArguments {
  std::string source;
  std::string format;
  std::string out;
  std::vector<std::string> sets;
  std::vector<std::string> truth;
  std::vector<std::string> cameras;  ///< names, the main camera first
  double from_s = 0.0;
  std::optional<double> to_s;
  int threads = -1;  // -1 = use the scenario's value
  flight::ImuModel imu;
  std::function<bool()> imu_given;  ///< one of its options
  std::string video;  ///< contents of the video; empty = no video; for webm, both views
  int video_quality = 70;
  bool json = false;
  bool quiet = false;
};

Result<server::ExportSource> open_source(const ExportArguments& arguments) {
  const auto overrides = server::parse_overrides(arguments.sets);
  if (!overrides) return overrides.error();
  auto source = server::open_export_source(arguments.source, *overrides);
  if (!source) return source.error();
  if (Status status = server::check_scenario(source->scenario); !status) return status.error();
  if (arguments.threads >= 0) source->scenario.renderer.threads = arguments.threads;
  return source;
}

/// Fills the options common to all exports: time span, camera, cancellation, progress.
template <typename Options>
void set_common(const ExportArguments& arguments, ProgressDisplay& display, Options& options) {
  options.from_s = arguments.from_s;
  options.to_s = arguments.to_s;
  options.cancel = &catch_stop_signals();
  options.notice = [&display](const std::string& text) { display.note(text); };
  options.progress = [&display](std::int64_t done, std::int64_t total) {
    display.show(static_cast<double>(done) / static_cast<double>(total),
                 "frame " + std::to_string(done) + " of " + std::to_string(total));
  };
}

int print_result(const ExportArguments& arguments,
                 const nlohmann::json& summary,
                 const std::string& text,
                 bool cancelled) {
  if (arguments.json) {
    std::cout << summary.dump(2) << "\n";
  } else {
    std::cout << text;
    const std::string credit = summary.at("attribution");
    if (!credit.empty()) std::cout << "imagery: " << credit << "\n";
  }
  if (!cancelled) return kExitOk;
  std::cerr << "cancelled; the output so far is kept\n";
  return kExitCancelled;
}

server::VideoLook look_of(const ExportArguments& arguments) {
  server::VideoLook look;
  look.view = server::video_view_from(arguments.video).value_or(server::VideoView::kBoth);
  look.quality = arguments.video_quality;
  return look;
}

int export_as_video(const ExportArguments& arguments, const server::ExportSource& source) {
  server::VideoOptions options;
  options.file = arguments.out;
  options.look = look_of(arguments);
  if (arguments.cameras.size() > 1 || !arguments.truth.empty()) {
    return report({ErrorCode::kInvalidArgument, "webm: takes one --camera and no --truth"});
  }
  if (!arguments.cameras.empty()) options.camera = arguments.cameras.front();
  Result<server::VideoSummary> summary = Error{};
  {
    ProgressDisplay display(arguments.quiet);
    set_common(arguments, display, options);
    summary = server::export_video(source, options);
  }
  if (!summary) return report(summary.error());
  return print_result(arguments,
                      {{"frames", summary->frames},
                       {"cancelled", summary->cancelled},
                       {"attribution", summary->attribution}},
                      arguments.out + ": " + std::to_string(summary->frames) + " frames\n",
                      summary->cancelled);
}

int export_as_dataset(const ExportArguments& arguments,
                      server::DatasetFormat format,
                      const server::ExportSource& source) {
  server::ExportOptions options;
  options.folder = arguments.out;
  options.format = format;
  options.cameras = arguments.cameras;
  if (arguments.imu_given()) options.imu = arguments.imu;
  if (!arguments.video.empty()) options.video = look_of(arguments);
  for (const std::string& name : arguments.truth) {
    const auto kind = server::truth_kind_from(name);
    if (!kind) {
      return report(
          {ErrorCode::kInvalidArgument,
           "truth = " + name + ": must be one of depth, range, normal, flow, world, mask"});
    }
    options.truth.insert(*kind);
  }
  Result<server::ExportSummary> summary = Error{};
  {
    ProgressDisplay display(arguments.quiet);
    set_common(arguments, display, options);
    summary = server::export_dataset(source, options);
  }
  if (!summary) return report(summary.error());
  return print_result(arguments,
                      {{"frames", summary->frames},
                       {"images", summary->images},
                       {"cancelled", summary->cancelled},
                       {"attribution", summary->attribution},
                       {"stages", summary->stages}},
                      arguments.out + ": " + std::to_string(summary->images) + " images of " +
                          std::to_string(summary->frames) + " frames, " + arguments.format + "\n",
                      summary->cancelled);
}

int export_source(const ExportArguments& arguments) {
  const auto format = server::dataset_format_from(arguments.format);
  if (!format && arguments.format != "webm") {
    return report({ErrorCode::kInvalidArgument,
                   "format = " + arguments.format +
                       ": must be one of tum-mono, euroc, kitti, png, lcm, rosbag, mcap, webm"});
  }
  const auto source = open_source(arguments);
  if (!source) return report(source.error());
  if (format) return export_as_dataset(arguments, *format, *source);
  return export_as_video(arguments, *source);
}

/// Returns whether one of the options was given.
std::function<bool()> add_imu_options(CLI::App& command, flight::ImuModel& imu) {
  command.add_option("--imu-rate", imu.rate_hz, "euroc: rate of the IMU [Hz]")
      ->capture_default_str();
  command
      .add_option("--gyroscope-noise",
                  imu.gyroscope_noise_rad_s_sqrt_hz,
                  "euroc: white noise density [rad/s/sqrt(Hz)]")
      ->capture_default_str();
  command
      .add_option("--gyroscope-walk",
                  imu.gyroscope_walk_rad_s2_sqrt_hz,
                  "euroc: random walk of the bias [rad/s^2/sqrt(Hz)]")
      ->capture_default_str();
  command
      .add_option("--accelerometer-noise",
                  imu.accelerometer_noise_m_s2_sqrt_hz,
                  "euroc: white noise density [m/s^2/sqrt(Hz)]")
      ->capture_default_str();
  command
      .add_option("--accelerometer-walk",
                  imu.accelerometer_walk_m_s3_sqrt_hz,
                  "euroc: random walk of the bias [m/s^3/sqrt(Hz)]")
      ->capture_default_str();
  return [&command] {
    const auto given = [&](const char* option) { return command.count(option) > 0; };
    return given("--imu-rate") || given("--gyroscope-noise") || given("--gyroscope-walk") ||
           given("--accelerometer-noise") || given("--accelerometer-walk");
  };
}

}  // namespace

void add_export_command(CLI::App& app, int& exit_code) {
  const auto arguments = std::make_shared<ExportArguments>();
  CLI::App* command =
      app.add_subcommand("export", "Write a run or scenario as a data set or a video");
  command->add_option("source", arguments->source, "Run folder, or scenario file (JSON)")
      ->required();
  command
      ->add_option("--format",
                   arguments->format,
                   "tum-mono, euroc, kitti, png, lcm, rosbag, mcap, or webm for only a video")
      ->required();
  command->add_option("--out", arguments->out, "Folder to create; for webm the file")->required();
  command
      ->add_option("--truth",
                   arguments->truth,
                   "Truth images of each frame: depth,range,normal,flow,world,mask")
      ->delimiter(',')
      ->allow_extra_args(false);
  command->add_option("--camera", arguments->cameras, "Only this camera; may be repeated")
      ->allow_extra_args(false);
  command->add_option("--from", arguments->from_s, "First time in the flight [s]");
  command->add_option("--to", arguments->to_s, "Last time in the flight [s]");
  command->add_option("--set", arguments->sets, "Override a field of a scenario: path=value")
      ->allow_extra_args(false);
  command
      ->add_option("--threads", arguments->threads, "Threads of the ray-caster; 0 = one per core")
      ->check(CLI::Range(0, 64));
  arguments->imu_given = add_imu_options(*command, arguments->imu);
  command
      ->add_option("--video",
                   arguments->video,
                   "Contents of a webm (default both), or of a video.webm next to the images")
      ->check(CLI::IsMember({"camera", "chase", "both"}));
  command->add_option("--video-quality", arguments->video_quality, "Quality of the video, 1 to 100")
      ->check(CLI::Range(1, 100))
      ->capture_default_str();
  command->add_flag("--json", arguments->json, "Print a summary with wall times as JSON");
  command->add_flag("--quiet", arguments->quiet, "No progress");
  command->callback([arguments, &exit_code] { exit_code = export_source(*arguments); });
}

}  // namespace overfly::app
