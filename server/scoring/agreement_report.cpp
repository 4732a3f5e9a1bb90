#include "server/scoring/agreement_report.hpp"

#include <cmath>
#include <utility>

#include "core/measure/quantile.hpp"
#include "server/scoring/run_metrics_json.hpp"

namespace overfly::server {
namespace {

using Json = nlohmann::json;

std::optional<FigureSummary> summary_of(const std::vector<double>& values) {
  if (values.empty()) return std::nullopt;
  return FigureSummary{quantile(values, 0.5), quantile(values, 0.05), quantile(values, 0.95)};
}

Json figure_json(const std::optional<FigureSummary>& summary) {
  if (!summary) return nullptr;
  return {{"median", summary->median}, {"p5", summary->p5}, {"p95", summary->p95}};
}

std::int64_t missing_images(const std::vector<AgreementRow>& rows) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < rows.size(); ++i) {
    steps.push_back(static_cast<double>(rows[i].t_ns - rows[i - 1].t_ns));
  }
  if (steps.empty()) return 0;
  const double usual = quantile(steps, 0.5);
  std::int64_t missing = 0;
  for (const double step : steps) {
    if (usual > 0.0 && step > 1.5 * usual) missing += std::llround(step / usual) - 1;
  }
  return missing;
}

/// An entry of `estimators` without what differs between the two cameras.
Json without_place(Json entry) {
  entry.erase("name");
  entry.erase("camera");
  return entry;
}

std::vector<EstimatorPair> pairs_of(const Scenario& scenario,
                                    std::size_t real_camera,
                                    std::size_t virtual_camera) {
  std::vector<EstimatorPair> pairs;
  const Json& entries = scenario.resolved.at("estimators");
  std::vector<bool> taken(scenario.estimators.size(), false);
  for (std::size_t i = 0; i < scenario.estimators.size(); ++i) {
    if (scenario.estimators[i].camera != real_camera) continue;
    for (std::size_t j = 0; j < scenario.estimators.size(); ++j) {
      if (taken[j] || scenario.estimators[j].camera != virtual_camera) continue;
      if (without_place(entries.at(i)) != without_place(entries.at(j))) continue;
      taken[j] = true;
      pairs.push_back({scenario.estimators[i].name, scenario.estimators[j].name});
      break;
    }
  }
  return pairs;
}

}  // namespace

Result<AgreementReport> report_agreement(const Scenario& scenario,
                                         const std::vector<AgreementRow>& rows) {
  const CameraSpec* const real = scenario.recorded_camera();
  if (real == nullptr || !real->images->compare_with) {
    return Error{ErrorCode::kInvalidArgument,
                 "the scenario has no camera with images.compare_with"};
  }
  const std::size_t other = *real->images->compare_with;
  AgreementReport report;
  report.real_camera = real->name;
  report.virtual_camera = scenario.cameras[other].name;
  report.frames = static_cast<std::int64_t>(rows.size());
  report.missing = missing_images(rows);
  Eigen::Vector2d offset_sum_px = Eigen::Vector2d::Zero();
  std::vector<double> offsets, peaks, correlations, aligned, corners_real, corners_virtual;
  for (const AgreementRow& row : rows) {
    if (!row.agreement) {
      ++report.lost;
      continue;
    }
    const evaluation::ImageAgreement& agreement = *row.agreement;
    if (agreement.offset_px) {
      offset_sum_px += *agreement.offset_px;
      offsets.push_back(agreement.offset_px->norm());
    } else {
      ++report.not_comparable;
    }
    if (agreement.peak) peaks.push_back(*agreement.peak);
    if (agreement.correlation) correlations.push_back(*agreement.correlation);
    if (agreement.correlation_aligned) aligned.push_back(*agreement.correlation_aligned);
    corners_real.push_back(agreement.corners_real);
    corners_virtual.push_back(agreement.corners_virtual);
  }
  if (report.lost == report.frames) {
    return Error{ErrorCode::kNotFound, "none of the recorded images could be read"};
  }
  if (!offsets.empty()) {
    report.mean_offset_px = offset_sum_px / static_cast<double>(offsets.size());
  }
  report.offset_px = summary_of(offsets);
  report.peak = summary_of(peaks);
  report.correlation = summary_of(correlations);
  report.correlation_aligned = summary_of(aligned);
  report.corners_real = summary_of(corners_real);
  report.corners_virtual = summary_of(corners_virtual);
  report.estimators =
      pairs_of(scenario, static_cast<std::size_t>(real - scenario.cameras.data()), other);
  return report;
}

Json json_from(const AgreementReport& report, const RunMetrics& metrics) {
  Json value = {
      {"real_camera", report.real_camera},
      {"virtual_camera", report.virtual_camera},
      {"frames", report.frames},
      {"lost", report.lost},
      {"missing", report.missing},
      {"not_comparable", report.not_comparable},
      {"mean_offset_px",
       report.mean_offset_px ? Json{report.mean_offset_px->x(), report.mean_offset_px->y()}
                             : Json()},
      {"offset_px", figure_json(report.offset_px)},
      {"peak", figure_json(report.peak)},
      {"correlation", figure_json(report.correlation)},
      {"correlation_aligned", figure_json(report.correlation_aligned)},
      {"corners_real", figure_json(report.corners_real)},
      {"corners_virtual", figure_json(report.corners_virtual)},
      {"estimators", Json::array()}};
  for (const EstimatorPair& pair : report.estimators) {
    Json entry = {{"real", pair.real}, {"virtual", pair.rendered}};
    for (const auto& [role, name] : {std::pair("real", pair.real), {"virtual", pair.rendered}}) {
      const auto found = metrics.estimators.find(name);
      if (found == metrics.estimators.end()) continue;
      entry[std::string(role) + "_score"] = json_from(found->second.score);
    }
    value["estimators"].push_back(std::move(entry));
  }
  return value;
}

}  // namespace overfly::server
