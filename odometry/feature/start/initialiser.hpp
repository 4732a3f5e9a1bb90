// Waits for enough parallax, then creates the first map.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/camera/camera.hpp"
#include "odometry/feature/map/map.hpp"
#include "odometry/feature/orb.hpp"
#include "odometry/feature/start/first_map.hpp"
#include "odometry/geometry/two_view.hpp"
#include "odometry/image/frame_image.hpp"
#include "odometry/image/patch_aligner.hpp"
#include "odometry/image/pyramid.hpp"

namespace overfly::odometry::feature {

struct InitialiserOptions {
  double min_parallax_rad = 0.07;  ///< 4 deg: depths to 0.1 % with points to 0.1 px
  /// Slow or high flight needs long to reach it: after this time `least_parallax_rad` is
  /// sufficient.
  double patience_s = 1.2;
  double least_parallax_rad = 0.026;
  double min_motion_rad = 0.02;  ///< median displacement before a reconstruction is tried
  bool planar_start = true;      ///< as in FeatureParameters
  int coarsest_patch_level = 2;  ///< as in MapperOptions
  int attempt_every = 3;         ///< frames
  int snapshot_every = 6;        ///< initial number of frames between snapshots
  int max_snapshots = 32;        ///< when full, every second is dropped and the interval doubles
  int min_tracks = 120;
  int cells = 1000;  ///< of the image; one point is tracked in each
  /// Minimum number of cells with tracks: 1.5 times the points that tracking requires, because a
  /// map with just that number is lost at the next frame.
  int min_cells = 60;
  std::uint64_t seed = 1;
};

/// Tracks the corners of a first image from frame to frame against their patches in that image
/// until two views are far enough apart. Then adjusts all views between them together.
class Initialiser {
 public:
  Initialiser(const PinholeCamera& camera, const InitialiserOptions& options);

  /// Processes the next frame. On success the map has its first keyframes, of which this frame is
  /// the newest. The first keyframe's camera is the origin, and the depth of the ground on its axis
  /// is 1.
  /// @return true when the map was created
  bool process(const FrameImage& frame, OrbExtractor& orb, Map& map);
  void reset();
  /// The last first image since the last map that was dropped because its corners could not be
  /// tracked.
  [[nodiscard]] const std::optional<FrameImage>& given_up() const { return given_up_; }

  struct Track {
    Corner corner;
    int patch_level = 0;
    Eigen::Vector2d pixel = Eigen::Vector2d::Zero();   ///< in the previous frame
    Eigen::Vector2d offset = Eigen::Vector2d::Zero();  ///< from the homography's prediction
  };
  [[nodiscard]] const std::vector<Track>& tracks() const { return tracks_; }

 private:
  /// A track that was missed and may be found again.
  struct Lapsed {
    Track track;
    std::size_t origin = 0;
  };
  struct Snapshot {
    FrameImage frame;
    std::vector<std::optional<Eigen::Vector2d>> pixels;  ///< one for each corner of the first
  };

  void forget();
  void start(const FrameImage& frame, OrbExtractor& orb);
  bool follow(const FrameImage& frame);
  bool follow_coarsely(const FrameImage& frame, Eigen::Matrix3d& H) const;
  [[nodiscard]] std::optional<Track> found(const Track& track,
                                           const FrameImage& frame,
                                           const Eigen::Matrix3d& H) const;
  [[nodiscard]] bool enough(const std::vector<Track>& tracks) const;
  void remember(const FrameImage& frame);
  [[nodiscard]] double median_motion_px() const;
  bool reconstruct(const FrameImage& frame, OrbExtractor& orb, Map& map);
  bool reconstruct_from(const std::vector<std::size_t>& chosen,
                        const FrameImage& frame,
                        OrbExtractor& orb,
                        Map& map);
  [[nodiscard]] FirstMapInput input_of(const TwoViewReconstruction& motion,
                                       const std::vector<std::size_t>& chosen,
                                       const FrameImage& frame) const;

  PinholeCamera camera_;
  InitialiserOptions options_;
  std::optional<FrameImage> first_;
  std::vector<Track> tracks_;
  std::vector<std::size_t> origin_;  ///< for each track the index of its corner in the first image
  std::vector<Lapsed> lapsed_;
  bool patient_ = false;  ///< search missed tracks, because too few others remain
  std::optional<FrameImage> given_up_;
  std::size_t corner_count_ = 0;
  std::vector<Snapshot> snapshots_;
  int snapshot_every_ = 1;  ///< frames
  Eigen::Matrix3d H_now_first_ = Eigen::Matrix3d::Identity();
  Eigen::Matrix3d H_step_ = Eigen::Matrix3d::Identity();
  int frames_ = 0;
};

}  // namespace overfly::odometry::feature
