#include "server/timeline/row_alignment.hpp"

#include <utility>

#include "evaluation/evaluation.hpp"
#include "server/scoring/run_metrics.hpp"

namespace overfly::server {
namespace {

Error unknown_mode(const std::string& mode) {
  std::string names;
  for (const evaluation::AlignmentMode known : evaluation::all_alignment_modes()) {
    names += (names.empty() ? "" : ", ") + std::string(evaluation::to_string(known));
  }
  return {ErrorCode::kInvalidArgument, "alignment = " + mode + ": must be one of " + names};
}

/// Null if the estimator is not scored.
const EstimatorMetrics* metrics_of(const RunMetrics& metrics, const std::string& estimator) {
  const auto found = metrics.estimators.find(estimator);
  return found == metrics.estimators.end() ? nullptr : &found->second;
}

}  // namespace

std::size_t camera_of_estimator(const RunTimeline& timeline, std::size_t estimator) {
  const std::vector<std::string> names = timeline.info().estimator_cameras;
  const Result<std::size_t> camera =
      timeline.camera_index(estimator < names.size() ? names[estimator] : "");
  return camera ? *camera : kMainCamera;
}

Result<RowAlignment> RowAlignment::of(const RunTimeline& timeline,
                                      std::size_t estimator,
                                      const std::string& mode) {
  if (mode == kRecordedAlignment) return RowAlignment();
  const auto known = evaluation::alignment_mode_from(mode);
  if (!known) return unknown_mode(mode);
  const std::string& name = timeline.estimators().at(estimator);
  const auto metrics = timeline.metrics();
  const EstimatorMetrics* scored = metrics ? metrics_of(*metrics, name) : nullptr;
  if (scored == nullptr) {
    return Error{ErrorCode::kConflict,
                 "alignment = " + mode + ": the run is not scored yet; only " + kRecordedAlignment +
                     " can be shown"};
  }
  const evaluation::Score& score = scored->score;
  const auto reason = score.unavailable.find(*known);
  if (reason != score.unavailable.end()) {
    return Error{ErrorCode::kConflict,
                 "alignment = " + mode + " of " + name + ": " + reason->second};
  }
  const auto alignment = score.alignments.find(*known);
  if (alignment == score.alignments.end() || !scored->map_id) {
    return Error{ErrorCode::kConflict,
                 "alignment = " + mode + " of " + name +
                     ": metrics.json has no transform (overfly evaluate --run writes it)"};
  }
  const std::size_t camera = camera_of_estimator(timeline, estimator);
  const Pose T_body_camera = timeline.cameras().at(camera).T_body_camera;
  RowAlignment placed;
  placed.scored_ = Scored{alignment->second.S_world_vo, T_body_camera.inverse(), *scored->map_id};
  return placed;
}

std::optional<Pose> RowAlignment::T_world_body(const EstimateRow& row) const {
  if (!scored_) return row.T_world_body;
  if (row.sample.state != TrackingState::kTracking) return std::nullopt;
  if (row.sample.map_id != scored_->map_id) return std::nullopt;
  return scored_->S_world_vo * row.sample.T_vo_camera * scored_->T_camera_body;
}

double RowAlignment::scale(const EstimateRow& row) const {
  return scored_ ? scored_->S_world_vo.scale : row.scale;
}

std::optional<Similarity> RowAlignment::S_world_vo(int map_id, const Similarity& recorded) const {
  if (!scored_) return recorded;
  if (map_id != scored_->map_id) return std::nullopt;
  return scored_->S_world_vo;
}

Status check_alignment(const RunTimeline& timeline, const std::string& mode) {
  if (mode == kRecordedAlignment) return {};
  if (!evaluation::alignment_mode_from(mode)) return unknown_mode(mode);
  std::optional<Error> first;
  for (std::size_t i = 0; i < timeline.estimators().size(); ++i) {
    const Result<RowAlignment> alignment = RowAlignment::of(timeline, i, mode);
    if (alignment) return {};
    if (!first) first = alignment.error();
  }
  if (first) return *first;
  return Error{ErrorCode::kConflict, "alignment = " + mode + ": the run has no estimator"};
}

}  // namespace overfly::server
