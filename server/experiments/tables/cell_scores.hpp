// The flights of each cell and estimator together: outcomes, success rate, errors.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "evaluation/statistics/sample_quantile.hpp"
#include "evaluation/statistics/wilson.hpp"
#include "server/experiments/tables/flight_scores.hpp"

namespace overfly::server::experiments {

/// How errors are taken, and from which flights.
struct ErrorConvention {
  std::string name;
  std::string words;  ///< one sentence for the reader of a table
  evaluation::AlignmentMode mode = evaluation::AlignmentMode::kSim3;
  bool hold = false;        ///< the last pose is held to the end of the flight
  bool euler_norm = false;  ///< rotation: norm of roll, pitch and yaw; else the geodesic angle
  /// Only flights with the outcome COMPLETED; else every flight that initialised.
  bool completed_only = true;

  [[nodiscard]] bool counts(const FlightScore& flight) const;
};

/// As the paper seems to have scored: scale from the height at initialisation, every flight that
/// initialised, the last pose held, Euler norm.
[[nodiscard]] const ErrorConvention& paper_convention();
/// Sim(3) alignment of completed flights, geodesic angle.
[[nodiscard]] const ErrorConvention& sim3_convention();
/// Both, in this order.
[[nodiscard]] const std::vector<ErrorConvention>& all_conventions();

/// Values of the flights that count; a flight without the value is not one of them.
struct Spread {
  std::size_t flights = 0;
  evaluation::Quartiles quartiles;
};

/// Of the flights whose estimator states covariances.
struct CellHonesty {
  std::size_t flights = 0;
  std::size_t overconfident = 0;
  std::size_t too_cautious = 0;
  /// Of the position: by which factor its errors exceed the stated standard deviations.
  std::optional<Spread> deviation_ratio;
};

/// Distances between position fixes whose drift the tables show [m].
inline constexpr std::array<double, 3> kFixIntervalsM = {1000.0, 2000.0, 5000.0};

/// Drift between position fixes, of the flights whose path is long enough.
struct CellFixDrift {
  std::optional<Spread> median_m;  ///< of the flights' medians
  double worst_m = 0.0;            ///< of all of these flights
};

/// Empty where no flight counts: an X enters no mean.
struct CellErrors {
  std::size_t flights = 0;  ///< that count, whether the alignment determines their errors or not
  std::optional<Spread> position_m;
  std::optional<Spread> rotation_deg;
  std::optional<Spread> horizontal_m;  ///< without holding the last pose
  std::optional<Spread> vertical_m;    ///< without holding the last pose
  std::optional<Spread> percent_of_path;
  CellHonesty honesty;
  std::array<CellFixDrift, kFixIntervalsM.size()> fix_drift;  ///< as kFixIntervalsM
};

struct CellScores {
  nlohmann::json cell;
  std::string estimator;
  bool baseline = false;  ///< of a type that exists to be beaten
  int flights = 0;
  int initialised = 0;
  int completed = 0;
  bool texture_limited = false;         ///< of any flight
  std::map<std::string, int> outcomes;  ///< name -> flights
  evaluation::ShareInterval success;    ///< of the success rate, 95 %
  std::vector<std::string> runs;
  /// Of completed flights: by how much init_scale's scale is larger than that of sim3 [%].
  std::optional<Spread> start_scale_percent;
  std::vector<CellErrors> errors;  ///< as all_conventions()
};

/// Every cell, with every estimator that flew in it, in the order of SweepScores.
[[nodiscard]] std::vector<CellScores> cell_scores(const SweepScores& scores);

}  // namespace overfly::server::experiments
