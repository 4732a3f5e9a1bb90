// overfly evaluate: scores trajectory files, or scores a run folder again.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <iomanip>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "core/motion/trajectory_io.hpp"
#include "core/time.hpp"
#include "evaluation/offsets.hpp"
#include "server/app/commands/commands.hpp"
#include "server/app/exit_code.hpp"
#include "server/app/score_table.hpp"
#include "server/files/whole_file.hpp"
#include "server/record/run_folder.hpp"
#include "server/record/run_info_file.hpp"
#include "server/record/run_lock.hpp"
#include "server/record/run_records.hpp"
#include "server/scoring/file_score.hpp"
#include "server/scoring/metrics.hpp"
#include "server/scoring/run_metrics_json.hpp"

namespace overfly::app {
namespace {

using Json = nlohmann::json;

struct EvaluateArguments {
  std::string truth;
  std::vector<std::string> estimates;
  std::string run;
  std::vector<std::string> alignments;
  std::string association = "interpolate";
  double max_time_difference_ms = 10.0;
  double init_true_depth_m = 0.0;
  bool find_offsets = false;
  bool json = false;
};

/// Keeps only the requested modes.
void choose_modes(const std::vector<std::string>& wanted, evaluation::Score& score) {
  const auto unwanted = [&](const auto& entry) {
    const std::string mode = evaluation::to_string(entry.first);
    return std::find(wanted.begin(), wanted.end(), mode) == wanted.end();
  };
  std::erase_if(score.alignments, unwanted);
  std::erase_if(score.unavailable, unwanted);
}

void print_warnings(const std::vector<std::string>& warnings) {
  for (const std::string& warning : warnings) std::cerr << "warning: " << warning << "\n";
}

server::FileScoreRequest request_from(const EvaluateArguments& arguments) {
  server::FileScoreRequest request;
  for (const std::string& name : arguments.alignments) {
    if (const auto mode = evaluation::alignment_mode_from(name)) {
      request.alignments.push_back(*mode);
    }
  }
  if (arguments.association == "nearest") request.association = evaluation::Association::kNearest;
  if (arguments.association == "index") request.association = evaluation::Association::kIndex;
  request.max_time_difference_ns =
      static_cast<std::int64_t>(arguments.max_time_difference_ms * 1e6);
  if (arguments.init_true_depth_m > 0.0) request.init_true_depth_m = arguments.init_true_depth_m;
  request.find_offsets = arguments.find_offsets;
  return request;
}

/// One line for each offset that explains errors.
std::string offsets_text(const evaluation::Offsets& offsets) {
  std::ostringstream text;
  text << std::fixed << std::setprecision(4);
  if (!offsets.clock && !offsets.mount)
    text << "  no offset of clock or mount explains the errors\n";
  if (const auto& clock = offsets.clock) {
    text << "  clock: the estimate's times are " << std::abs(s_from_ns(clock->offset_ns))
         << (clock->offset_ns < 0 ? " s late" : " s early") << "; this explains "
         << std::setprecision(1) << 100.0 * clock->explained
         << " % of the position error after sim3 (" << std::setprecision(3)
         << clock->position_rmse_before_m << " -> " << clock->position_rmse_after_m << " m)\n";
  }
  if (const auto& mount = offsets.mount) {
    const double angle_rad =
        rotation_angle_rad(mount->R_estimated_true, Eigen::Quaterniond::Identity());
    text << std::setprecision(3) << "  mount: a constant rotation of " << deg_from_rad(angle_rad)
         << " deg explains " << std::setprecision(1) << 100.0 * mount->explained
         << " % of the rotation error after sim3 (" << std::setprecision(3)
         << mount->rotation_rmse_before_deg << " -> " << mount->rotation_rmse_after_deg
         << " deg)\n";
  }
  return text.str();
}

/// Scores one file and prints the result as people read it.
Result<server::FileScore> evaluate_file(const EvaluateArguments& arguments,
                                        const server::NamedTrajectory& truth,
                                        const std::string& name) {
  const Result<TrajectoryFile> file = read_trajectory(name);
  if (!file) return file.error();
  Result<server::FileScore> score =
      server::score_file(truth, {name, *file}, request_from(arguments));
  print_warnings(score ? score->warnings : file->warnings);
  if (!score || arguments.json) return score;
  std::cout << name << "\n" << alignment_table(score->score);
  if (score->offsets) std::cout << offsets_text(*score->offsets);
  return score;
}

Json entry_of(const std::string& name, const Result<server::FileScore>& score) {
  if (!score) {
    const Json error = {{"code", to_string(score.error().code)},
                        {"message", score.error().message}};
    return {{"file", name}, {"error", error}};
  }
  Json entry = server::json_from(*score);
  entry["file"] = name;
  return entry;
}

/// @return the exit code of the first file that cannot be scored; a failure if none of the
/// alignments of a file can be determined
int evaluate_files(const EvaluateArguments& arguments) {
  const Result<TrajectoryFile> truth = read_trajectory(arguments.truth);
  if (!truth) return report(truth.error());
  print_warnings(truth->warnings);
  Json estimates = Json::array();
  int error_code = kExitOk;
  bool scored = true;
  for (const std::string& name : arguments.estimates) {
    const auto score = evaluate_file(arguments, {arguments.truth, *truth}, name);
    if (score) {
      scored = scored && !score->score.alignments.empty();
    } else {
      const int code = report(score.error());
      if (error_code == kExitOk) error_code = code;
    }
    if (arguments.json) estimates.push_back(entry_of(name, score));
  }
  if (arguments.json) {
    const Json result = {{"truth", arguments.truth},
                         {"association", arguments.association},
                         {"warnings", truth->warnings},
                         {"estimates", std::move(estimates)}};
    std::cout << result.dump(2) << "\n";
  }
  if (error_code != kExitOk) return error_code;
  return scored ? kExitOk : kExitFailure;
}

void print_run(const EvaluateArguments& arguments,
               const server::RunInfo& info,
               server::RunMetrics metrics) {
  if (!arguments.json && info.status != server::RunStatus::kCompleted) {
    std::cout << "the run is " << server::to_string(info.status) << "\n";
  }
  for (auto& [name, estimator] : metrics.estimators) {
    choose_modes(arguments.alignments, estimator.score);
    if (arguments.json) continue;
    std::cout << name << ": " << outcome_line(estimator.score) << "\n"
              << alignment_table(estimator.score);
  }
  if (!arguments.json) return;
  Json document = server::json_from(metrics);
  document["status"] = server::to_string(info.status);
  std::cout << document.dump(2) << "\n";
}

int evaluate_run(const EvaluateArguments& arguments) {
  // Read before the lock is taken: the lock would make an interrupted run appear to be running.
  const Result<server::RunInfo> info = server::read_run_info(arguments.run);
  if (!info) return report(info.error());
  if (!info->problem.empty()) std::cerr << "warning: " << info->problem << "\n";
  // The scores are printed even if nothing can be written.
  const Result<server::RunLock> lock = server::RunLock::take(arguments.run);
  if (!lock && lock.error().code == ErrorCode::kConflict) return report(lock.error());
  const Result<server::RunRecords> records = server::read_run_records(arguments.run);
  if (!records) return report(records.error());
  const server::RunMetrics metrics = server::metrics_from(*records);
  print_run(arguments, *info, metrics);
  if (!lock) return report(lock.error());
  // An interrupted run has none.
  const Status drawn = server::write_trajectories(arguments.run, *records);
  if (!drawn) return report(drawn.error());
  const Status written =
      server::write_json(server::metrics_file(arguments.run), server::json_from(metrics));
  return written ? kExitOk : report(written.error());
}

int evaluate(EvaluateArguments arguments) {
  const std::vector<std::string>& modes = arguments.alignments;
  if (std::find(modes.begin(), modes.end(), "all") != modes.end()) {
    arguments.alignments = alignment_mode_names();
  }
  if (!arguments.run.empty()) return evaluate_run(arguments);
  if (arguments.truth.empty() || arguments.estimates.empty()) {
    return report(
        {ErrorCode::kInvalidArgument, "--truth and --estimate must be given, or only --run"});
  }
  return evaluate_files(arguments);
}

}  // namespace

void add_evaluate_command(CLI::App& app, int& exit_code) {
  const auto arguments = std::make_shared<EvaluateArguments>();
  CLI::App* command = app.add_subcommand("evaluate", "Score trajectories against the truth");
  command->add_option("--truth", arguments->truth, "Trajectory file: TUM, KITTI, EuRoC or CSV");
  command->add_option("--estimate", arguments->estimates, "Trajectory files to score");
  CLI::Option* const run =
      command
          ->add_option("--run",
                       arguments->run,
                       "Run folder to score again; its metrics.json and *.tum are written")
          ->excludes("--truth")
          ->excludes("--estimate");
  std::vector<std::string> modes = alignment_mode_names();
  modes.emplace_back("all");
  arguments->alignments = {"init_scale"};
  command
      ->add_option("--alignment", arguments->alignments, "Alignment of the estimate to the truth")
      ->check(CLI::IsMember(modes))
      ->capture_default_str();
  command->add_option("--association", arguments->association, "How poses are matched in time")
      ->check(CLI::IsMember({"interpolate", "nearest", "index"}))
      ->excludes(run)
      ->capture_default_str();
  command
      ->add_option("--max-time-difference-ms",
                   arguments->max_time_difference_ms,
                   "Limit for --association nearest")
      ->check(CLI::Range(0.0, 1e9))
      ->excludes(run)
      ->capture_default_str();
  command
      ->add_option("--init-true-depth-m",
                   arguments->init_true_depth_m,
                   "True depth along the optical axis at the first pose, for init_scale; by "
                   "default the comment init_true_depth of the estimate's file")
      ->check(CLI::PositiveNumber)
      ->excludes(run);
  command
      ->add_flag("--find-offsets",
                 arguments->find_offsets,
                 "Also look for offsets of the clock and of the camera's mount that explain "
                 "errors")
      ->excludes(run);
  command->add_flag("--json", arguments->json, "Print JSON");
  command->callback([arguments, &exit_code] { exit_code = evaluate(*arguments); });
}

}  // namespace overfly::app
