// Implements the estimator port: selects the component that processes a frame and derives the
// tracking state.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "odometry/feature/feature_odometry.hpp"
#include "odometry/feature/map/map_keeper.hpp"
#include "odometry/feature/map/relocaliser.hpp"
#include "odometry/feature/orb.hpp"
#include "odometry/feature/start/descriptor_initialiser.hpp"
#include "odometry/feature/start/initialiser.hpp"
#include "odometry/feature/tracker.hpp"
#include "odometry/geometry/motion_model.hpp"
#include "odometry/image/rectifier.hpp"
#include "odometry/shell/estimator_log.hpp"
#include "odometry/shell/resource_account.hpp"

namespace overfly::odometry::feature {

/// States: INITIALISING until the first map exists; TRACKING; LOST until the map is found again. If
/// relocalisation fails for `kGiveUpS` of images with visible texture, or if the lost map is young,
/// a new map is started (map_id increases, state INITIALISING). The old map is kept unless it was
/// young, and is searched for while the new one is built and tracked. If it is found, it becomes
/// the current map again with its own map_id.
class FeatureOdometry final : public VoPort {
 public:
  explicit FeatureOdometry(const FeatureParameters& parameters);

  [[nodiscard]] std::string type() const override { return "feature"; }
  [[nodiscard]] std::map<std::string, std::string> effective_parameters() const override;
  [[nodiscard]] Result<VoEstimate> track(const VoFrame& frame) override;
  [[nodiscard]] std::vector<std::string> take_log() override { return log_.take(); }
  void set_debug(bool wanted) override { debug_ = wanted; }
  /// CPU time of both threads, and the largest memory of the maps: images, points, observations.
  /// With two threads it includes the tracking thread's partial copy.
  [[nodiscard]] std::optional<ResourceUse> resource_use() const override;

 private:
  /// Components that need the camera; created at the first frame.
  struct Parts {
    Parts(const CameraModel& camera, const FeatureParameters& parameters);
    Rectifier rectifier;
    Initialiser initialiser;
    DescriptorInitialiser descriptor_initialiser;
    Tracker tracker;
    MapKeeper keeper;
  };
  /// A lost map, kept in case its area is seen again.
  struct OldMap {
    Map map;
    int map_id = 0;
    std::optional<double> m_per_unit;
  };
  /// Results of processing the current frame.
  struct Outcome {
    TrackResult tracked;
    bool keyframe = false;
  };

  [[nodiscard]] Result<VoEstimate> answer(const VoFrame& frame);
  void initialise(const FrameImage& frame, VoEstimate& estimate, Outcome& outcome);
  bool make_first_map(const FrameImage& frame);
  void follow(const FrameImage& frame, VoEstimate& estimate, Outcome& outcome);
  void search(const FrameImage& frame, VoEstimate& estimate, Outcome& outcome);
  [[nodiscard]] FrameImage image_of(const VoFrame& frame) const;
  [[nodiscard]] bool frozen(const VoFrame& frame, bool repeated) const;
  [[nodiscard]] Pose predicted(std::int64_t t_ns) const;
  [[nodiscard]] TrackResult track_map(const FrameImage& frame) const;
  void accept(const FrameImage& frame, VoEstimate& estimate, Outcome& outcome);
  void lose();
  void start_over();
  void keep_old_map();
  bool rejoin_old_map(const FrameImage& frame, VoEstimate& estimate, Outcome& outcome);
  [[nodiscard]] double height_above_ground() const;
  [[nodiscard]] const Map& map() const { return parts_->keeper.view(); }
  void find_scale();
  /// Scale of reported poses.
  [[nodiscard]] double scale() const { return m_per_unit_.value_or(1.0); }
  void report(const FrameImage& frame, const Outcome& outcome, VoEstimate& estimate);
  void report_pose(const Outcome& outcome, VoEstimate& estimate) const;
  void draw(const FrameImage& frame, const Outcome& outcome, VoEstimate& estimate) const;

  ResourceAccount account_;
  EstimatorLog log_;
  FeatureParameters parameters_;
  PinholeCamera camera_;
  OrbExtractor orb_;
  std::unique_ptr<Parts> parts_;
  MotionModel motion_;
  TrackingState state_ = TrackingState::kInitialising;
  int map_id_ = 0;
  int last_map_id_ = 0;  ///< highest map id used so far
  std::optional<OldMap> old_map_;
  std::int64_t looked_for_old_map_at_ns_ = 0;
  Pose T_camera_vo_;
  double known_height_m_ = 0.0;       ///< above ground, scales the next map; 0 = unknown
  std::optional<double> m_per_unit_;  ///< of the present map; empty: its units are not metres
  double map_memory_mb_ = 0.0;        ///< at the last keyframe
  std::optional<VoFrame> previous_;
  std::int64_t lost_at_ns_ = 0;
  double blind_search_s_ = 0.0;  ///< time lost while images show texture
  bool debug_ = false;
};

}  // namespace overfly::odometry::feature
