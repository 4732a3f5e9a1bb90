// Extends and refines the map: keyframes, new points, culling, adjustment.
#pragma once

#include <map>
#include <string>

#include "core/camera/camera.hpp"
#include "odometry/feature/map/local_bundle.hpp"
#include "odometry/feature/map/map.hpp"
#include "odometry/feature/orb.hpp"
#include "odometry/feature/tracker.hpp"
#include "odometry/image/frame_image.hpp"

namespace overfly::odometry::feature {

struct MapperOptions {
  int min_frames_between = 3;
  double max_rotation_rad = 0.14;   ///< since the last keyframe
  double max_translation = 0.05;    ///< since the last keyframe, of the median depth
  double min_tracked_share = 0.7;   ///< share of the last keyframe's points
  int candidate_keyframes = 5;      ///< number of keyframes whose corners may become points
  double min_parallax_rad = 0.008;  ///< of a new point
  double max_epipolar_px = 1.0;     ///< at the finest level
  int cells = 900;                  ///< of the image; each should contain a point
  int images_kept = 50;             ///< number of keyframes that stay searchable
  double scale_factor = 1.2;        ///< of the corners' levels
  int coarsest_patch_level = 2;     ///< for patches without texture at their own level
  cv::Mat seen;                     ///< as in TrackerOptions
  LocalAdjustment adjustment;
};

class Mapper {
 public:
  Mapper(const PinholeCamera& camera, const MapperOptions& options);

  /// Whether a tracked frame should become a keyframe: the view rotated, moved or lost points.
  [[nodiscard]] bool wants_keyframe(const FrameImage& frame,
                                    const TrackResult& tracked,
                                    const Map& map) const;
  /// Makes the frame a keyframe with the observations of its points, and creates new points with
  /// earlier keyframes. Here and below, wall time by stage is added to `timing_ms`.
  void extend(const FrameImage& frame,
              const TrackResult& tracked,
              Map& map,
              std::map<std::string, double>& timing_ms) const;
  /// Refines the map around the newest keyframe: local bundle adjustment and culling. Then searches
  /// for corners that may become points.
  void refine(OrbExtractor& orb, Map& map, std::map<std::string, double>& timing_ms) const;
  /// Searches for corners without a point in the newest keyframe.
  void add_candidates(OrbExtractor& orb, Map& map) const;

 private:
  enum class Search { kFound, kFused, kMissed, kTooNear };
  void triangulate_candidates(Map& map) const;
  Search triangulate_candidate(const Keyframe& source, const Candidate& candidate, Map& map) const;
  /// As above, if no plane gives the initial depth.
  Search triangulate_in_scene(const Keyframe& source, const Candidate& candidate, Map& map) const;
  void add(const MapPoint& point, const Eigen::Vector2d& newest_pixel, Map& map) const;
  /// Handles a candidate that is a known point: searches the point in the candidate's keyframe.
  void fuse(const MapPoint& known, const Keyframe& source, Map& map) const;
  /// Searches a point in a keyframe that does not observe it yet.
  void observe(const MapPoint& point, Keyframe& keyframe, Map& map) const;
  void cull(Map& map) const;

  PinholeCamera camera_;
  MapperOptions options_;
};

}  // namespace overfly::odometry::feature
