#include "server/experiments/tables/cell_scores.hpp"

#include <algorithm>
#include <cmath>

#include "server/scenario/estimator_spec.hpp"

namespace overfly::server::experiments {
namespace {

using evaluation::AlignmentMode;
using evaluation::Outcome;

std::optional<Spread> spread_of(const std::vector<double>& values) {
  if (values.empty()) return std::nullopt;
  return Spread{values.size(), evaluation::quartiles_of(values)};
}

struct ErrorValues {
  std::size_t flights = 0;
  std::vector<double> position_m;
  std::vector<double> rotation_deg;
  std::vector<double> horizontal_m;
  std::vector<double> vertical_m;
  std::vector<double> percent_of_path;
  CellHonesty honesty;
  std::vector<double> deviation_ratios;
  std::array<std::vector<double>, kFixIntervalsM.size()> fix_medians_m;
  std::array<double, kFixIntervalsM.size()> fix_worst_m{};

  [[nodiscard]] CellErrors spreads() const {
    CellHonesty all_honesty = honesty;
    all_honesty.deviation_ratio = spread_of(deviation_ratios);
    std::array<CellFixDrift, kFixIntervalsM.size()> fix_drift;
    for (std::size_t i = 0; i < fix_drift.size(); ++i) {
      fix_drift[i] = {spread_of(fix_medians_m[i]), fix_worst_m[i]};
    }
    return {flights,
            spread_of(position_m),
            spread_of(rotation_deg),
            spread_of(horizontal_m),
            spread_of(vertical_m),
            spread_of(percent_of_path),
            all_honesty,
            fix_drift};
  }
};

void keep(std::vector<double>& values, const std::optional<double>& value) {
  if (value && std::isfinite(*value)) values.push_back(*value);
}

void add_honesty(const evaluation::AlignmentScore& score, ErrorValues& values) {
  if (!score.consistency) return;
  const auto honesty = score.consistency->honesty();
  if (!honesty) return;
  ++values.honesty.flights;
  if (*honesty == evaluation::Honesty::kOverconfident) ++values.honesty.overconfident;
  if (*honesty == evaluation::Honesty::kTooCautious) ++values.honesty.too_cautious;
  if (const auto& position = score.consistency->position) {
    keep(values.deviation_ratios, position->deviation_ratio());
  }
}

void add_fix_drift(const evaluation::AlignmentScore& score, ErrorValues& values) {
  for (const evaluation::FixDrift& drift : score.fix_drift) {
    const auto found = std::find(kFixIntervalsM.begin(), kFixIntervalsM.end(), drift.interval_m);
    if (found == kFixIntervalsM.end() || !drift.unavailable.empty()) continue;
    const auto i = static_cast<std::size_t>(found - kFixIntervalsM.begin());
    keep(values.fix_medians_m[i], drift.median_m);
    if (std::isfinite(drift.worst_m)) {
      values.fix_worst_m[i] = std::max(values.fix_worst_m[i], drift.worst_m);
    }
  }
}

void add_flight_errors(const FlightScore& flight,
                       const ErrorConvention& convention,
                       ErrorValues& values) {
  if (!convention.counts(flight)) return;
  ++values.flights;
  const auto found = flight.score.alignments.find(convention.mode);
  if (found == flight.score.alignments.end()) return;
  const evaluation::AlignmentScore& score = found->second;
  const double position_m = convention.hold ? score.position_rmse_hold_m : score.position_m.rmse;
  keep(values.position_m, position_m);
  const auto& rotation = convention.euler_norm ? score.rotation_euler_norm_deg : score.rotation_deg;
  if (rotation) keep(values.rotation_deg, rotation->rmse);
  keep(values.horizontal_m, score.horizontal_rmse_m);
  keep(values.vertical_m, score.vertical_rmse_m);
  add_honesty(score, values);
  add_fix_drift(score, values);
  if (flight.path_length_m > 0.0) {
    keep(values.percent_of_path, 100.0 * position_m / flight.path_length_m);
  }
}

/// Of one flight; nothing unless it completed and determines both scales.
std::optional<double> start_scale_percent(const FlightScore& flight) {
  const auto& alignments = flight.score.alignments;
  const auto start = alignments.find(AlignmentMode::kInitScale);
  const auto fit = alignments.find(AlignmentMode::kSim3);
  if (flight.outcome != Outcome::kCompleted || start == alignments.end() ||
      fit == alignments.end()) {
    return std::nullopt;
  }
  return 100.0 * (start->second.S_world_vo.scale / fit->second.S_world_vo.scale - 1.0);
}

/// @param flights  of one cell and estimator
CellScores scores_of(const std::vector<const FlightScore*>& flights) {
  CellScores row;
  row.cell = flights.front()->cell;
  row.estimator = flights.front()->estimator;
  std::vector<ErrorValues> values(all_conventions().size());
  std::vector<double> start_scales_percent;
  for (const FlightScore* flight : flights) {
    row.baseline = is_baseline_estimator(flight->type);
    ++row.flights;
    row.initialised += flight->score.initialised_at_s ? 1 : 0;
    row.completed += flight->outcome == Outcome::kCompleted ? 1 : 0;
    row.texture_limited = row.texture_limited || flight->texture_limited;
    ++row.outcomes[evaluation::to_string(flight->outcome)];
    row.runs.push_back(flight->run);
    keep(start_scales_percent, start_scale_percent(*flight));
    for (std::size_t i = 0; i < values.size(); ++i) {
      add_flight_errors(*flight, all_conventions()[i], values[i]);
    }
  }
  row.start_scale_percent = spread_of(start_scales_percent);
  row.success = evaluation::wilson_interval(row.completed, row.flights);
  for (const ErrorValues& of_convention : values) row.errors.push_back(of_convention.spreads());
  return row;
}

}  // namespace

bool ErrorConvention::counts(const FlightScore& flight) const {
  return completed_only ? flight.outcome == Outcome::kCompleted
                        : flight.score.initialised_at_s.has_value();
}

const std::vector<ErrorConvention>& all_conventions() {
  static const std::vector<ErrorConvention> conventions{
      {"paper",
       "Alignment init_scale (scale from the height at the first tracked pose), the last pose held "
       "to the end of the flight, rotation as the norm of the errors of roll, pitch and yaw; of "
       "flights that initialised, lost or not.",
       AlignmentMode::kInitScale,
       true,
       true,
       false},
      {"sim3",
       "Alignment sim3 (least squares), geodesic angle; of flights with the outcome COMPLETED.",
       AlignmentMode::kSim3,
       false,
       false,
       true}};
  return conventions;
}

const ErrorConvention& paper_convention() { return all_conventions()[0]; }
const ErrorConvention& sim3_convention() { return all_conventions()[1]; }

std::vector<CellScores> cell_scores(const SweepScores& scores) {
  using Flights = std::vector<const FlightScore*>;
  std::map<nlohmann::json, std::map<std::string, Flights>> flights;
  for (const FlightScore& flight : scores.flights) {
    flights[flight.cell][flight.estimator].push_back(&flight);
  }
  std::vector<CellScores> rows;
  for (const nlohmann::json& cell : scores.cells) {
    const auto of_cell = flights.find(cell);
    if (of_cell == flights.end()) continue;
    for (const std::string& estimator : scores.estimators) {
      const auto found = of_cell->second.find(estimator);
      if (found != of_cell->second.end()) rows.push_back(scores_of(found->second));
    }
  }
  return rows;
}

}  // namespace overfly::server::experiments
