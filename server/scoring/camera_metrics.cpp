#include "server/scoring/camera_metrics.hpp"

#include <algorithm>
#include <map>
#include <string>

namespace overfly::engine {
namespace {

using Json = nlohmann::json;

double median_of(std::vector<double> values) {
  if (values.empty()) return 0.0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  if (values.size() % 2 == 1) return *middle;
  return 0.5 * (*middle + *std::max_element(values.begin(), middle));
}

/// Below this number of linear texels per pixel the imagery, not the camera, limits the result.
constexpr double kTextureLimit = 0.5;

struct TexelMetrics {
  double min = 0.0;
  double median = 0.0;
  bool limited = false;
};

TexelMetrics texels_of(const std::vector<FrameRecord>& frames) {
  TexelMetrics texels;
  std::vector<double> medians;
  for (const FrameRecord& frame : frames) {
    if (frame.row.texels_per_pixel_median <= 0.0) continue;  // no imagery in sight
    texels.min = medians.empty() ? frame.row.texels_per_pixel_min
                                 : std::min(texels.min, frame.row.texels_per_pixel_min);
    medians.push_back(frame.row.texels_per_pixel_median);
  }
  texels.limited = !medians.empty();
  texels.median = median_of(std::move(medians));
  texels.limited = texels.limited && texels.median < kTextureLimit;
  return texels;
}

/// Empty if no tile was late.
Json late_tiles_json(const std::vector<FrameRecord>& frames) {
  std::int64_t tiles = 0;
  std::int64_t touched = 0;
  for (const FrameRecord& frame : frames) {
    tiles += frame.row.late_tiles;
    touched += frame.row.late_tiles > 0 ? 1 : 0;
  }
  if (tiles == 0) return Json::object();
  return {{"tiles", tiles}, {"frames", touched}};
}

/// {"KIND": number of frames affected}
Json fault_counts(const std::vector<FrameRecord>& frames) {
  std::map<std::string, std::int64_t> counts;
  for (const FrameRecord& frame : frames) {
    for (const std::string& kind : frame.row.faults) ++counts[kind];
  }
  return counts;
}

Json frames_metrics(const std::vector<FrameRecord>& frames) {
  const TexelMetrics texels = texels_of(frames);
  double void_sum = 0.0;
  double void_max = 0.0;
  for (const FrameRecord& frame : frames) {
    void_sum += frame.row.void_fraction;
    void_max = std::max(void_max, frame.row.void_fraction);
  }
  const double count = std::max<double>(1.0, static_cast<double>(frames.size()));
  Json metrics = {{"frames", frames.size()},
                  {"texels_per_pixel", {{"min", texels.min}, {"median", texels.median}}},
                  {"void_fraction", {{"mean", void_sum / count}, {"max", void_max}}}};
  if (Json late = late_tiles_json(frames); !late.empty()) metrics["late_tiles"] = std::move(late);
  if (Json counts = fault_counts(frames); !counts.empty()) metrics["faults"] = std::move(counts);
  return metrics;
}

}  // namespace

/// [[first, last], ...] of ascending frame numbers.
Json ranges_of(const std::vector<std::int64_t>& frames) {
  Json ranges = Json::array();
  for (std::size_t i = 0; i < frames.size(); ++i) {
    if (i > 0 && frames[i] == frames[i - 1] + 1) {
      ranges.back()[1] = frames[i];
    } else {
      ranges.push_back({frames[i], frames[i]});
    }
  }
  return ranges;
}

Json texture_json(const std::vector<FrameRecord>& frames) {
  const TexelMetrics texels = texels_of(frames);
  return {{"texels_per_pixel_median", texels.median},
          {"texels_per_pixel_min", texels.min},
          {"texture_limited", texels.limited}};
}

Json camera_metrics(const RunRecords& records) {
  Json metrics = frames_metrics(records.frames);
  metrics["late_frames"] = records.late_frames.size();
  std::vector<std::int64_t> late;
  for (const evaluation::FlightFrame& frame : records.late_frames) late.push_back(frame.frame);
  metrics["late_frame_ranges"] = ranges_of(late);
  return metrics;
}

Json other_cameras_metrics(const RunRecords& records) {
  Json cameras = Json::object();
  for (const CameraRecords& camera : records.other_cameras) {
    cameras[camera.name] = frames_metrics(camera.frames);
    cameras[camera.name]["texture"] = texture_json(camera.frames);
  }
  return cameras;
}

bool is_texture_limited(const Json& metrics) {
  if (metrics.at("texture").at("texture_limited").get<bool>()) return true;
  const Json cameras = metrics.value("cameras", Json::object());
  return std::any_of(cameras.begin(), cameras.end(), [](const Json& camera) {
    return camera.at("texture").at("texture_limited").get<bool>();
  });
}

}  // namespace overfly::engine
