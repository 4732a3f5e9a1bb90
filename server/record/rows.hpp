// The rows of a run: of its frames, its estimates and its log.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/estimate.hpp"
#include "core/image.hpp"
#include "core/pose.hpp"

namespace overfly::engine {

/// One camera frame's row.
struct FrameRow {
  std::int64_t frame = 0;
  std::int64_t t_ns = 0;
  Pose T_world_camera;
  Pose T_world_body;
  double texels_per_pixel_median = 0.0;
  double texels_per_pixel_min = 0.0;
  double void_fraction = 0.0;
  std::int64_t exposure_ns = 0;      ///< 0 = not known
  double gain = 1.0;                 ///< of auto-exposure, times the sensor's own
  double saturated_fraction = 0.0;   ///< of the pixels
  int late_tiles = 0;                ///< drawn from coarser ones
  std::int64_t stamp_offset_ns = 0;  ///< of the stamp that estimators were told, less t_ns
  std::vector<std::string> faults;   ///< kinds of those in force
  /// Of the grey image as estimators were sent it; empty where none was.
  std::optional<std::uint32_t> image_crc32;
};

/// One estimator's answer to a frame, in its own frame and, once aligned, in the world.
struct EstimateRow {
  EstimateSample sample;
  std::optional<Pose> T_world_body;  ///< by `init_scale`; empty while not tracking
  double latency_ms = 0.0;
};

struct LogRow {
  std::int64_t t_ns = 0;
  std::string level;  ///< "info", "warning", "error"
  std::string text;
  std::string kind = {};    ///< "fault" where a fault of the scenario begins or ends; else empty
  std::string source = {};  ///< estimator that said it; empty = the range
};

/// A picture that belongs to a frame; shared, never written to after it is made.
struct StampedImage {
  std::int64_t frame = 0;
  std::int64_t t_ns = 0;
  std::shared_ptr<const Image> image;
};

/// One line of frames.jsonl.
struct FrameRecord {
  FrameRow row;
  std::optional<double> axis_depth_m;  ///< of the ground along the optical axis
  /// The camera shakes on its mount: the body's pose is not that of the camera at rest.
  bool shaken = false;
};

/// One line of estimates/NAME.jsonl: an answer, or a frame that a busy estimator never got.
struct EstimateRecord {
  EstimateSample sample;
  std::map<std::string, double> counters;
  bool dropped = false;
  std::string crash;  ///< why the estimator is gone, at the frame where it went; else empty
  /// Of the image as it arrived where the estimator runs, as far as that place tells.
  std::optional<std::uint32_t> image_crc32;
};

}  // namespace overfly::engine
