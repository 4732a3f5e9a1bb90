#include "server/scoring/camera_metrics.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace overfly::server {
namespace {

double median_of(std::vector<double> values) {
  if (values.empty()) return 0.0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  if (values.size() % 2 == 1) return *middle;
  return 0.5 * (*middle + *std::max_element(values.begin(), middle));
}

/// Below this number of linear texels per pixel the imagery, not the camera, limits the result.
constexpr double kTextureLimit = 0.5;

constexpr double kMostlyVoid = 0.5;

/// A camera is reported if more of its frames than this see hardly any imagery.
constexpr double kReportedVoidShare = 0.1;

TextureMetrics texture_of(const std::vector<FrameRow>& frames) {
  TextureMetrics texture;
  std::vector<double> medians;
  for (const FrameRow& frame : frames) {
    if (frame.texels_per_pixel_median <= 0.0) continue;  // no imagery in sight
    const double min = frame.texels_per_pixel_min;
    texture.texels_per_pixel_min =
        medians.empty() ? min : std::min(texture.texels_per_pixel_min, min);
    medians.push_back(frame.texels_per_pixel_median);
  }
  const bool known = !medians.empty();
  texture.texels_per_pixel_median = median_of(std::move(medians));
  texture.limited = known && texture.texels_per_pixel_median < kTextureLimit;
  return texture;
}

}  // namespace

std::vector<FrameRange> ranges_of(const std::vector<std::int64_t>& frames) {
  std::vector<FrameRange> ranges;
  for (const std::int64_t frame : frames) {
    if (!ranges.empty() && frame == ranges.back().last + 1) {
      ranges.back().last = frame;
    } else {
      ranges.push_back({frame, frame});
    }
  }
  return ranges;
}

CameraMetrics camera_metrics_from(const CameraRecords& camera) {
  CameraMetrics metrics;
  metrics.name = camera.name;
  metrics.frames = static_cast<std::int64_t>(camera.frames.size());
  metrics.texture = texture_of(camera.frames);
  double void_sum = 0.0;
  for (const FrameRow& row : camera.frames) {
    void_sum += row.void_fraction;
    metrics.void_fraction_max = std::max(metrics.void_fraction_max, row.void_fraction);
    metrics.mostly_void_frames += row.void_fraction > kMostlyVoid ? 1 : 0;
    metrics.late_tiles += row.late_tiles;
    metrics.frames_with_late_tiles += row.late_tiles > 0 ? 1 : 0;
    for (const std::string& kind : row.faults) ++metrics.faults[kind];
  }
  metrics.void_fraction_mean =
      void_sum / std::max<double>(1.0, static_cast<double>(camera.frames.size()));
  return metrics;
}

std::string void_words(const std::string& name, const CameraMetrics& camera) {
  const double share = static_cast<double>(camera.mostly_void_frames) /
                       std::max(1.0, static_cast<double>(camera.frames));
  if (share <= kReportedVoidShare) return "";
  return "in " + std::to_string(std::lround(100.0 * share)) +
         " % of the frames more than half of the image of " + name + " is without imagery";
}

}  // namespace overfly::server
