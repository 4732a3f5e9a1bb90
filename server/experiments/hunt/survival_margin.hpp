// How far an estimator was from failing in one flight, as one number.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "evaluation/evaluation.hpp"

namespace overfly::server::experiments {

/// What counts as a failure in addition to an outcome other than COMPLETED.
struct MarginRule {
  std::optional<double> position_rmse_limit_m;
  evaluation::AlignmentMode alignment = evaluation::AlignmentMode::kInitScale;
};

/// What a flight's records say about the margin of one estimator.
struct FlightEvidence {
  evaluation::Score score;  ///< without the errors of each pose
  double duration_s = 0.0;
  double path_length_m = 0.0;
  /// As evaluation::kept_share.
  double kept_share = 0.0;
  /// Smallest mean over half a second of the points that carried a pose; empty if the estimator
  /// does not report them.
  std::optional<double> lowest_points;
  /// As evaluation::scale_change.
  std::optional<double> scale_change;
};

/// One reason why the margin of a flight that succeeded is smaller than 1.
struct MarginFactor {
  std::string name;    ///< "tracked", "start", "points", "scale", "position"
  double share = 1.0;  ///< in [0, 1]; 0: at the limit of failing
};

struct SurvivalMargin {
  /// Of a flight that succeeded in (0, 1]: the product of the factors. Of one that failed in
  /// [-1, 0): minus the share of the flight that it did not survive.
  double value = 0.0;
  bool failed = false;
  std::string failure;                ///< "LOST at 12.3 s"; empty if it succeeded
  std::vector<MarginFactor> factors;  ///< of a flight that succeeded
};

/// The margin (docs/HUNT.md): continuous as long as the estimator succeeds, so that a search sees
/// in which direction flights become worse before the first one fails.
[[nodiscard]] SurvivalMargin margin_of(const FlightEvidence& evidence, const MarginRule& rule);

/// Reads the records of a completed run.
/// Errors: as read_run_metrics and read_run_records; kNotFound if they lack the estimator.
[[nodiscard]] Result<FlightEvidence> read_evidence(const std::filesystem::path& run_folder,
                                                   const std::string& estimator);

}  // namespace overfly::server::experiments
