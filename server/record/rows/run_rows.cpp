#include "server/record/rows/run_rows.hpp"

#include <array>
#include <cstdio>
#include <string>
#include <utility>

namespace overfly::server {
namespace {

using Json = nlohmann::json;

/// Eight hexadecimal digits.
std::string hex_text(std::uint32_t value) {
  std::array<char, 9> text{};
  std::snprintf(text.data(), text.size(), "%08x", value);
  return text.data();
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

Json json_from(const FrameRow& row) {
  Json value = {{"frame", row.frame},
                {"t_ns", row.t_ns},
                {"T_world_camera", json_from(row.T_world_camera)},
                {"exposure_ns", row.exposure_ns},
                {"texels_per_pixel",
                 {{"min", row.texels_per_pixel_min}, {"median", row.texels_per_pixel_median}}},
                {"void_fraction", row.void_fraction}};
  if (row.image_crc32) value["image_crc32"] = hex_text(*row.image_crc32);
  if (row.axis_depth_m) value["axis_depth_m"] = *row.axis_depth_m;
  if (row.shaken) value["T_world_body"] = json_from(row.T_world_body);
  if (row.exposure_ns != 0) value["gain"] = row.gain;
  if (row.saturated_fraction > 0.0) value["saturated_fraction"] = row.saturated_fraction;
  if (row.late_tiles != 0) value["late_tiles"] = row.late_tiles;
  if (row.stamp_offset_ns != 0) value["stamp_offset_ns"] = row.stamp_offset_ns;
  if (row.source_image >= 0) value["source_image"] = row.source_image;
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
    if (record.sample.covariance) value["covariance"] = upper_triangle(*record.sample.covariance);
    if (record.sample.covariance_left_out) value["covariance_left_out"] = true;
  }
  if (!record.counters.empty()) value["counters"] = record.counters;
  if (record.image_crc32) value["image_crc32"] = hex_text(*record.image_crc32);
  if (!record.crash.empty()) value["crash"] = record.crash;
  if (record.hung) value["hung"] = true;
  return value;
}

Json json_from(const LogRow& row) {
  Json value = {{"t_ns", row.t_ns}, {"level", row.level}, {"text", row.text}};
  if (!row.kind.empty()) value["kind"] = row.kind;
  if (!row.source.empty()) value["source"] = row.source;
  return value;
}

}  // namespace overfly::server
