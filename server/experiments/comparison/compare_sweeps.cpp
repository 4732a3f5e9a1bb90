#include "server/experiments/comparison/compare_sweeps.hpp"

#include <cmath>
#include <map>
#include <set>
#include <system_error>
#include <utility>

#include "core/cancel.hpp"
#include "core/text/number_text.hpp"
#include "server/experiments/sweep_document.hpp"
#include "server/experiments/sweep_extent.hpp"
#include "server/experiments/sweep_results.hpp"
#include "server/files/whole_file.hpp"
#include "server/scoring/run_metrics_json.hpp"

namespace overfly::server::experiments {
namespace {

namespace fs = std::filesystem;

using ResultsByFlight = std::map<std::string, const SweepResult*>;

/// Of the sweep's file; without one every result counts.
SweepExtent extent_of(const fs::path& sweep) {
  const Result<nlohmann::json> document = read_json(sweep / "sweep.json", kMaxSweepBytes);
  return SweepExtent(document ? *document : nlohmann::json());
}

/// Errors: kNotFound for a folder that is no sweep; as SweepResults::read.
Result<SweepResults> results_of(const fs::path& sweep) {
  std::error_code ignored;
  if (!fs::exists(sweep / "sweep.json", ignored) && !fs::exists(sweep / "results.jsonl", ignored)) {
    return Error{ErrorCode::kNotFound,
                 sweep.string() + ": is no folder of a sweep (sweep.json is missing)"};
  }
  return SweepResults::read(sweep);
}

/// A sweep without any result has no estimator that could be unknown.
Status check_estimator(const std::string& estimator,
                       const fs::path& sweep,
                       const SweepResults& results) {
  std::set<std::string> known;
  for (const SweepResult* result : results.newest()) known.insert(result->estimator);
  if (estimator.empty() || known.empty() || known.contains(estimator)) return {};
  std::string names;
  for (const std::string& name : known) names += (names.empty() ? "" : ", ") + name;
  return Error{ErrorCode::kNotFound,
               sweep.string() + ": has no estimator " + estimator + " (known: " + names + ")"};
}

/// Completed flights by what they have in common with the other sweep's.
ResultsByFlight results_by_flight(const SweepResults& results,
                                  const SweepExtent& extent,
                                  const std::string& estimator,
                                  std::size_t& failed) {
  ResultsByFlight by_flight;
  for (const SweepResult* result : results.newest()) {
    if (!extent.contains(*result)) continue;
    if (!estimator.empty() && result->estimator != estimator) continue;
    if (!result->completed()) {
      ++failed;
      continue;
    }
    const nlohmann::json identity = {result->cell, result->repeat, result->seed, result->estimator};
    by_flight.insert_or_assign(identity.dump(), result);
  }
  return by_flight;
}

/// What conditions may ask of one flight, as far as it has it: errors only of a success.
Result<std::map<std::string, double>> values_of(const fs::path& sweep,
                                                const SweepResult& result,
                                                evaluation::AlignmentMode mode) {
  const Result<RunMetrics> metrics = read_run_metrics(sweep / result.run);
  if (!metrics) return metrics.error();
  const auto estimator = metrics->estimators.find(result.estimator);
  if (estimator == metrics->estimators.end()) {
    return Error{ErrorCode::kUnreadable,
                 (sweep / result.run).string() + ": has no estimator " + result.estimator};
  }
  const evaluation::Score& score = estimator->second.score;
  const bool success = result.outcome == evaluation::Outcome::kCompleted;
  std::map<std::string, double> values{{"success_rate", success ? 1.0 : 0.0},
                                       {"coverage", score.coverage},
                                       {"reset_count", score.reset_count}};
  if (score.initialised_at_s) values["initialised_at_s"] = *score.initialised_at_s;
  const auto alignment = score.alignments.find(mode);
  if (alignment != score.alignments.end()) {
    if (alignment->second.position_auc) values["position_auc"] = *alignment->second.position_auc;
  } else if (score.position_auc_limit_m) {
    values["position_auc"] = 0.0;  // No pose of it could be aligned.
  }
  if (!success || alignment == score.alignments.end()) return values;
  values["position_rmse_m"] = alignment->second.position_m.rmse;
  values["position_rmse_hold_m"] = alignment->second.position_rmse_hold_m;
  if (alignment->second.rotation_deg) {
    values["rotation_rmse_deg"] = alignment->second.rotation_deg->rmse;
  }
  std::erase_if(values, [](const auto& value) { return !std::isfinite(value.second); });
  return values;
}

/// Takes what both flights of a pair have: an estimator that is lost on hard flights must not seem
/// more accurate for it.
Status add_pair(const Result<std::map<std::string, double>>& flight,
                const Result<std::map<std::string, double>>& reference,
                PairedSweeps& paired) {
  if (!flight) return flight.error();
  if (!reference) return reference.error();
  for (const auto& [name, value] : *flight) {
    const auto other = reference->find(name);
    if (other == reference->end()) continue;
    paired.flights[name].push_back(value);
    paired.baseline[name].push_back(other->second);
  }
  return {};
}

std::string xml_text(const std::string& text) {
  std::string safe;
  for (const char c : text) {
    if (c == '&') {
      safe += "&amp;";
    } else if (c == '<') {
      safe += "&lt;";
    } else if (c == '>') {
      safe += "&gt;";
    } else if (c == '"') {
      safe += "&quot;";
    } else {
      safe += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
    }
  }
  return safe;
}

}  // namespace

Result<PairedSweeps> pair_sweeps(const fs::path& sweep,
                                 const fs::path& baseline,
                                 const std::string& estimator,
                                 evaluation::AlignmentMode mode,
                                 const std::atomic<bool>* cancel) {
  const Result<SweepResults> first = results_of(sweep);
  if (!first) return first.error();
  const Result<SweepResults> second = results_of(baseline);
  if (!second) return second.error();
  for (const auto& [folder, results] : {std::pair(sweep, &*first), std::pair(baseline, &*second)}) {
    if (Status status = check_estimator(estimator, folder, *results); !status) {
      return status.error();
    }
  }
  PairedSweeps paired;
  const ResultsByFlight flights =
      results_by_flight(*first, extent_of(sweep), estimator, paired.failed);
  const ResultsByFlight references =
      results_by_flight(*second, extent_of(baseline), estimator, paired.failed);
  for (const auto& [flight, result] : flights) {
    if (is_cancelled(cancel)) return Error{ErrorCode::kCancelled, "cancelled"};
    const auto reference = references.find(flight);
    if (reference == references.end()) continue;
    ++paired.pairs;
    const Status status = add_pair(
        values_of(sweep, *result, mode), values_of(baseline, *reference->second, mode), paired);
    if (!status) return status.error();
  }
  paired.without_pair = flights.size() + references.size() - 2 * paired.pairs;
  return paired;
}

Result<std::vector<JudgedCondition>> judged_conditions(const std::vector<std::string>& texts,
                                                       const PairedSweeps& paired) {
  std::vector<JudgedCondition> judged;
  for (const std::string& text : texts) {
    const Result<Condition> condition = Condition::parse(text);
    if (!condition) return condition.error();
    judged.push_back({text, condition->evaluate(paired.flights, paired.baseline)});
  }
  return judged;
}

std::string junit_from(const std::vector<JudgedCondition>& conditions) {
  std::size_t failures = 0;
  std::size_t errors = 0;
  std::string cases;
  for (const JudgedCondition& condition : conditions) {
    cases += "  <testcase classname=\"overfly.compare\" name=\"" + xml_text(condition.text) + "\"";
    if (!condition.verdict) {
      ++errors;
      cases +=
          "><error message=\"" + xml_text(condition.verdict.error().message) + "\"/></testcase>\n";
    } else if (condition.verdict->holds) {
      ++failures;
      cases += "><failure message=\"" + number_text(condition.verdict->left) + " against " +
               number_text(condition.verdict->right) + "\"/></testcase>\n";
    } else {
      cases += "/>\n";
    }
  }
  return "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuite name=\"overfly compare\" "
         "tests=\"" +
         std::to_string(conditions.size()) + "\" failures=\"" + std::to_string(failures) +
         "\" errors=\"" + std::to_string(errors) + "\">\n" + cases + "</testsuite>\n";
}

}  // namespace overfly::server::experiments
