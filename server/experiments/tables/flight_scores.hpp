// The flights of a sweep's folder with their scores.
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "evaluation/evaluation.hpp"

namespace overfly::server::experiments {

/// One completed flight of one estimator.
struct FlightScore {
  nlohmann::json cell;  ///< axis name -> value
  int repeat = 0;
  std::string estimator;
  std::string type;  ///< of the estimator
  std::string run;   ///< its run folder, relative to the sweep's
  double path_length_m = 0.0;
  bool texture_limited = false;
  evaluation::Outcome outcome = evaluation::Outcome::kNotInitialised;
  evaluation::Score score;
};

struct ShownAxis {
  std::string name;   ///< as in FlightScore::cell
  std::string label;  ///< for people
  std::string unit;   ///< may be empty
};

struct SweepScores {
  std::string title;
  std::string version;  ///< of the program that flew last
  std::vector<ShownAxis> axes;
  std::vector<std::string> estimators;  ///< names, in the sweep's order
  /// Of the flights, in ascending order of the axes' values; texts in the sweep's order.
  std::vector<nlohmann::json> cells;
  std::vector<FlightScore> flights;
  std::size_t failed = 0;             ///< flights without a result
  std::size_t former_results = 0;     ///< of flights that the sweep no longer has; left out
  std::vector<std::string> problems;  ///< what cannot be read and is left out, with the reason
};

/// Reads sweep.json, results.jsonl and the metrics of the newest result of every flight.
/// Errors: as read_json and SweepResults::read; kNotFound if the folder has no result; kCancelled.
[[nodiscard]] Result<SweepScores> read_sweep_scores(const std::filesystem::path& folder,
                                                    const std::atomic<bool>* cancel = nullptr);

}  // namespace overfly::server::experiments
