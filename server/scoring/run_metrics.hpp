// The metrics of a run: what its cameras saw, and how its estimators performed.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "evaluation/evaluation.hpp"
#include "server/record/run_info.hpp"

namespace overfly::server {

/// Frame numbers first, first + 1, ..., last.
struct FrameRange {
  std::int64_t first = 0;
  std::int64_t last = 0;
  bool operator==(const FrameRange&) const = default;
};

/// Linear texels of the finest imagery per pixel, over the frames that see imagery.
struct TextureMetrics {
  double texels_per_pixel_min = 0.0;
  double texels_per_pixel_median = 0.0;  ///< of the frames' medians
  /// The imagery, not the camera, limits the result: the median is below 0.5.
  bool limited = false;
};

struct CameraMetrics {
  std::string name;  ///< empty for a main camera read from a file
  std::int64_t frames = 0;
  TextureMetrics texture;
  double void_fraction_mean = 0.0;
  double void_fraction_max = 0.0;
  std::int64_t mostly_void_frames = 0;  ///< more than half of the image is without imagery
  std::int64_t late_tiles = 0;
  std::int64_t frames_with_late_tiles = 0;
  std::map<std::string, std::int64_t> faults;  ///< number of affected frames by kind
};

struct FlightMetrics {
  double duration_s = 0.0;
  double path_length_m = 0.0;
};

struct EstimatorMetrics {
  std::string type;
  bool test_estimator = false;
  std::string camera;  ///< whose images it gets; empty for the main camera
  evaluation::Score score;
  std::optional<int> map_id;  ///< the map that was scored; empty if it never tracked
  std::int64_t answered = 0;  ///< frames answered before the estimator ended
  std::int64_t unanswered = 0;
  std::int64_t dropped_frames = 0;
  std::vector<FrameRange> dropped_frame_ranges;
  std::int64_t hashes_compared = 0;
  std::int64_t hash_mismatches = 0;
  std::optional<std::string> crash;  ///< why it ended
};

struct RunMetrics {
  std::vector<CameraMetrics> cameras{1};  ///< the main camera first; never empty
  /// Frames that no camera drew because their time had passed.
  std::int64_t late_frames = 0;
  std::vector<FrameRange> late_frame_ranges;
  FlightMetrics flight;
  std::map<std::string, EstimatorMetrics> estimators;  ///< by name

  /// What the camera of an estimator saw; the main camera's where the file lacks that camera.
  [[nodiscard]] const CameraMetrics& camera_of(const EstimatorMetrics& estimator) const;
};

}  // namespace overfly::server
