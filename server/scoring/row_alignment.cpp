#include "server/scoring/row_alignment.hpp"

#include <utility>

#include "evaluation/evaluation.hpp"
#include "server/record/run_rows.hpp"

namespace overfly::engine {
namespace {

using Json = nlohmann::json;

/// The value at nested names; null if one of them is absent.
const Json* find(const Json& root, std::initializer_list<std::string> names) {
  const Json* value = &root;
  for (const std::string& name : names) {
    if (!value->is_object()) return nullptr;
    const auto found = value->find(name);
    if (found == value->end()) return nullptr;
    value = &*found;
  }
  return value;
}

Error unknown_mode(const std::string& mode) {
  std::string names;
  for (const evaluation::AlignmentMode known : evaluation::all_alignment_modes()) {
    names += (names.empty() ? "" : ", ") + std::string(evaluation::to_string(known));
  }
  return {ErrorCode::kInvalidArgument, "alignment = " + mode + ": must be one of " + names};
}

Result<Similarity> similarity_from(const Json& value) {
  const Result<Pose> T = pose_from(value);
  if (!T) return T.error();
  const Json* scale = find(value, {"scale"});
  if (scale == nullptr || !scale->is_number()) {
    return Error{ErrorCode::kUnreadable, "S_world_vo.scale: must be a number"};
  }
  return Similarity{scale->get<double>(), T->rotation, T->translation};
}

/// The mount of the camera whose images an estimator gets.
Pose mount_of_estimator(const RunTimeline& timeline, std::size_t estimator) {
  const std::vector<std::string> names = timeline.info().estimator_cameras;
  if (estimator >= names.size()) return timeline.T_body_camera();
  const Result<std::size_t> camera = timeline.camera_index(names[estimator]);
  return camera ? timeline.cameras()[*camera].T_body_camera : timeline.T_body_camera();
}

}  // namespace

Result<RowAlignment> RowAlignment::of(const RunTimeline& timeline,
                                      std::size_t estimator,
                                      const std::string& mode) {
  if (mode == kRecordedAlignment) return RowAlignment();
  if (!evaluation::alignment_mode_from(mode)) return unknown_mode(mode);
  const std::string& name = timeline.estimators().at(estimator);
  const Json metrics = timeline.metrics();
  const Json* scores = find(metrics, {"estimators", name});
  if (scores == nullptr) {
    return Error{ErrorCode::kConflict,
                 "alignment = " + mode + ": the run is not scored yet; only " + kRecordedAlignment +
                     " can be shown"};
  }
  if (const Json* reason = find(*scores, {"unavailable", mode})) {
    const std::string text = reason->is_string() ? reason->get<std::string>() : "no reason given";
    return Error{ErrorCode::kConflict, "alignment = " + mode + " of " + name + ": " + text};
  }
  const Json* transform = find(*scores, {"alignments", mode, "S_world_vo"});
  const Json* map_id = find(*scores, {"map_id"});
  if (transform == nullptr || map_id == nullptr || !map_id->is_number_integer()) {
    return Error{ErrorCode::kConflict,
                 "alignment = " + mode + " of " + name +
                     ": metrics.json has no transform (overfly evaluate --run writes it)"};
  }
  const Result<Similarity> S_world_vo = similarity_from(*transform);
  if (!S_world_vo) return S_world_vo.error();
  RowAlignment alignment;
  alignment.scored_ =
      Scored{*S_world_vo, mount_of_estimator(timeline, estimator).inverse(), map_id->get<int>()};
  return alignment;
}

std::optional<Pose> RowAlignment::T_world_body(const EstimateRow& row) const {
  if (!scored_) return row.T_world_body;
  if (row.sample.state != TrackingState::kTracking) return std::nullopt;
  if (row.sample.map_id != scored_->map_id) return std::nullopt;
  return scored_->S_world_vo * row.sample.T_vo_camera * scored_->T_camera_body;
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

}  // namespace overfly::engine
