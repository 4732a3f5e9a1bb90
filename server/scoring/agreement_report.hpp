// How the real images of a run agree with the virtual ones, and what estimators made of both.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
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
  std::int64_t not_comparable =
      0;  ///< images without an offset: they or the virtual ones are uniform
  // Each is of the frames that have it; empty if there are none.
  std::optional<Eigen::Vector2d> mean_offset_px;
  std::optional<FigureSummary> offset_px;  ///< length of the offset
  std::optional<FigureSummary> peak;
  std::optional<FigureSummary> correlation;
  std::optional<FigureSummary> correlation_aligned;
  std::optional<FigureSummary> corners_real;
  std::optional<FigureSummary> corners_virtual;
  std::vector<EstimatorPair> estimators;
};

/// Errors: kNotFound if all images are lost; kInvalidArgument if the scenario compares none.
[[nodiscard]] Result<AgreementReport> report_agreement(const Scenario& scenario,
                                                       const std::vector<AgreementRow>& rows);

/// With the scores of the estimators.
[[nodiscard]] nlohmann::json json_from(const AgreementReport& report, const RunMetrics& metrics);

}  // namespace overfly::server
