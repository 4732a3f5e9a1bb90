// The reading of metrics.json; run_metrics_json.cpp writes it.
#include <limits>

#include "server/files/file_field.hpp"
#include "server/record/rows/run_rows.hpp"
#include "server/record/run_folder.hpp"
#include "server/scoring/run_metrics_json.hpp"

namespace overfly::server {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;
using evaluation::AlignmentMode;
using evaluation::AlignmentScore;
using evaluation::Consistency;
using evaluation::ErrorStatistics;
using evaluation::FixDrift;
using evaluation::Nees;
using evaluation::RelativeError;
using evaluation::Score;

// Each takes the value of a field unless the field is absent.

/// Null stands for a number that JSON cannot represent.
void take(const FileField& object, const char* name, double& value) {
  if (const auto field = object.find(name)) {
    value = field->is_null() ? std::numeric_limits<double>::quiet_NaN() : field->number();
  }
}

void take(const FileField& object, const char* name, std::int64_t& value) {
  if (const auto field = object.find(name)) value = field->integer();
}

void take(const FileField& object, const char* name, int& value) {
  if (const auto field = object.find(name)) {
    value = static_cast<int>(field->integer(0, std::numeric_limits<int>::max()));
  }
}

void take(const FileField& object, const char* name, bool& value) {
  if (const auto field = object.find(name)) value = field->boolean();
}

void take(const FileField& object, const char* name, std::string& value) {
  if (const auto field = object.find(name)) value = field->text();
}

void take(const FileField& object, const char* name, std::vector<std::string>& value) {
  const auto field = object.find(name);
  if (!field) return;
  for (const FileField& item : field->items()) value.push_back(item.text());
}

void take(const FileField& object, const char* name, std::optional<double>& value) {
  const auto field = object.find(name);
  if (field && !field->is_null()) value = field->number();
}

void take(const FileField& object, const char* name, std::optional<int>& value) {
  const auto field = object.find(name);
  if (field && !field->is_null()) take(object, name, value.emplace());
}

void take(const FileField& object, const char* name, std::optional<std::string>& value) {
  const auto field = object.find(name);
  if (field && !field->is_null()) value = field->text();
}

void take(const FileField& object, const char* name, std::vector<FrameRange>& value) {
  const auto field = object.find(name);
  if (!field) return;
  for (const FileField& range : field->items()) {
    const std::vector<FileField> ends = range.items();
    if (ends.size() != 2) range.reject("be a first and a last frame");
    value.push_back({ends[0].integer(), ends[1].integer()});
  }
}

TextureMetrics read_texture(const FileField& field) {
  TextureMetrics texture;
  take(field, "texels_per_pixel_min", texture.texels_per_pixel_min);
  take(field, "texels_per_pixel_median", texture.texels_per_pixel_median);
  take(field, "texture_limited", texture.limited);
  return texture;
}

/// @param texture  of the same camera
CameraMetrics read_camera_metrics(const FileField& field, const std::optional<FileField>& texture) {
  CameraMetrics camera;
  take(field, "frames", camera.frames);
  if (texture) camera.texture = read_texture(*texture);
  if (const auto fraction = field.find("void_fraction")) {
    take(*fraction, "mean", camera.void_fraction_mean);
    take(*fraction, "max", camera.void_fraction_max);
  }
  take(field, "mostly_void_frames", camera.mostly_void_frames);
  if (const auto late = field.find("late_tiles")) {
    take(*late, "tiles", camera.late_tiles);
    take(*late, "frames", camera.frames_with_late_tiles);
  }
  if (const auto faults = field.find("faults")) {
    if (!faults->value().is_object()) faults->reject("be an object");
    for (const auto& [kind, frames] : faults->value().items()) {
      camera.faults[kind] = faults->at(kind).integer();
    }
  }
  return camera;
}

std::vector<RelativeError> read_relative(const FileField& alignment) {
  std::vector<RelativeError> errors;
  const auto field = alignment.find("relative");
  if (!field) return errors;
  for (const FileField& entry : field->items()) {
    RelativeError& error = errors.emplace_back();
    // Runs of earlier versions do not have the means.
    error.translation_mean_percent = std::numeric_limits<double>::quiet_NaN();
    error.rotation_mean_deg_per_100m = std::numeric_limits<double>::quiet_NaN();
    take(entry, "length_m", error.length_m);
    take(entry, "pairs", error.pairs);
    take(entry, "translation_percent", error.translation_percent);
    take(entry, "rotation_deg_per_100m", error.rotation_deg_per_100m);
    take(entry, "translation_mean_percent", error.translation_mean_percent);
    take(entry, "rotation_mean_deg_per_100m", error.rotation_mean_deg_per_100m);
  }
  return errors;
}

/// [low, high]
void take(const FileField& object, const char* name, evaluation::Band& value) {
  const auto field = object.find(name);
  if (!field) return;
  const std::vector<double> ends = field->numbers(2);
  value = {ends[0], ends[1]};
}

std::optional<Nees> read_nees(const FileField& consistency, const char* name) {
  const auto field = consistency.find(name);
  if (!field || field->is_null()) return std::nullopt;
  Nees nees;
  nees.degrees = static_cast<int>(field->at("degrees").integer(1, 6));
  take(*field, "samples", nees.samples);
  take(*field, "mean", nees.mean);
  take(*field, "band_95", nees.band_95);
  take(*field, "pose_band_95", nees.pose_band_95);
  take(*field, "share_in_band", nees.share_in_band);
  const FileField honesty = field->at("honesty");
  const auto known = evaluation::honesty_from(honesty.text());
  if (!known) honesty.reject("be consistent, overconfident or too cautious");
  nees.honesty = *known;
  return nees;
}

std::optional<Consistency> read_consistency(const FileField& alignment) {
  const auto field = alignment.find("consistency");
  if (!field) return std::nullopt;
  Consistency consistency;
  consistency.position = read_nees(*field, "position");
  consistency.rotation = read_nees(*field, "rotation");
  consistency.pose = read_nees(*field, "pose");
  take(*field, "singular", consistency.singular);
  return consistency;
}

std::vector<FixDrift> read_fix_drift(const FileField& alignment) {
  std::vector<FixDrift> drifts;
  const auto field = alignment.find("fix_drift");
  if (!field) return drifts;
  for (const FileField& entry : field->items()) {
    FixDrift& drift = drifts.emplace_back();
    take(entry, "interval_m", drift.interval_m);
    take(entry, "unavailable", drift.unavailable);
    take(entry, "segments", drift.segments);
    take(entry, "apart", drift.apart);
    take(entry, "median_m", drift.median_m);
    take(entry, "worst_m", drift.worst_m);
    take(entry, "horizontal_median_m", drift.horizontal_median_m);
    take(entry, "horizontal_worst_m", drift.horizontal_worst_m);
  }
  return drifts;
}

Similarity read_similarity(const FileField& field) {
  const Result<Pose> T = pose_from(field.value());
  if (!T) field.reject("be a similarity (" + T.error().message + ")");
  return {field.at("scale").number(), T->rotation, T->translation};
}

AlignmentScore read_alignment(const FileField& field, AlignmentMode mode) {
  AlignmentScore score;
  score.mode = mode;
  score.S_world_vo = read_similarity(field.at("S_world_vo"));
  take(field, "matched", score.matched);
  take(field, "position_rmse_m", score.position_m.rmse);
  take(field, "position_mean_m", score.position_m.mean);
  take(field, "position_median_m", score.position_m.median);
  take(field, "position_max_m", score.position_m.max);
  take(field, "horizontal_rmse_m", score.horizontal_rmse_m);
  take(field, "vertical_rmse_m", score.vertical_rmse_m);
  take(field, "position_rmse_hold_m", score.position_rmse_hold_m);
  take(field, "position_auc", score.position_auc);
  std::optional<double> rotation_rmse_deg;
  take(field, "rotation_rmse_deg", rotation_rmse_deg);
  if (rotation_rmse_deg) {
    ErrorStatistics& rotation_deg = score.rotation_deg.emplace();
    rotation_deg.rmse = *rotation_rmse_deg;
    take(field, "rotation_mean_deg", rotation_deg.mean);
    take(field, "rotation_median_deg", rotation_deg.median);
    take(field, "rotation_max_deg", rotation_deg.max);
  }
  std::optional<double> euler_norm_rmse_deg;
  take(field, "rotation_euler_norm_rmse_deg", euler_norm_rmse_deg);
  if (euler_norm_rmse_deg) score.rotation_euler_norm_deg.emplace().rmse = *euler_norm_rmse_deg;
  take(field, "degenerate", score.degenerate);
  score.relative = read_relative(field);
  score.fix_drift = read_fix_drift(field);
  score.consistency = read_consistency(field);
  take(field, "notes", score.notes);
  return score;
}

/// Calls `read` with each field of an object whose name is an alignment mode.
template <typename Read>
void for_each_mode(const std::optional<FileField>& object, const Read& read) {
  if (!object) return;
  for (const AlignmentMode mode : evaluation::all_alignment_modes()) {
    if (const auto field = object->find(evaluation::to_string(mode))) read(mode, *field);
  }
}

Score read_score(const FileField& field) {
  Score score;
  const FileField outcome = field.at("outcome");
  const auto known = evaluation::outcome_from(outcome.text());
  if (!known) outcome.reject("be an outcome");
  score.outcome = *known;
  take(field, "outcome_time_s", score.outcome_time_s);
  take(field, "outcome_distance_m", score.outcome_distance_m);
  take(field, "relocalisations", score.relocalisations);
  take(field, "relocalised_at_s", score.relocalised_at_s);
  take(field, "reset_count", score.reset_count);
  take(field, "coverage", score.coverage);
  take(field, "initialised_at_s", score.initialised_at_s);
  take(field, "frames", score.frames);
  take(field, "tracked_frames", score.tracked_frames);
  take(field, "position_auc_limit_m", score.position_auc_limit_m);
  if (const auto covariances = field.find("covariances")) {
    take(*covariances, "stated", score.covariances.stated);
    take(*covariances, "left_out", score.covariances.left_out);
  }
  for_each_mode(field.find("alignments"), [&](AlignmentMode mode, const FileField& alignment) {
    if (alignment.find("S_world_vo")) score.alignments[mode] = read_alignment(alignment, mode);
  });
  for_each_mode(field.find("unavailable"), [&](AlignmentMode mode, const FileField& reason) {
    score.unavailable[mode] = reason.text();
  });
  return score;
}

EstimatorMetrics read_estimator_metrics(const FileField& field) {
  EstimatorMetrics estimator;
  estimator.score = read_score(field);
  const auto map_id = field.find("map_id");
  if (map_id && !map_id->is_null()) {
    using Limits = std::numeric_limits<int>;
    estimator.map_id = static_cast<int>(map_id->integer(Limits::min(), Limits::max()));
  }
  take(field, "type", estimator.type);
  take(field, "test_estimator", estimator.test_estimator);
  take(field, "camera", estimator.camera);
  take(field, "answered", estimator.answered);
  take(field, "crash", estimator.crash);
  take(field, "unanswered", estimator.unanswered);
  take(field, "hashes_compared", estimator.hashes_compared);
  take(field, "hash_mismatches", estimator.hash_mismatches);
  take(field, "dropped_frames", estimator.dropped_frames);
  take(field, "dropped_frame_ranges", estimator.dropped_frame_ranges);
  return estimator;
}

RunMetrics read_metrics(const FileField& document) {
  RunMetrics metrics;
  const FileField camera = document.at("camera");
  metrics.cameras.at(kMainCamera) = read_camera_metrics(camera, document.find("texture"));
  take(camera, "late_frames", metrics.late_frames);
  take(camera, "late_frame_ranges", metrics.late_frame_ranges);
  if (const auto others = document.find("cameras")) {
    if (!others->value().is_object()) others->reject("be an object");
    for (const auto& [name, value] : others->value().items()) {
      const FileField other = others->at(name);
      metrics.cameras.push_back(read_camera_metrics(other, other.find("texture")));
      metrics.cameras.back().name = name;
    }
  }
  if (const auto flight = document.find("flight")) {
    take(*flight, "duration_s", metrics.flight.duration_s);
    take(*flight, "path_length_m", metrics.flight.path_length_m);
  }
  const FileField estimators = document.at("estimators");
  if (!estimators.value().is_object()) estimators.reject("be an object");
  for (const auto& [name, value] : estimators.value().items()) {
    metrics.estimators[name] = read_estimator_metrics(estimators.at(name));
  }
  return metrics;
}

}  // namespace

Result<RunMetrics> run_metrics_from(const Json& document) {
  return guarded_fields([&] { return read_metrics(FileField(document)); });
}

Result<RunMetrics> read_run_metrics(const fs::path& folder, std::uint64_t max_bytes) {
  const fs::path file = metrics_file(folder);
  const Result<Json> document = read_json(file, max_bytes);
  if (!document) return document.error();
  Result<RunMetrics> metrics = run_metrics_from(*document);
  if (!metrics) return metrics.error().in(file.string());
  return metrics;
}

}  // namespace overfly::server
