// The estimator behind the port: which of its parts works on a frame, and what state that gives.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>

#include "odometry/feature/descriptor_initialiser.hpp"
#include "odometry/feature/feature_odometry.hpp"
#include "odometry/feature/initialiser.hpp"
#include "odometry/feature/map_keeper.hpp"
#include "odometry/feature/motion_model.hpp"
#include "odometry/feature/orb.hpp"
#include "odometry/feature/rectifier.hpp"
#include "odometry/feature/relocaliser.hpp"
#include "odometry/feature/tracker.hpp"

namespace overfly::odometry {

/// States: INITIALISING until the first map; TRACKING; LOST until the map is found again. When
/// that does not come for `kGiveUpS` of images that show something, or the map was just begun,
/// the map is dropped and a new one begun (map_id grows): INITIALISING.
class FeatureOdometry final : public VoPort {
 public:
  explicit FeatureOdometry(const FeatureParameters& parameters);

  [[nodiscard]] std::string type() const override { return "feature"; }
  [[nodiscard]] std::map<std::string, std::string> effective_parameters() const override;
  [[nodiscard]] Result<VoEstimate> track(const VoFrame& frame) override;
  void reset() override;
  void set_debug(bool wanted) override { debug_ = wanted; }
  /// CPU of both threads; memory of the map at its largest: images, points, observations (with two
  /// threads of the part that tracking has a copy of).
  [[nodiscard]] std::optional<ResourceUse> resource_use() const override;

 private:
  /// The parts that need the camera, made at the first frame.
  struct Parts {
    Parts(const CameraModel& camera, const FeatureParameters& parameters);
    Rectifier rectifier;
    Initialiser initialiser;
    DescriptorInitialiser descriptor_initialiser;
    Tracker tracker;
    MapKeeper keeper;
  };
  /// Since it was created, whatever was reset. Read by other threads.
  struct Account {
    std::atomic<double> cpu_s{0.0};
    std::atomic<double> peak_memory_mb{0.0};
  };
  /// What happened in the frame at hand.
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
  [[nodiscard]] const Map& map() const { return parts_->keeper.view(); }
  void find_scale();
  void report(const FrameImage& frame, const Outcome& outcome, VoEstimate& estimate);
  void report_pose(const Outcome& outcome, VoEstimate& estimate) const;
  void draw(const FrameImage& frame, const Outcome& outcome, VoEstimate& estimate) const;

  std::unique_ptr<Account> account_ = std::make_unique<Account>();
  FeatureParameters parameters_;
  PinholeCamera camera_;
  OrbExtractor orb_;
  std::unique_ptr<Parts> parts_;
  MotionModel motion_;
  TrackingState state_ = TrackingState::kInitialising;
  int map_id_ = 0;
  Pose T_camera_vo_;
  double m_per_unit_ = 1.0;     ///< of what is reported; 1 where no height is known
  double map_memory_mb_ = 0.0;  ///< at the last keyframe
  std::optional<VoFrame> previous_;
  std::int64_t lost_at_ns_ = 0;
  double blind_search_s_ = 0.0;  ///< time lost over images that show something
  bool debug_ = false;
};

}  // namespace overfly::odometry
