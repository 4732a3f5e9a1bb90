#include "server/engine/run_rows.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdio>
#include <functional>
#include <vector>

namespace overfly::engine {
namespace {

using Json = nlohmann::json;

/// Runs a reader of one row; what nlohmann throws at a missing or mistyped field becomes an error.
template <typename Row>
Result<Row> guarded(const std::function<Row()>& read) {
  try {
    return read();
  } catch (const Json::exception& error) {
    return Error{ErrorCode::kUnreadable, error.what()};
  }
}

/// Eight hexadecimal digits.
std::string hex_text(std::uint32_t value) {
  std::array<char, 9> text{};
  std::snprintf(text.data(), text.size(), "%08x", value);
  return text.data();
}

/// Field `image_crc32`; empty where it is absent.
std::optional<std::uint32_t> crc32_or_none(const Json& value) {
  if (!value.contains("image_crc32")) return std::nullopt;
  const std::string text = value.at("image_crc32").get<std::string>();
  std::uint32_t crc32 = 0;
  const auto read = std::from_chars(text.data(), text.data() + text.size(), crc32, 16);
  if (read.ec != std::errc() || read.ptr != text.data() + text.size()) return std::nullopt;
  return crc32;
}

Pose pose_or_throw(const Json& value) {
  const Json& p = value.at("p_m");
  const Json& q = value.at("q_xyzw");
  Pose pose;
  pose.translation = {p.at(0).get<double>(), p.at(1).get<double>(), p.at(2).get<double>()};
  pose.rotation = Eigen::Quaterniond(
      q.at(3).get<double>(), q.at(0).get<double>(), q.at(1).get<double>(), q.at(2).get<double>());
  return pose;
}

}  // namespace

Json json_from(const Pose& T) {
  return {{"p_m", {T.translation.x(), T.translation.y(), T.translation.z()}},
          {"q_xyzw", {T.rotation.x(), T.rotation.y(), T.rotation.z(), T.rotation.w()}}};
}

Json json_from(const PinholeCamera& camera) {
  return {{"width_px", camera.width_px},
          {"height_px", camera.height_px},
          {"fx_px", camera.fx_px},
          {"fy_px", camera.fy_px},
          {"cx_px", camera.cx_px},
          {"cy_px", camera.cy_px}};
}

Json json_from(const CameraModel& camera) {
  Json value = json_from(camera.pinhole());
  const Distortion& distortion = camera.distortion();
  const auto count = static_cast<std::size_t>(coefficient_count(distortion.model));
  Json coefficients = Json::array();
  for (std::size_t i = 0; i < count; ++i) coefficients.push_back(distortion.k[i]);
  value["distortion"] = {{"model", to_string(distortion.model)},
                         {"coefficients", std::move(coefficients)}};
  return value;
}

Json json_from(const FrameRecord& record) {
  const FrameRow& row = record.row;
  Json value = {{"frame", row.frame},
                {"t_ns", row.t_ns},
                {"T_world_camera", json_from(row.T_world_camera)},
                {"exposure_ns", row.exposure_ns},
                {"texels_per_pixel",
                 {{"min", row.texels_per_pixel_min}, {"median", row.texels_per_pixel_median}}},
                {"void_fraction", row.void_fraction}};
  if (row.image_crc32) value["image_crc32"] = hex_text(*row.image_crc32);
  if (record.axis_depth_m) value["axis_depth_m"] = *record.axis_depth_m;
  if (record.shaken) value["T_world_body"] = json_from(row.T_world_body);
  if (row.exposure_ns != 0) value["gain"] = row.gain;
  if (row.saturated_fraction > 0.0) value["saturated_fraction"] = row.saturated_fraction;
  if (row.late_tiles != 0) value["late_tiles"] = row.late_tiles;
  if (row.stamp_offset_ns != 0) value["stamp_offset_ns"] = row.stamp_offset_ns;
  if (!row.faults.empty()) value["faults"] = row.faults;
  return value;
}

Json json_from(const EstimateRecord& record) {
  Json value = {{"frame", record.sample.frame}, {"t_ns", record.sample.t_ns}};
  if (record.dropped) {
    value["dropped"] = true;
    return value;
  }
  value["state"] = to_string(record.sample.state);
  value["map_id"] = record.sample.map_id;
  if (record.sample.state == TrackingState::kTracking) {
    value["T_vo_camera"] = json_from(record.sample.T_vo_camera);
    if (record.sample.scene_depth) value["scene_depth"] = *record.sample.scene_depth;
  }
  if (!record.counters.empty()) value["counters"] = record.counters;
  if (record.image_crc32) value["image_crc32"] = hex_text(*record.image_crc32);
  if (!record.crash.empty()) value["crash"] = record.crash;
  return value;
}

Json json_from(const LogRow& row) {
  Json value = {{"t_ns", row.t_ns}, {"level", row.level}, {"text", row.text}};
  if (!row.kind.empty()) value["kind"] = row.kind;
  if (!row.source.empty()) value["source"] = row.source;
  return value;
}

Result<Pose> pose_from(const Json& value) {
  return guarded<Pose>([&] { return pose_or_throw(value); });
}

Result<PinholeCamera> camera_from(const Json& value) {
  return guarded<PinholeCamera>([&] {
    PinholeCamera camera;
    camera.width_px = value.at("width_px").get<int>();
    camera.height_px = value.at("height_px").get<int>();
    camera.fx_px = value.at("fx_px").get<double>();
    camera.fy_px = value.at("fy_px").get<double>();
    camera.cx_px = value.at("cx_px").get<double>();
    camera.cy_px = value.at("cy_px").get<double>();
    return camera;
  });
}

Result<CameraModel> camera_model_from(const Json& value) {
  const Result<PinholeCamera> pinhole = camera_from(value);
  if (!pinhole) return pinhole.error();
  if (!value.contains("distortion")) return CameraModel(*pinhole);
  return guarded<CameraModel>([&] {
    const Json& lens = value.at("distortion");
    Distortion distortion;
    distortion.model =
        distortion_model_from(lens.at("model").get<std::string>()).value_or(DistortionModel::kNone);
    const auto k = lens.at("coefficients").get<std::vector<double>>();
    std::copy_n(k.begin(), std::min(k.size(), distortion.k.size()), distortion.k.begin());
    return CameraModel(*pinhole, distortion);
  });
}

Result<FrameRecord> frame_record_from(const Json& value, const Pose& T_body_camera) {
  return guarded<FrameRecord>([&] {
    FrameRecord record;
    record.row.frame = value.at("frame").get<std::int64_t>();
    record.row.t_ns = value.at("t_ns").get<std::int64_t>();
    record.row.T_world_camera = pose_or_throw(value.at("T_world_camera"));
    record.row.T_world_body = record.row.T_world_camera * T_body_camera.inverse();
    record.shaken = value.contains("T_world_body");
    if (record.shaken) record.row.T_world_body = pose_or_throw(value.at("T_world_body"));
    record.row.exposure_ns = value.at("exposure_ns").get<std::int64_t>();
    record.row.gain = value.value("gain", 1.0);
    record.row.saturated_fraction = value.value("saturated_fraction", 0.0);
    record.row.late_tiles = value.value("late_tiles", 0);
    record.row.stamp_offset_ns = value.value("stamp_offset_ns", std::int64_t{0});
    record.row.faults = value.value("faults", std::vector<std::string>{});
    record.row.texels_per_pixel_min = value.at("texels_per_pixel").at("min").get<double>();
    record.row.texels_per_pixel_median = value.at("texels_per_pixel").at("median").get<double>();
    record.row.void_fraction = value.at("void_fraction").get<double>();
    record.row.image_crc32 = crc32_or_none(value);
    if (value.contains("axis_depth_m")) {
      record.axis_depth_m = value.at("axis_depth_m").get<double>();
    }
    return record;
  });
}

Result<EstimateRecord> estimate_record_from(const Json& value) {
  return guarded<EstimateRecord>([&] {
    EstimateRecord record;
    record.sample.frame = value.at("frame").get<std::int64_t>();
    record.sample.t_ns = value.at("t_ns").get<std::int64_t>();
    record.dropped = value.value("dropped", false);
    if (record.dropped) return record;
    const auto state = tracking_state_from(value.at("state").get<std::string>());
    record.sample.state = state.value_or(TrackingState::kLost);
    record.sample.map_id = value.at("map_id").get<int>();
    if (value.contains("T_vo_camera")) {
      record.sample.T_vo_camera = pose_or_throw(value.at("T_vo_camera"));
    }
    if (value.contains("scene_depth")) {
      record.sample.scene_depth = value.at("scene_depth").get<double>();
    }
    if (value.contains("counters")) {
      record.counters = value.at("counters").get<std::map<std::string, double>>();
    }
    record.crash = value.value("crash", "");
    record.image_crc32 = crc32_or_none(value);
    return record;
  });
}

Result<LogRow> log_row_from(const Json& value) {
  return guarded<LogRow>([&] {
    return LogRow{value.at("t_ns").get<std::int64_t>(),
                  value.at("level").get<std::string>(),
                  value.at("text").get<std::string>(),
                  value.value("kind", ""),
                  value.value("source", "")};
  });
}

}  // namespace overfly::engine
