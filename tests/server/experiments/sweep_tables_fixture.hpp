// Tables of a folder of made-up results.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "server/experiments/tables/sweep_tables.hpp"
#include "server/scoring/run_metrics_json.hpp"
#include "tests/support/support.hpp"

namespace overfly::server::experiments {

class SweepTablesTest : public ::testing::Test {
 protected:
  static constexpr double kPathM = 1000.0;

  /// What one estimator does in one flight. Without a position error it does not initialise.
  struct Made {
    std::string estimator;
    double height_m = 0.0;
    int repeat = 0;
    std::optional<double> position_m;
    std::optional<double> rotation_deg;
    evaluation::Outcome outcome = evaluation::Outcome::kCompleted;
    std::string type = "process";
    std::vector<double> nees = {};  ///< of the positions, if it states covariances
    std::vector<evaluation::FixDrift> fix_drift = {};
    bool moves = true;         ///< false: Sim(3) does not determine its errors
    double start_scale = 1.0;  ///< of init_scale; that of Sim(3) is 1
    std::string light = {};    ///< value of a second axis; empty: there is none
  };

  void SetUp() override {
    std::ofstream(folder_ / "sweep.json") << nlohmann::json{
        {"title", "Made | up"},
        {"version", "0.1 abc"},
        {"axes", nlohmann::json::array({{{"path", "h"}, {"label", "Height"}, {"unit", "m"}}})},
        {"estimator_names", {"one", "two", "hold"}}};
  }

  void add(const Made& made, const std::string& key = "", std::uint64_t first_seed = 1) {
    const std::string id =
        key.empty() ? "r" + std::to_string(number_) : key + std::to_string(number_);
    ++number_;
    RunMetrics metrics;
    metrics.flight.path_length_m = kPathM;
    EstimatorMetrics& estimator = metrics.estimators[made.estimator];
    estimator.type = made.type;
    estimator.score.outcome = made.outcome;
    if (made.position_m) {
      estimator.score.initialised_at_s = 1.0;
      estimator.score.alignments[evaluation::AlignmentMode::kInitScale] =
          alignment(evaluation::AlignmentMode::kInitScale, made, 1.0);
      if (made.moves) {
        estimator.score.alignments[evaluation::AlignmentMode::kSim3] =
            alignment(evaluation::AlignmentMode::kSim3, made, 0.1);
      }
      estimator.score.alignments[evaluation::AlignmentMode::kInitScale].S_world_vo.scale =
          made.start_scale;
    }
    std::filesystem::create_directories(folder_ / "runs" / id);
    std::ofstream(folder_ / "runs" / id / "metrics.json") << json_from(metrics);
    nlohmann::json cell = {{"h", made.height_m}};
    if (!made.light.empty()) cell["light"] = made.light;
    std::ofstream(folder_ / "results.jsonl", std::ios::app)
        << nlohmann::json{{"key", id},
                          {"cell", cell},
                          {"repeat", made.repeat},
                          {"seed", first_seed + static_cast<std::uint64_t>(made.repeat)},
                          {"estimator", made.estimator},
                          {"run", "runs/" + id},
                          {"status", "completed"},
                          {"error", ""},
                          {"outcome", evaluation::to_string(made.outcome)},
                          {"duration_s", 1.0}}
        << "\n";
  }

  SweepTables tables(const TableOptions& options = {}) {
    Result<SweepScores> scores = read_sweep_scores(folder_);
    EXPECT_TRUE(scores) << (scores ? "" : scores.error().message);
    Result<SweepTables> tables = sweep_tables(std::move(*scores), options);
    EXPECT_TRUE(tables) << (tables ? "" : tables.error().message);
    return std::move(*tables);
  }
  std::string markdown(const TableOptions& options = {}) {
    return markdown_from(document_from(tables(options), options));
  }

  overfly::testing::TemporaryFolder temporary_;
  const std::filesystem::path folder_ = temporary_.path();
  int number_ = 0;

 private:
  static evaluation::AlignmentScore alignment(evaluation::AlignmentMode mode,
                                              const Made& made,
                                              double factor) {
    evaluation::AlignmentScore score;
    score.mode = mode;
    score.position_m.rmse = factor * *made.position_m;
    score.position_rmse_hold_m = 2.0 * score.position_m.rmse;
    score.horizontal_rmse_m = 0.6 * score.position_m.rmse;
    score.vertical_rmse_m = 0.8 * score.position_m.rmse;
    score.fix_drift = made.fix_drift;
    if (!made.nees.empty()) {
      score.consistency.emplace().position = evaluation::nees_of(made.nees, 3);
    }
    if (made.rotation_deg) {
      score.rotation_deg.emplace().rmse = *made.rotation_deg;
      score.rotation_euler_norm_deg.emplace().rmse = 1.5 * *made.rotation_deg;
    }
    return score;
  }
};

}  // namespace overfly::server::experiments
