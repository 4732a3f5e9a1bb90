// Grows and mends the map: keyframes, new points, culling, adjustment.
#pragma once

#include <map>
#include <string>

#include "core/camera.hpp"
#include "odometry/feature/bundle.hpp"
#include "odometry/feature/initialiser.hpp"
#include "odometry/feature/map.hpp"
#include "odometry/feature/orb.hpp"
#include "odometry/feature/tracker.hpp"

namespace overfly::odometry {

struct MapperOptions {
  int min_frames_between = 3;
  double max_rotation_rad = 0.14;   ///< since the last keyframe
  double max_translation = 0.05;    ///< since the last keyframe, of the median depth
  double min_tracked_share = 0.7;   ///< of the last keyframe's points
  int candidate_keyframes = 5;      ///< whose corners may still become points
  double min_parallax_rad = 0.008;  ///< of a new point
  double max_epipolar_px = 1.0;     ///< at the finest level
  int cells = 900;                  ///< of the image; each should hold a point
  int images_kept = 50;             ///< keyframes that can still be searched
  double scale_factor = 1.2;        ///< of the corners' levels
  int coarsest_patch_level = 2;     ///< to which a patch without texture at its own may rise
  cv::Mat seen;                     ///< as in TrackerOptions
  LocalAdjustment adjustment;
};

class Mapper {
 public:
  Mapper(const PinholeCamera& camera, const MapperOptions& options);

  /// Whether a tracked frame should become a keyframe: the view turned, moved, or lost points.
  [[nodiscard]] bool wants_keyframe(const FrameImage& frame,
                                    const TrackResult& tracked,
                                    const Map& map) const;
  /// Makes it one, with the sights of its points, and finds new points with the keyframes before.
  /// Wall time by stage is added to `timing_ms`, here and below.
  void extend(const FrameImage& frame,
              const TrackResult& tracked,
              Map& map,
              std::map<std::string, double>& timing_ms) const;
  /// Mends the map around the newest keyframe: local bundle adjustment and culling; then looks for
  /// corners that may become points.
  void mend(OrbExtractor& orb, Map& map, std::map<std::string, double>& timing_ms) const;
  /// Looks for corners without a point in the newest keyframe.
  void add_candidates(OrbExtractor& orb, Map& map) const;

 private:
  enum class Search { kFound, kFused, kMissed, kTooNear };
  void triangulate_candidates(Map& map) const;
  Search triangulate_candidate(const Keyframe& source, const Candidate& candidate, Map& map) const;
  /// As above where no plane tells the depth to start from.
  Search triangulate_in_scene(const Keyframe& source, const Candidate& candidate, Map& map) const;
  void add(const MapPoint& point, const Eigen::Vector2d& newest_pixel, Map& map) const;
  /// A candidate that is a point already: the point is looked for in the candidate's keyframe.
  void fuse(const MapPoint& known, const Keyframe& source, Map& map) const;
  /// Looks for a point in a keyframe that lacks it.
  void observe(const MapPoint& point, Keyframe& keyframe, Map& map) const;
  void cull(Map& map) const;

  PinholeCamera camera_;
  MapperOptions options_;
};

}  // namespace overfly::odometry
