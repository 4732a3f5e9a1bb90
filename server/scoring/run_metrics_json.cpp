// The writing of metrics.json; run_metrics_from_json.cpp reads it.
#include "server/scoring/run_metrics_json.hpp"

#include <utility>

#include "server/record/rows/run_rows.hpp"

namespace overfly::server {
namespace {

using Json = nlohmann::json;
using evaluation::AlignmentScore;
using evaluation::Consistency;
using evaluation::ErrorStatistics;
using evaluation::FixDrift;
using evaluation::Nees;
using evaluation::RelativeError;
using evaluation::Score;

template <typename Value>
Json or_null(const std::optional<Value>& value) {
  return value ? Json(*value) : Json(nullptr);
}

/// [[first, last], ...]
Json ranges_json(const std::vector<FrameRange>& ranges) {
  Json list = Json::array();
  for (const FrameRange& range : ranges) list.push_back({range.first, range.last});
  return list;
}

Json texture_json(const TextureMetrics& texture) {
  return {{"texels_per_pixel_median", texture.texels_per_pixel_median},
          {"texels_per_pixel_min", texture.texels_per_pixel_min},
          {"texture_limited", texture.limited}};
}

Json camera_metrics_json(const CameraMetrics& camera) {
  Json value = {
      {"frames", camera.frames},
      {"texels_per_pixel",
       {{"min", camera.texture.texels_per_pixel_min},
        {"median", camera.texture.texels_per_pixel_median}}},
      {"void_fraction", {{"mean", camera.void_fraction_mean}, {"max", camera.void_fraction_max}}}};
  if (camera.mostly_void_frames != 0) value["mostly_void_frames"] = camera.mostly_void_frames;
  if (camera.late_tiles != 0) {
    value["late_tiles"] = {{"tiles", camera.late_tiles}, {"frames", camera.frames_with_late_tiles}};
  }
  if (!camera.faults.empty()) value["faults"] = camera.faults;
  return value;
}

Json nees_json(const std::optional<Nees>& nees) {
  if (!nees) return nullptr;
  return {{"degrees", nees->degrees},
          {"samples", nees->samples},
          {"mean", nees->mean},
          {"band_95", {nees->band_95.low, nees->band_95.high}},
          {"pose_band_95", {nees->pose_band_95.low, nees->pose_band_95.high}},
          {"share_in_band", nees->share_in_band},
          {"deviation_ratio", nees->deviation_ratio()},
          {"honesty", evaluation::to_string(nees->honesty)}};
}

Json consistency_json(const Consistency& consistency) {
  const auto honesty = consistency.honesty();
  return {{"position", nees_json(consistency.position)},
          {"rotation", nees_json(consistency.rotation)},
          {"pose", nees_json(consistency.pose)},
          {"singular", consistency.singular},
          {"honesty", honesty ? Json(evaluation::to_string(*honesty)) : Json(nullptr)}};
}

Json fix_drift_json(const std::vector<FixDrift>& drifts) {
  Json list = Json::array();
  for (const FixDrift& drift : drifts) {
    Json& entry = list.emplace_back(Json{{"interval_m", drift.interval_m}});
    if (!drift.unavailable.empty()) {
      entry["unavailable"] = drift.unavailable;
      continue;
    }
    entry["segments"] = drift.segments;
    entry["apart"] = drift.apart;
    entry["median_m"] = drift.median_m;
    entry["worst_m"] = drift.worst_m;
    entry["horizontal_median_m"] = drift.horizontal_median_m;
    entry["horizontal_worst_m"] = drift.horizontal_worst_m;
  }
  return list;
}

Json alignment_json(const AlignmentScore& score) {
  Json relative = Json::array();
  for (const RelativeError& error : score.relative) {
    relative.push_back({{"length_m", error.length_m},
                        {"pairs", error.pairs},
                        {"translation_percent", error.translation_percent},
                        {"rotation_deg_per_100m", error.rotation_deg_per_100m},
                        {"translation_mean_percent", error.translation_mean_percent},
                        {"rotation_mean_deg_per_100m", error.rotation_mean_deg_per_100m}});
  }
  Json S_world_vo = json_from(Pose{score.S_world_vo.rotation, score.S_world_vo.translation});
  S_world_vo["scale"] = score.S_world_vo.scale;
  const auto rotation = [&](double ErrorStatistics::*statistic) {
    return score.rotation_deg ? Json((*score.rotation_deg).*statistic) : Json(nullptr);
  };
  Json value = {
      {"scale", score.S_world_vo.scale},
      {"S_world_vo", std::move(S_world_vo)},
      {"matched", score.matched},
      {"position_rmse_m", score.position_m.rmse},
      {"position_mean_m", score.position_m.mean},
      {"position_median_m", score.position_m.median},
      {"position_max_m", score.position_m.max},
      {"horizontal_rmse_m", or_null(score.horizontal_rmse_m)},
      {"vertical_rmse_m", or_null(score.vertical_rmse_m)},
      {"position_rmse_hold_m", score.position_rmse_hold_m},
      {"position_auc", or_null(score.position_auc)},
      {"rotation_rmse_deg", rotation(&ErrorStatistics::rmse)},
      {"rotation_mean_deg", rotation(&ErrorStatistics::mean)},
      {"rotation_median_deg", rotation(&ErrorStatistics::median)},
      {"rotation_max_deg", rotation(&ErrorStatistics::max)},
      {"rotation_euler_norm_rmse_deg",
       score.rotation_euler_norm_deg ? Json(score.rotation_euler_norm_deg->rmse) : Json(nullptr)},
      {"degenerate", or_null(score.degenerate)},
      {"relative", std::move(relative)},
      {"fix_drift", fix_drift_json(score.fix_drift)},
      {"notes", score.notes}};
  if (score.consistency) value["consistency"] = consistency_json(*score.consistency);
  return value;
}

Json estimator_metrics_json(const EstimatorMetrics& estimator) {
  Json value = json_from(estimator.score);
  value["map_id"] = or_null(estimator.map_id);
  value["type"] = estimator.type;
  value["test_estimator"] = estimator.test_estimator;
  if (!estimator.camera.empty()) value["camera"] = estimator.camera;
  value["answered"] = estimator.answered;
  value["crash"] = or_null(estimator.crash);
  value["unanswered"] = estimator.unanswered;
  value["hashes_compared"] = estimator.hashes_compared;
  value["hash_mismatches"] = estimator.hash_mismatches;
  value["dropped_frames"] = estimator.dropped_frames;
  value["dropped_frame_ranges"] = ranges_json(estimator.dropped_frame_ranges);
  return value;
}

}  // namespace

Json alignments_json(const Score& score) {
  Json alignments = Json::object();
  for (const auto& [mode, alignment] : score.alignments) {
    alignments[evaluation::to_string(mode)] = alignment_json(alignment);
  }
  return alignments;
}

Json unavailable_json(const Score& score) {
  Json unavailable = Json::object();
  for (const auto& [mode, reason] : score.unavailable) {
    unavailable[evaluation::to_string(mode)] = reason;
  }
  return unavailable;
}

Json json_from(const Score& score) {
  Json value = {{"outcome", evaluation::to_string(score.outcome)},
                {"outcome_time_s", or_null(score.outcome_time_s)},
                {"outcome_distance_m", or_null(score.outcome_distance_m)},
                {"relocalisations", or_null(score.relocalisations)},
                {"relocalised_at_s", or_null(score.relocalised_at_s)},
                {"reset_count", score.reset_count},
                {"coverage", score.coverage},
                {"initialised_at_s", or_null(score.initialised_at_s)},
                {"frames", score.frames},
                {"tracked_frames", score.tracked_frames},
                {"position_auc_limit_m", or_null(score.position_auc_limit_m)},
                {"alignments", alignments_json(score)},
                {"unavailable", unavailable_json(score)}};
  if (score.covariances.any()) {
    value["covariances"] = {{"stated", score.covariances.stated},
                            {"left_out", score.covariances.left_out}};
  }
  return value;
}

Json json_from(const RunMetrics& metrics) {
  Json estimators = Json::object();
  for (const auto& [name, estimator] : metrics.estimators) {
    estimators[name] = estimator_metrics_json(estimator);
  }
  Json value = {{"format_version", 1},
                {"flight",
                 {{"duration_s", metrics.flight.duration_s},
                  {"path_length_m", metrics.flight.path_length_m}}},
                {"estimators", std::move(estimators)}};
  for (std::size_t i = 0; i < metrics.cameras.size(); ++i) {
    const CameraMetrics& camera = metrics.cameras[i];
    Json entry = camera_metrics_json(camera);
    if (i == kMainCamera) {
      entry["late_frames"] = metrics.late_frames;
      entry["late_frame_ranges"] = ranges_json(metrics.late_frame_ranges);
      value["camera"] = std::move(entry);
      value["texture"] = texture_json(camera.texture);
    } else {
      entry["texture"] = texture_json(camera.texture);
      value["cameras"][camera.name] = std::move(entry);
    }
  }
  return value;
}

}  // namespace overfly::server
