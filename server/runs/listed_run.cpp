#include "server/runs/listed_run.hpp"

#include <string>
#include <utility>

#include "evaluation/evaluation.hpp"
#include "server/record/run_info_file.hpp"
#include "server/runs/run_notes.hpp"
#include "server/scoring/run_metrics_json.hpp"

namespace overfly::server {
namespace {

EstimatorResult result_of(const std::string& name,
                          const EstimatorMetrics& metrics,
                          double path_length_m) {
  EstimatorResult result;
  result.estimator = name;
  result.outcome = metrics.score.outcome;
  const auto& alignments = metrics.score.alignments;
  const auto aligned = alignments.find(evaluation::AlignmentMode::kInitScale);
  if (aligned == alignments.end()) return result;
  const double rmse_m = aligned->second.position_m.rmse;
  result.position_rmse_m = rmse_m;
  if (path_length_m > 0.0) result.position_rmse_percent = 100.0 * rmse_m / path_length_m;
  return result;
}

void add_problem(const Error& error, RunInfo& info) {
  if (info.problem.empty()) info.problem = error.message;
}

}  // namespace

Result<RunInfo> read_listed_run(const std::filesystem::path& folder) {
  Result<RunInfo> info = read_run_info(folder);
  if (!info) return info.error();
  if (const Result<RunMetrics> metrics = read_run_metrics(folder, kMostListedBytes)) {
    for (const auto& [name, of_estimator] : metrics->estimators) {
      // A run that failed before its first frame says nothing about its estimators.
      if (info->frames == 0) break;
      info->results.push_back(result_of(name, of_estimator, metrics->flight.path_length_m));
    }
  } else if (metrics.error().code != ErrorCode::kNotFound) {
    add_problem(metrics.error(), *info);
  }
  if (Result<RunNotes> notes = read_notes(folder)) {
    info->tags = std::move(notes->tags);
    info->note = std::move(notes->note);
  } else {
    add_problem(notes.error(), *info);
  }
  return info;
}

}  // namespace overfly::server
