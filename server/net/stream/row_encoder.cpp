#include "server/net/stream/row_encoder.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "server/record/rows/vehicle_rows.hpp"
#include "server/timeline/estimate_errors.hpp"
#include "server/timeline/window_errors.hpp"

namespace overfly::net {
namespace {

using nlohmann::json;

constexpr std::array<const char*, 6> kPoseColumns = {
    "x_m", "y_m", "z_m", "roll_deg", "pitch_deg", "yaw_deg"};

/// Null for a value that JSON cannot represent.
json rounded(double value, double per_unit) {
  if (!std::isfinite(value)) return nullptr;
  return std::round(value * per_unit) / per_unit + 0.0;  // no negative zeros
}

std::array<json, 6> pose_values(const Pose& T_world_body) {
  const RollPitchYaw attitude = attitude_from(T_world_body.rotation);
  const Eigen::Vector3d& p = T_world_body.translation;
  constexpr double kPerMetre = 1e3;
  constexpr double kPerDegree = 1e4;
  return {rounded(p.x(), kPerMetre),
          rounded(p.y(), kPerMetre),
          rounded(p.z(), kPerMetre),
          rounded(deg_from_rad(attitude.roll_rad), kPerDegree),
          rounded(deg_from_rad(attitude.pitch_rad), kPerDegree),
          rounded(deg_from_rad(attitude.yaw_rad), kPerDegree)};
}

/// The six pose columns; a row's pose may be missing.
template <typename Rows, typename PoseOf>
void add_pose_columns(const Rows& rows, PoseOf pose_of, json* columns) {
  std::array<json::array_t, 6> pose_columns;
  for (auto& column : pose_columns) column.reserve(rows.size());
  for (const auto& row : rows) {
    const std::optional<Pose> pose = pose_of(row);
    std::array<json, 6> values;
    if (pose) values = pose_values(*pose);
    for (std::size_t i = 0; i < values.size(); ++i) pose_columns[i].push_back(std::move(values[i]));
  }
  for (std::size_t i = 0; i < kPoseColumns.size(); ++i) {
    (*columns)[kPoseColumns[i]] = std::move(pose_columns[i]);
  }
}

template <typename Rows, typename ValueOf>
json column(const Rows& rows, ValueOf value_of) {
  json::array_t values;
  values.reserve(rows.size());
  for (const auto& row : rows) values.push_back(value_of(row));
  return values;
}

/// Adds a column unless all of its values are null: most runs have no sensor and no faults.
template <typename ValueOf>
void add_if_said(const std::vector<server::FrameRow>& rows,
                 const char* name,
                 ValueOf value_of,
                 json* columns) {
  json values = column(rows, value_of);
  const bool said =
      std::any_of(values.begin(), values.end(), [](const json& value) { return !value.is_null(); });
  if (said) (*columns)[name] = std::move(values);
}

/// Effects of sensor, tiles and faults on each frame.
void add_image_columns(const std::vector<server::FrameRow>& rows, json* columns) {
  using Row = server::FrameRow;
  constexpr double kDigits = 1e6;
  const auto add = [&](const char* name, auto value_of) {
    add_if_said(rows, name, value_of, columns);
  };
  add("exposure_ns",
      [](const Row& row) { return row.exposure_ns == 0 ? json(nullptr) : json(row.exposure_ns); });
  add("gain", [](const Row& row) {
    return row.exposure_ns == 0 ? json(nullptr) : rounded(row.gain, kDigits);
  });
  add("saturated_fraction", [](const Row& row) {
    const bool known = row.exposure_ns != 0 || row.saturated_fraction > 0.0;
    return known ? rounded(row.saturated_fraction, kDigits) : json(nullptr);
  });
  add("late_tiles",
      [](const Row& row) { return row.late_tiles == 0 ? json(nullptr) : json(row.late_tiles); });
  add("stamp_offset_ns", [](const Row& row) {
    return row.stamp_offset_ns == 0 ? json(nullptr) : json(row.stamp_offset_ns);
  });
  add("faults",
      [](const Row& row) { return row.faults.empty() ? json(nullptr) : json(row.faults); });
}

void add_error_columns(const std::vector<std::optional<server::EstimateError>>& errors,
                       json* columns) {
  constexpr double kPerUnit = 1e6;
  const auto add = [&](const char* name, auto value_of) {
    (*columns)[name] = column(errors, [&](const std::optional<server::EstimateError>& error) {
      return error ? rounded(value_of(*error), kPerUnit) : json(nullptr);
    });
  };
  using Error = server::EstimateError;
  add("error_m", [](const Error& error) { return error.position_m(); });
  add("error_along_m", [](const Error& error) { return error.position.along_m; });
  add("error_across_m", [](const Error& error) { return error.position.across_m; });
  add("error_up_m", [](const Error& error) { return error.position.up_m; });
  add("error_rotation_deg", [](const Error& error) { return deg_from_rad(error.rotation_rad); });
}

/// The position's NEES and the band in which that of one pose lies with a probability of 95 %; only
/// for rows that have one.
void add_honesty_columns(const std::vector<std::optional<server::EstimateError>>& errors,
                         json* columns) {
  const auto has_nees = [](const auto& error) { return error && error->position_nees; };
  if (std::none_of(errors.begin(), errors.end(), has_nees)) return;
  const evaluation::Band band = server::position_nees_band();
  const auto add = [&](const char* name, auto value_of) {
    (*columns)[name] = column(errors, [&](const std::optional<server::EstimateError>& error) {
      return has_nees(error) ? rounded(value_of(*error), 1e6) : json(nullptr);
    });
  };
  using Error = server::EstimateError;
  add("nees_position", [](const Error& error) { return *error.position_nees; });
  add("nees_low", [&](const Error& /*error*/) { return band.low; });
  add("nees_high", [&](const Error& /*error*/) { return band.high; });
}

void add_window_columns(const std::vector<server::WindowErrors>& errors, json* columns) {
  using Errors = server::WindowErrors;
  using Relative = evaluation::RelativeErrorAt;
  const auto add = [&](const char* name, auto value_of) {
    (*columns)[name] = column(errors, [&](const Errors& error) {
      const std::optional<double> value = value_of(error);
      return value ? rounded(*value, 1e6) : json(nullptr);
    });
  };
  const auto add_relative = [&](const char* name, double factor, double Relative::*member) {
    add(name, [&](const Errors& error) {
      return error.relative ? std::optional(factor * (*error.relative).*member) : std::nullopt;
    });
  };
  add("error_scale_percent", [](const Errors& error) {
    return error.scale ? std::optional(100.0 * *error.scale) : std::nullopt;
  });
  add_relative("error_relative_percent", 100.0, &Relative::translation);
  add_relative(
      "error_relative_deg", deg_from_rad(evaluation::kErrorWindow_m), &Relative::rotation_rad_m);
}

/// Null for a value that JSON cannot represent.
json json_number(double value) { return std::isfinite(value) ? json(value) : json(nullptr); }

}  // namespace

std::string counter_column(const std::string& counter) { return "counter." + counter; }

json pose_json(const Pose& T_world_body) {
  json pose = json::object();
  auto values = pose_values(T_world_body);
  for (std::size_t i = 0; i < values.size(); ++i) pose[kPoseColumns[i]] = std::move(values[i]);
  return pose;
}

json truth_columns(const std::vector<server::FrameRow>& rows) {
  using Row = server::FrameRow;
  constexpr double kDigits = 1e4;
  json columns = json::object();
  columns["frame"] = column(rows, [](const Row& row) { return row.frame; });
  columns["t_ns"] = column(rows, [](const Row& row) { return row.t_ns; });
  columns["texels_per_pixel"] =
      column(rows, [](const Row& row) { return rounded(row.texels_per_pixel_median, kDigits); });
  columns["void_fraction"] =
      column(rows, [](const Row& row) { return rounded(row.void_fraction, kDigits); });
  columns["late_frames"] = column(rows, [](const Row& row) { return row.late_frames; });
  add_image_columns(rows, &columns);
  add_pose_columns(
      rows, [](const Row& row) { return std::optional<Pose>(row.T_world_body); }, &columns);
  return columns;
}

json estimate_columns(const server::RunTimeline& timeline,
                      std::size_t estimator,
                      const std::vector<server::EstimateRow>& rows,
                      const server::RowAlignment& alignment) {
  using Row = server::EstimateRow;
  json columns = json::object();
  columns["frame"] = column(rows, [](const Row& row) { return row.sample.frame; });
  columns["t_ns"] = column(rows, [](const Row& row) { return row.sample.t_ns; });
  columns["state"] = column(rows, [](const Row& row) { return to_string(row.sample.state); });
  columns["latency_ms"] = column(rows, [](const Row& row) { return rounded(row.latency_ms, 1e3); });
  columns["dropped_frames"] = column(rows, [](const Row& row) { return row.dropped_frames; });
  columns["unanswered_frames"] = column(rows, [](const Row& row) { return row.unanswered_frames; });
  add_pose_columns(
      rows, [&](const Row& row) { return alignment.T_world_body(row); }, &columns);
  const auto errors = server::errors_of(timeline, estimator, rows, alignment);
  add_error_columns(errors, &columns);
  add_honesty_columns(errors, &columns);
  add_window_columns(server::window_errors_of(timeline, estimator, rows, alignment), &columns);
  const std::vector<std::string> counters = timeline.counter_names(estimator);
  for (std::size_t i = 0; i < counters.size(); ++i) {
    columns[counter_column(counters[i])] = column(rows, [&](const Row& row) {
      return i < row.counters.size() ? json_number(row.counters[i]) : json(nullptr);
    });
  }
  return columns;
}

json log_columns(const std::vector<server::LogRow>& rows) {
  using Row = server::LogRow;
  json columns = json::object();
  columns["t_ns"] = column(rows, [](const Row& row) { return row.t_ns; });
  columns["level"] = column(rows, [](const Row& row) { return row.level; });
  columns["text"] = column(rows, [](const Row& row) { return row.text; });
  columns["kind"] = column(
      rows, [](const Row& row) { return row.kind.empty() ? json(nullptr) : json(row.kind); });
  columns["source"] = column(
      rows, [](const Row& row) { return row.source.empty() ? json(nullptr) : json(row.source); });
  return columns;
}

json vehicle_columns(const std::vector<VehicleStatus>& rows) {
  json columns = json::object();
  for (const VehicleStatus& row : rows) {
    const json fields = server::json_from(row);
    for (const auto& [name, value] : fields.items()) columns[name].push_back(value);
  }
  return columns;
}

json estimator_statuses_json(const server::RunTimeline& timeline) {
  json statuses = json::object();
  const std::vector<server::EstimatorStatus> all = timeline.statuses();
  for (std::size_t i = 0; i < all.size(); ++i) {
    statuses[timeline.estimators()[i]] = server::json_from(all[i]);
  }
  return statuses;
}

namespace {

json optional_number(const std::optional<double>& value) {
  return value ? json_number(*value) : json(nullptr);
}

json results_json(const std::vector<server::EstimatorResult>& results) {
  json list = json::array();
  for (const server::EstimatorResult& result : results) {
    list.push_back({{"estimator", result.estimator},
                    {"outcome", evaluation::to_string(result.outcome)},
                    {"position_rmse_m", optional_number(result.position_rmse_m)},
                    {"position_rmse_percent", optional_number(result.position_rmse_percent)}});
  }
  return list;
}

}  // namespace

json run_json(const server::RunInfo& info) {
  return {{"id", info.id},
          {"scenario", info.scenario},
          {"title", info.title},
          {"status", server::to_string(info.status)},
          {"created_utc", info.created_utc},
          {"error", info.error.empty() ? json(nullptr) : json(info.error)},
          {"problem", info.problem.empty() ? json(nullptr) : json(info.problem)},
          {"duration_ns", info.duration_ns},
          {"frames", info.frames},
          {"frames_total", info.frames_total},
          {"pacing", info.pacing},
          {"estimators", info.estimators},
          {"flight", info.flight},
          {"seed", info.seed},
          {"attribution", info.attribution},
          {"texture_limited", info.texture_limited},
          {"queue_position", info.queue_position > 0 ? json(info.queue_position) : json(nullptr)},
          {"left_s", info.left_s ? json(std::round(*info.left_s * 10.0) / 10.0) : json(nullptr)},
          {"notice", info.notice.empty() ? json(nullptr) : json(info.notice)},
          {"world_change", info.world_change.empty() ? json(nullptr) : json(info.world_change)}};
}

json listed_run_json(const server::RunInfo& info) {
  json run = run_json(info);
  run["results"] = results_json(info.results);
  run["tags"] = info.tags;
  run["note"] = info.note;
  return run;
}

}  // namespace overfly::net
