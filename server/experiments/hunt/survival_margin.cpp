#include "server/experiments/hunt/survival_margin.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <deque>
#include <utility>

#include "core/time.hpp"
#include "server/record/run_records.hpp"
#include "server/scoring/run_metrics_json.hpp"

namespace overfly::server::experiments {
namespace {

using evaluation::Outcome;

/// A margin of exactly 0 would belong to neither side.
constexpr double kSmallest = 0.001;
/// Points at which the factor is one half.
constexpr double kHalfPoints = 100.0;
/// Position error at which the factor is one half without a limit, as a share of the path.
constexpr double kHalfError = 0.01;
/// Limits of the outcome, as in evaluation::Outcome.
constexpr double kTrackedLimit = 0.95;
constexpr double kScaleLimit = 2.0;
constexpr double kLatestStart_s = 10.0;
constexpr double kShortestLatestStart_s = 2.0;
constexpr double kLatestStartShare = 0.1;

double latest_allowed_start_s(double duration_s) {
  return std::clamp(kLatestStartShare * duration_s, kShortestLatestStart_s, kLatestStart_s);
}

std::optional<double> position_rmse_m(const FlightEvidence& evidence, const MarginRule& rule) {
  const auto found = evidence.score.alignments.find(rule.alignment);
  if (found == evidence.score.alignments.end()) return std::nullopt;
  const double rmse_m = found->second.position_m.rmse;
  return std::isfinite(rmse_m) ? std::optional(rmse_m) : std::nullopt;
}

/// Share of the flight that a failed estimator did not survive.
double lost_share(const FlightEvidence& evidence) {
  const evaluation::Score& score = evidence.score;
  if (evidence.duration_s <= 0.0) return 1.0;
  if (score.outcome == Outcome::kInitLate) {
    return score.initialised_at_s.value_or(evidence.duration_s) / evidence.duration_s;
  }
  return 1.0 - score.outcome_time_s.value_or(0.0) / evidence.duration_s;
}

std::string failure_text(const evaluation::Score& score) {
  std::string text = evaluation::to_string(score.outcome);
  if (!score.outcome_time_s) return text;
  char time[48];
  std::snprintf(time, sizeof time, " at %.1f s", *score.outcome_time_s);
  return text + time;
}

std::vector<MarginFactor> factors_of(const FlightEvidence& evidence, const MarginRule& rule) {
  std::vector<MarginFactor> factors;
  const auto add = [&](const char* name, double share) {
    factors.push_back({name, std::clamp(share, 0.0, 1.0)});
  };
  add("tracked", (evidence.kept_share - kTrackedLimit) / (1.0 - kTrackedLimit));
  add("start",
      1.0 - evidence.score.initialised_at_s.value_or(0.0) /
                latest_allowed_start_s(evidence.duration_s));
  if (const auto& points = evidence.lowest_points) add("points", *points / (*points + kHalfPoints));
  if (const auto& change = evidence.scale_change) {
    add("scale", 1.0 - std::log(*change) / std::log(kScaleLimit));
  }
  if (const auto rmse_m = position_rmse_m(evidence, rule)) {
    if (rule.position_rmse_limit_m) {
      add("position", 1.0 - *rmse_m / *rule.position_rmse_limit_m);
    } else if (evidence.path_length_m > 0.0) {
      add("position", 1.0 / (1.0 + *rmse_m / (kHalfError * evidence.path_length_m)));
    }
  }
  return factors;
}

/// Points that carried the pose of a frame, as the estimator counts them.
std::optional<double> points_of(const EstimateRecord& record) {
  for (const char* name : {"inliers", "points", "features"}) {
    const auto found = record.counters.find(name);
    if (found != record.counters.end()) return found->second;
  }
  return std::nullopt;
}

std::optional<double> lowest_points(const EstimatorRecords& estimator) {
  constexpr std::int64_t kWindow_ns = kNsPerS / 2;
  std::deque<std::pair<std::int64_t, double>> window;
  double sum = 0.0;
  std::optional<double> lowest;
  for (const EstimateRecord& record : estimator.records) {
    if (record.dropped || record.sample.state != TrackingState::kTracking) continue;
    const std::optional<double> points = points_of(record);
    if (!points) continue;
    window.emplace_back(record.sample.t_ns, *points);
    sum += *points;
    while (window.front().first <= record.sample.t_ns - kWindow_ns) {
      sum -= window.front().second;
      window.pop_front();
    }
    const double mean = std::max(sum, 0.0) / static_cast<double>(window.size());
    lowest = std::min(lowest.value_or(mean), mean);
  }
  return lowest;
}

double kept_share_of(const RunRecords& records, const EstimatorRecords& estimator) {
  evaluation::Options options;
  options.flight = flight_frames(records, records.camera_of(estimator));
  return evaluation::kept_share(track_of(estimator), options);
}

std::optional<double> scale_change_of(const RunRecords& records,
                                      const EstimatorRecords& estimator) {
  const Result<Trajectory> truth = truth_of(records.camera_of(estimator));
  if (!truth) return std::nullopt;
  const auto matches = evaluation::associate(*truth, track_of(estimator), {});
  return matches ? evaluation::scale_change(*matches) : std::nullopt;
}

}  // namespace

SurvivalMargin margin_of(const FlightEvidence& evidence, const MarginRule& rule) {
  SurvivalMargin margin;
  const auto fail = [&](double share, const std::string& text) {
    margin.failed = true;
    margin.value = -std::clamp(share, kSmallest, 1.0);
    margin.failure = text;
  };
  if (evidence.score.outcome != Outcome::kCompleted) {
    fail(lost_share(evidence), failure_text(evidence.score));
    return margin;
  }
  const std::optional<double> rmse_m = position_rmse_m(evidence, rule);
  if (const auto& limit_m = rule.position_rmse_limit_m; limit_m && rmse_m && *rmse_m > *limit_m) {
    char text[64];
    std::snprintf(text, sizeof text, "position RMSE %.3g m", *rmse_m);
    fail(1.0 - *limit_m / *rmse_m, text);
    return margin;
  }
  margin.factors = factors_of(evidence, rule);
  margin.value = 1.0;
  for (const MarginFactor& factor : margin.factors) margin.value *= factor.share;
  margin.value = std::max(margin.value, kSmallest);
  return margin;
}

Result<FlightEvidence> read_evidence(const std::filesystem::path& run_folder,
                                     const std::string& estimator) {
  const Result<RunMetrics> metrics = read_run_metrics(run_folder);
  if (!metrics) return metrics.error();
  const Result<RunRecords> records = read_run_records(run_folder);
  if (!records) return records.error();
  const auto scored = metrics->estimators.find(estimator);
  const auto recorded = std::find_if(
      records->estimators.begin(), records->estimators.end(), [&](const EstimatorRecords& entry) {
        return entry.name == estimator;
      });
  if (scored == metrics->estimators.end() || recorded == records->estimators.end()) {
    return Error{ErrorCode::kNotFound, run_folder.string() + ": lacks estimator " + estimator};
  }
  FlightEvidence evidence;
  evidence.score = scored->second.score;
  evidence.duration_s = metrics->flight.duration_s;
  evidence.path_length_m = metrics->flight.path_length_m;
  evidence.kept_share = kept_share_of(*records, *recorded);
  evidence.lowest_points = lowest_points(*recorded);
  evidence.scale_change = scale_change_of(*records, *recorded);
  return evidence;
}

}  // namespace overfly::server::experiments
