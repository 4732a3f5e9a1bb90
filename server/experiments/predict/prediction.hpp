// What `overfly predict` answers about a scenario.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "server/experiments/predict/features/features.hpp"

namespace overfly::server::predict {

/// Risks of an instant and of a place are stated for so long a time of equal conditions [s].
inline constexpr double kRiskSpanS = 10.0;
/// The model was fitted to flights of 10 s. It ranks parts of longer flights, but its hazards are
/// too high to add up to the probability of a whole one.
inline constexpr double kLongestJudgedS = 20.0;

struct PredictedInstant {
  double t_s = 0.0;
  double east_m = 0.0;  ///< world frame
  double north_m = 0.0;
  double height_agl_m = 0.0;
  Features features;
  Inputs window{};           ///< of the risk model
  Inputs contributions{};    ///< to the log odds
  double risk = 0.0;         ///< of a loss within kRiskSpanS of such conditions
  double risk_so_far = 0.0;  ///< of a loss since the start
};

/// Risk of straight and level flight at the mission's height over the ground, by place.
struct RiskMap {
  double west_m = 0.0;  ///< world frame: the south-west corner
  double south_m = 0.0;
  double cell_m = 100.0;
  std::size_t columns = 0;  ///< to the east
  std::size_t rows = 0;     ///< to the north
  double height_agl_m = 0.0;
  double speed_m_s = 0.0;
  double heading_deg = 0.0;  ///< clockwise from north
  /// Row by row from the south-west; empty where there is no imagery.
  std::vector<std::optional<double>> risk;
  std::vector<Features> features;  ///< likewise; meaningless where there is no risk

  [[nodiscard]] std::size_t index(std::size_t column, std::size_t row) const {
    return row * columns + column;
  }
};

struct Prediction {
  std::string scenario;
  std::string title;
  std::string camera;
  std::string flight;  ///< TruthSource::description
  double duration_s = 0.0;
  double length_m = 0.0;
  double step_s = 0.0;
  double image_width_px = 0.0;
  /// Of a loss in the flight; empty if it is longer than kLongestJudgedS.
  std::optional<double> risk;
  std::vector<PredictedInstant> instants;
  std::optional<RiskMap> map;
  std::vector<std::string> warnings;  ///< of world and flight
};

}  // namespace overfly::server::predict
