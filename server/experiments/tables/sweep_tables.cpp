#include "server/experiments/tables/sweep_tables.hpp"

#include <cmath>
#include <cstdio>
#include <set>
#include <utility>

#include "core/text/number_text.hpp"

namespace overfly::server::experiments {
namespace {

using Json = nlohmann::json;

constexpr double kLeastWithExponent = 1e6;

Status check_counterparts(const SweepScores& scores, const TableOptions& options) {
  for (const auto& [own, published] : options.counterparts) {
    bool known = false;
    for (const std::string& name : scores.estimators) known = known || name == own;
    if (!known) {
      return Error{ErrorCode::kInvalidArgument, own + ": must be an estimator of the sweep"};
    }
    if (!options.published || !options.published->index_of(published)) {
      return Error{ErrorCode::kInvalidArgument, published + ": must be a published estimator"};
    }
  }
  return {};
}

/// With estimators that have the name of a published one.
std::map<std::string, std::string> all_counterparts(const SweepScores& scores,
                                                    const TableOptions& options) {
  std::map<std::string, std::string> counterparts = options.counterparts;
  for (const std::string& name : scores.estimators) {
    if (options.published->index_of(name)) counterparts.try_emplace(name, name);
  }
  return counterparts;
}

std::string axis_text(const Json& cell, const std::string& axis) {
  const auto found = cell.find(axis);
  if (found == cell.end()) return "";
  return found->is_string() ? found->get<std::string>() : found->dump();
}

Json spread_json(const std::optional<Spread>& spread) {
  if (!spread) return nullptr;
  return {{"flights", spread->flights},
          {"median", spread->quartiles.median},
          {"q1", spread->quartiles.low},
          {"q3", spread->quartiles.high}};
}

Json fix_drift_json(const CellErrors& errors) {
  Json drifts = Json::array();
  for (std::size_t i = 0; i < kFixIntervalsM.size(); ++i) {
    const CellFixDrift& drift = errors.fix_drift[i];
    if (!drift.median_m) continue;
    drifts.push_back({{"interval_m", kFixIntervalsM[i]},
                      {"median_m", spread_json(drift.median_m)},
                      {"worst_m", drift.worst_m}});
  }
  return drifts;
}

Json errors_json(const CellErrors& errors) {
  return {{"flights", errors.flights},
          {"position_m", spread_json(errors.position_m)},
          {"rotation_deg", spread_json(errors.rotation_deg)},
          {"horizontal_m", spread_json(errors.horizontal_m)},
          {"vertical_m", spread_json(errors.vertical_m)},
          {"percent_of_path", spread_json(errors.percent_of_path)},
          {"fix_drift", fix_drift_json(errors)},
          {"honesty",
           {{"flights", errors.honesty.flights},
            {"overconfident", errors.honesty.overconfident},
            {"too_cautious", errors.honesty.too_cautious},
            {"deviation_ratio", spread_json(errors.honesty.deviation_ratio)}}}};
}

const char* verdict_name(DifferenceVerdict verdict) {
  switch (verdict) {
    case DifferenceVerdict::kFirstBetter:
      return "first_better";
    case DifferenceVerdict::kSecondBetter:
      return "second_better";
    case DifferenceVerdict::kPracticallyEqual:
      return "practically_equal";
    case DifferenceVerdict::kNotDecided:
      return "not_decided";
    case DifferenceVerdict::kTooFewCells:
      break;
  }
  return "too_few_cells";
}

Json difference_json(const EstimatorDifference& result) {
  const evaluation::PairedDifference& d = result.difference;
  return {{"first", result.first},
          {"second", result.second},
          {"quantity", result.quantity},
          {"cells", d.pairs},
          {"only_first", result.only_first},
          {"only_second", result.only_second},
          {"median_difference", d.median},
          {"interval_95", {d.low, d.high}},
          {"p_value", d.p_value},
          {"p_adjusted", result.p_adjusted},
          {"verdict", verdict_name(result.verdict)}};
}

Json ordering_json(const OrderingAgreement& agreement) {
  return {{"first", agreement.first},
          {"second", agreement.second},
          {"quantity", agreement.quantity},
          {"cells", agreement.cells},
          {"same_order", agreement.same},
          {"first_better_as_published", agreement.first_better}};
}

/// A field of a CSV file (RFC 4180).
std::string csv_field(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? "\"\"" : std::string(1, c);
  return quoted + "\"";
}

std::string csv_spread(const std::optional<Spread>& spread) {
  if (!spread) return ",,,";
  return "," + number_text(spread->quartiles.median) + "," + number_text(spread->quartiles.low) +
         "," + number_text(spread->quartiles.high);
}

}  // namespace

Result<SweepTables> sweep_tables(SweepScores scores,
                                 const TableOptions& options,
                                 const std::atomic<bool>* cancel) {
  if (Status status = check_counterparts(scores, options); !status) return status.error();
  SweepTables tables;
  tables.rows = cell_scores(scores);
  for (std::size_t i = 0; i < all_conventions().size(); ++i) {
    Result<std::vector<EstimatorDifference>> differences =
        estimator_differences(tables.rows, scores.estimators, i, options.differences, cancel);
    if (!differences) return differences.error();
    tables.differences.push_back(std::move(*differences));
    tables.orderings.push_back(
        options.published
            ? ordering_agreements(
                  tables.rows, i, *options.published, all_counterparts(scores, options))
            : std::vector<OrderingAgreement>());
  }
  tables.scores = std::move(scores);
  return tables;
}

std::string error_number(double value) {
  if (!std::isfinite(value)) return "-";
  char text[64];
  const double size = std::abs(value);
  if (size >= kLeastWithExponent) {
    std::snprintf(text, sizeof text, "%.2e", value);
    return text;
  }
  // Decimals that leave three significant digits of what is shown.
  int decimals = 0;
  if (size > 0.0 && size < 99.95) {
    decimals = std::min(9, 2 - static_cast<int>(std::floor(std::log10(size * (1.0 + 5e-4)))));
  }
  std::snprintf(text, sizeof text, "%.*f", size == 0.0 ? 0 : decimals, value);
  return text;
}

std::string csv_from(const SweepTables& tables) {
  std::string text;
  for (const ShownAxis& axis : tables.scores.axes) text += csv_field(axis.name) + ",";
  text += "estimator,convention,flights,initialised,completed,success_low_95,success_high_95";
  for (const char* name :
       {"position_m", "rotation_deg", "horizontal_m", "vertical_m", "percent_of_path"}) {
    for (const char* part : {"median", "q1", "q3"}) text += std::string(",") + name + "_" + part;
  }
  text += ",outcomes,covariance_flights,overconfident,too_cautious,deviation_ratio_median";
  for (const double interval_m : kFixIntervalsM) {
    const std::string name = ",fix_drift_" + number_text(interval_m) + "m_";
    text += name + "median" + name + "worst";
  }
  text += ",start_scale_percent_median\n";
  for (const CellScores& row : tables.rows) {
    for (std::size_t i = 0; i < row.errors.size(); ++i) {
      for (const ShownAxis& axis : tables.scores.axes) {
        text += csv_field(axis_text(row.cell, axis.name)) + ",";
      }
      text += csv_field(row.estimator) + "," + all_conventions()[i].name + "," +
              std::to_string(row.flights) + "," + std::to_string(row.initialised) + "," +
              std::to_string(row.completed) + "," + number_text(row.success.low) + "," +
              number_text(row.success.high);
      const CellErrors& errors = row.errors[i];
      text += csv_spread(errors.position_m) + csv_spread(errors.rotation_deg) +
              csv_spread(errors.horizontal_m) + csv_spread(errors.vertical_m) +
              csv_spread(errors.percent_of_path);
      std::string outcomes;
      for (const auto& [name, count] : row.outcomes) {
        outcomes += (outcomes.empty() ? "" : " ") + name + ":" + std::to_string(count);
      }
      const CellHonesty& honesty = errors.honesty;
      text +=
          "," + outcomes + "," + std::to_string(honesty.flights) + "," +
          std::to_string(honesty.overconfident) + "," + std::to_string(honesty.too_cautious) + "," +
          (honesty.deviation_ratio ? number_text(honesty.deviation_ratio->quartiles.median) : "");
      for (const CellFixDrift& drift : errors.fix_drift) {
        text += drift.median_m ? "," + number_text(drift.median_m->quartiles.median) + "," +
                                     number_text(drift.worst_m)
                               : ",,";
      }
      text += ",";
      if (row.start_scale_percent) {
        text += number_text(row.start_scale_percent->quartiles.median);
      }
      text += "\n";
    }
  }
  return text;
}

Json json_from(const SweepTables& tables) {
  Json rows = Json::array();
  for (const CellScores& row : tables.rows) {
    Json errors = Json::object();
    for (std::size_t i = 0; i < row.errors.size(); ++i) {
      errors[all_conventions()[i].name] = errors_json(row.errors[i]);
    }
    rows.push_back({{"cell", row.cell},
                    {"estimator", row.estimator},
                    {"baseline", row.baseline},
                    {"flights", row.flights},
                    {"initialised", row.initialised},
                    {"completed", row.completed},
                    {"success_rate_95", {row.success.low, row.success.high}},
                    {"texture_limited", row.texture_limited},
                    {"outcomes", row.outcomes},
                    {"start_scale_percent", spread_json(row.start_scale_percent)},
                    {"errors", std::move(errors)},
                    {"runs", row.runs}});
  }
  Json conventions = Json::object();
  for (std::size_t i = 0; i < all_conventions().size(); ++i) {
    Json differences = Json::array();
    for (const auto& result : tables.differences[i]) differences.push_back(difference_json(result));
    Json orderings = Json::array();
    for (const auto& agreement : tables.orderings[i]) orderings.push_back(ordering_json(agreement));
    conventions[all_conventions()[i].name] = {{"words", all_conventions()[i].words},
                                              {"differences", std::move(differences)},
                                              {"orderings", std::move(orderings)}};
  }
  return {{"title", tables.scores.title},
          {"version", tables.scores.version},
          {"failed", tables.scores.failed},
          {"former_results", tables.scores.former_results},
          {"problems", tables.scores.problems},
          {"rows", std::move(rows)},
          {"conventions", std::move(conventions)}};
}

}  // namespace overfly::server::experiments
