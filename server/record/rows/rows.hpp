// The rows of a run: of its frames, its estimates and its log.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/camera/image.hpp"
#include "core/motion/estimate.hpp"
#include "core/motion/pose.hpp"

namespace overfly::server {

/// One camera frame's row; a line of frames.jsonl or cameras/NAME.jsonl.
struct FrameRow {
  std::int64_t frame = 0;
  std::int64_t t_ns = 0;
  Pose T_world_camera;
  Pose T_world_body;
  double texels_per_pixel_median = 0.0;
  double texels_per_pixel_min = 0.0;
  double void_fraction = 0.0;
  std::int64_t exposure_ns = 0;      ///< 0 = not known
  double gain = 1.0;                 ///< of auto-exposure, multiplied by the sensor's own
  double saturated_fraction = 0.0;   ///< fraction of the pixels
  int late_tiles = 0;                ///< tiles drawn from a coarser level
  std::int64_t stamp_offset_ns = 0;  ///< stamp given to estimators minus t_ns
  std::vector<std::string> faults;   ///< kinds of the active faults
  /// Of the grey image as sent to estimators; empty if none was sent.
  std::optional<std::uint32_t> image_crc32;
  std::optional<double> axis_depth_m;  ///< of the ground along the optical axis
  /// Number of the recorded image in its source; negative: the image was rendered.
  std::int64_t source_image = -1;
  /// The camera vibrates: the body's pose does not follow from the camera's and the mount.
  bool shaken = false;
  std::int64_t late_frames = 0;  ///< of this camera, before this frame: the next one was due
};

/// One estimator's answer to a frame as a viewer sees it: in the estimator's own frame and, once
/// aligned, in the world. Derived from an EstimateRecord.
struct EstimateRow {
  EstimateSample sample;
  std::optional<Pose> T_world_body;  ///< by `init_scale`; empty while not tracking
  double latency_ms = 0.0;
  /// In the order of RunTimeline::counter_names; NaN or absent where the answer has none.
  std::vector<double> counters = {};
  double scale = 0.0;                  ///< of the alignment of T_world_body; 0 = not aligned
  std::int64_t dropped_frames = 0;     ///< of the frames before this one: dropped while it was busy
  std::int64_t unanswered_frames = 0;  ///< until this frame, included: not answered in time
};

struct LogRow {
  std::int64_t t_ns = 0;
  std::string level;  ///< "info", "warning", "error"
  std::string text;
  /// "fault" if a fault of the scenario begins or ends; of the flight "mode", "mission" or "event"
  /// (FlightEventKind); else empty.
  std::string kind = {};
  std::string source = {};  ///< the estimator that reported it; empty = the range
};

/// An image that belongs to a frame; shared and immutable.
struct StampedImage {
  std::int64_t frame = 0;
  std::int64_t t_ns = 0;
  std::shared_ptr<const Image> image;
};

/// One line of estimates/NAME.jsonl: an answer, or a frame dropped because the estimator was busy.
struct EstimateRecord {
  EstimateSample sample;
  std::map<std::string, double> counters;
  bool dropped = false;
  std::string crash;  ///< why the estimator ended, at the frame where it ended; else empty
  bool hung = false;  ///< with `crash`: it was ended because it did not answer
  /// Of the image as received by the estimator; empty if not reported.
  std::optional<std::uint32_t> image_crc32;
};

}  // namespace overfly::server
