// Reads the rows of a run folder's line files.
#include <algorithm>
#include <charconv>
#include <limits>
#include <memory>
#include <vector>

#include "server/files/file_field.hpp"
#include "server/record/rows/run_rows.hpp"

namespace overfly::server {
namespace {

using Json = nlohmann::json;

/// Field `image_crc32`; empty if absent.
std::optional<std::uint32_t> crc32_or_none(const FileField& row) {
  const auto field = row.find("image_crc32");
  if (!field) return std::nullopt;
  const std::string text = field->text();
  std::uint32_t crc32 = 0;
  const auto read = std::from_chars(text.data(), text.data() + text.size(), crc32, 16);
  if (read.ec != std::errc() || read.ptr != text.data() + text.size()) {
    field->reject("be a hexadecimal number of 32 bits");
  }
  return crc32;
}

Pose read_pose(const FileField& field) {
  const std::vector<double> p = field.at("p_m").numbers(3);
  const std::vector<double> q = field.at("q_xyzw").numbers(4);
  Pose pose;
  pose.translation = {p[0], p[1], p[2]};
  pose.rotation = Eigen::Quaterniond(q[3], q[0], q[1], q[2]);
  return pose;
}

int small_integer(const FileField& field, std::int64_t min, std::int64_t max) {
  return static_cast<int>(field.integer(min, max));
}

std::int64_t stamp(const FileField& field) {
  return field.integer(-kLargestFileInteger, kLargestFileInteger);
}

double number_or(const FileField& row, const char* name, double absent) {
  const auto field = row.find(name);
  return field ? field->number() : absent;
}

std::string text_or_empty(const FileField& row, const char* name) {
  const auto field = row.find(name);
  return field ? field->text() : "";
}

std::optional<double> number_of_row(const FileField& row, const char* name) {
  const auto field = row.find(name);
  return field ? std::optional<double>(field->number()) : std::nullopt;
}

PinholeCamera read_pinhole(const FileField& value) {
  constexpr int kMostPixels = 1 << 20;  // per side
  PinholeCamera camera;
  camera.width_px = small_integer(value.at("width_px"), 1, kMostPixels);
  camera.height_px = small_integer(value.at("height_px"), 1, kMostPixels);
  camera.fx_px = value.at("fx_px").number();
  camera.fy_px = value.at("fy_px").number();
  camera.cx_px = value.at("cx_px").number();
  camera.cy_px = value.at("cy_px").number();
  return camera;
}

Distortion read_distortion(const FileField& lens) {
  Distortion distortion;
  const FileField name = lens.at("model");
  const auto model = distortion_model_from(name.text());
  if (!model) name.reject("be a known lens model");
  distortion.model = *model;
  const FileField list = lens.at("coefficients");
  const std::vector<FileField> coefficients = list.items();
  const auto most = static_cast<std::size_t>(coefficient_count(*model));
  if (coefficients.size() > most) {
    list.reject("have at most " + std::to_string(most) + " numbers for " + name.text());
  }
  for (std::size_t i = 0; i < coefficients.size(); ++i) {
    distortion.k[i] = coefficients[i].number();
  }
  return distortion;
}

std::vector<std::string> read_faults(const FileField& row) {
  std::vector<std::string> faults;
  const auto field = row.find("faults");
  if (!field) return faults;
  for (const FileField& fault : field->items()) faults.push_back(fault.text());
  return faults;
}

FrameRow read_frame(const FileField& value, const Pose& T_body_camera) {
  FrameRow row;
  row.frame = value.at("frame").integer();
  row.t_ns = value.at("t_ns").integer();
  row.T_world_camera = read_pose(value.at("T_world_camera"));
  row.T_world_body = row.T_world_camera * T_body_camera.inverse();
  const auto shaken = value.find("T_world_body");
  row.shaken = shaken.has_value();
  if (shaken) row.T_world_body = read_pose(*shaken);
  row.exposure_ns = value.at("exposure_ns").integer();
  row.gain = number_or(value, "gain", 1.0);
  row.saturated_fraction = number_or(value, "saturated_fraction", 0.0);
  if (const auto late = value.find("late_tiles")) {
    row.late_tiles = small_integer(*late, 0, std::numeric_limits<int>::max());
  }
  if (const auto offset = value.find("stamp_offset_ns")) row.stamp_offset_ns = stamp(*offset);
  row.faults = read_faults(value);
  if (const auto image = value.find("source_image")) row.source_image = stamp(*image);
  const FileField texels = value.at("texels_per_pixel");
  row.texels_per_pixel_min = texels.at("min").number();
  row.texels_per_pixel_median = texels.at("median").number();
  row.void_fraction = value.at("void_fraction").number();
  row.image_crc32 = crc32_or_none(value);
  row.axis_depth_m = number_of_row(value, "axis_depth_m");
  return row;
}

/// A covariance that is none is left out, as it is when an estimator states it: the pose stays.
void read_covariance(const FileField& row, EstimateSample& sample) {
  const auto flag = row.find("covariance_left_out");
  sample.covariance_left_out = flag && flag->boolean();
  const auto field = row.find("covariance");
  if (!field || sample.state != TrackingState::kTracking) return;
  constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();
  std::vector<double> upper;
  for (const FileField& item : field->items()) {
    upper.push_back(item.value().is_number() ? item.number() : kNoNumber);
  }
  const Result<PoseCovariance> covariance = pose_covariance_from(row_major_from_upper(upper));
  if (covariance) {
    sample.covariance = std::make_shared<const PoseCovariance>(*covariance);
  } else {
    sample.covariance_left_out = true;
  }
}

EstimateRecord read_estimate(const FileField& value) {
  EstimateRecord record;
  record.sample.frame = value.at("frame").integer();
  record.sample.t_ns = stamp(value.at("t_ns"));
  const auto dropped = value.find("dropped");
  record.dropped = dropped && dropped->boolean();
  if (record.dropped) return record;
  const FileField state = value.at("state");
  const auto known = tracking_state_from(state.text());
  if (!known) state.reject("be a tracking state");
  record.sample.state = *known;
  record.sample.map_id = small_integer(
      value.at("map_id"), std::numeric_limits<int>::min(), std::numeric_limits<int>::max());
  if (const auto pose = value.find("T_vo_camera")) record.sample.T_vo_camera = read_pose(*pose);
  record.sample.scene_depth = number_of_row(value, "scene_depth");
  read_covariance(value, record.sample);
  if (const auto counters = value.find("counters")) {
    if (!counters->value().is_object()) counters->reject("be an object");
    for (const auto& [name, count] : counters->value().items()) {
      record.counters[name] = counters->at(name).number();
    }
  }
  record.crash = text_or_empty(value, "crash");
  const auto hung = value.find("hung");
  record.hung = hung && hung->boolean();
  record.image_crc32 = crc32_or_none(value);
  return record;
}

}  // namespace

Result<Pose> pose_from(const Json& value) {
  return guarded_fields([&] { return read_pose(FileField(value)); });
}

Result<CameraModel> camera_model_from(const Json& value) {
  return guarded_fields([&] {
    const FileField camera(value);
    const PinholeCamera pinhole = read_pinhole(camera);
    const auto lens = camera.find("distortion");
    return lens ? CameraModel(pinhole, read_distortion(*lens)) : CameraModel(pinhole);
  });
}

Result<FrameRow> frame_row_from(const Json& value, const Pose& T_body_camera) {
  return guarded_fields([&] { return read_frame(FileField(value), T_body_camera); });
}

Result<EstimateRecord> estimate_record_from(const Json& value) {
  return guarded_fields([&] { return read_estimate(FileField(value)); });
}

Result<LogRow> log_row_from(const Json& value) {
  return guarded_fields([&] {
    const FileField row(value);
    return LogRow{stamp(row.at("t_ns")),
                  row.at("level").text(),
                  row.at("text").text(),
                  text_or_empty(row, "kind"),
                  text_or_empty(row, "source")};
  });
}

}  // namespace overfly::server
