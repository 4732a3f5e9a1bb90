// How the real images of a run agree with the virtual ones, and what estimators made of both.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "server/record/rows/agreement_rows.hpp"
#include "server/scenario/scenario.hpp"
#include "server/scoring/run_metrics.hpp"

namespace overfly::server {

/// The middle and the tail of a figure over the frames.
struct FigureSummary {
  double median = 0.0;
  double p5 = 0.0;
  double p95 = 0.0;
};

/// One estimator that ran on both cameras with the same parameters: its names in the run.
struct EstimatorPair {
  std::string real;
  std::string rendered;
};

struct AgreementReport {
  std::string real_camera;
  std::string virtual_camera;
  std::int64_t frames = 0;
  std::int64_t lost = 0;  ///< images that are missing or cannot be decoded
  /// Images that the stream lacks: in intervals of more than 1.5 times the median one.
  std::int64_t missing = 0;
  Eigen::Vector2d mean_offset_px = Eigen::Vector2d::Zero();
  FigureSummary offset_px;  ///< length of the offset
  FigureSummary peak;
  FigureSummary correlation;          ///< of the frames that have one
  FigureSummary correlation_aligned;  ///< of the frames that have one
  FigureSummary corners_real;
  FigureSummary corners_virtual;
  std::vector<EstimatorPair> estimators;
};

/// Errors: kNotFound if no image could be compared; kInvalidArgument if the scenario compares none.
[[nodiscard]] Result<AgreementReport> report_agreement(const Scenario& scenario,
                                                       const std::vector<AgreementRow>& rows);

/// With the scores of the estimators.
[[nodiscard]] nlohmann::json json_from(const AgreementReport& report, const RunMetrics& metrics);

}  // namespace overfly::server
