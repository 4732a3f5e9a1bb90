// The estimator behind the port: which of its parts works on a frame, and what state that gives.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

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
/// that does not come for `kGiveUpS` of images that show something, or the map was just begun, a
/// new one is begun (map_id grows): INITIALISING. The old one is kept, unless it was just begun,
/// and looked for beside the new one's work; where it is found, it goes on with its map_id.
class FeatureOdometry final : public VoPort {
 public:
  explicit FeatureOdometry(const FeatureParameters& parameters);

  [[nodiscard]] std::string type() const override { return "feature"; }
  [[nodiscard]] std::map<std::string, std::string> effective_parameters() const override;
  [[nodiscard]] Result<VoEstimate> track(const VoFrame& frame) override;
  void reset() override;
  [[nodiscard]] std::vector<std::string> take_log() override { return log_->take(); }
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
  /// Lines for people; taken by another thread than that which tracks.
  class Log {
   public:
    void add(std::string line);
    [[nodiscard]] std::vector<std::string> take();

   private:
    std::mutex mutex_;
    std::vector<std::string> lines_;
  };
  /// A map that was lost, in case its place is seen again.
  struct OldMap {
    Map map;
    int map_id = 0;
    double m_per_unit = 1.0;
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
  void keep_old_map();
  bool rejoin_old_map(const FrameImage& frame, VoEstimate& estimate, Outcome& outcome);
  [[nodiscard]] double height_above_ground() const;
  [[nodiscard]] const Map& map() const { return parts_->keeper.view(); }
  void find_scale();
  void report(const FrameImage& frame, const Outcome& outcome, VoEstimate& estimate);
  void report_pose(const Outcome& outcome, VoEstimate& estimate) const;
  void draw(const FrameImage& frame, const Outcome& outcome, VoEstimate& estimate) const;

  std::unique_ptr<Account> account_ = std::make_unique<Account>();
  std::unique_ptr<Log> log_ = std::make_unique<Log>();
  FeatureParameters parameters_;
  PinholeCamera camera_;
  OrbExtractor orb_;
  std::unique_ptr<Parts> parts_;
  MotionModel motion_;
  TrackingState state_ = TrackingState::kInitialising;
  int map_id_ = 0;
  int last_map_id_ = 0;  ///< given to a map so far
  std::optional<OldMap> old_map_;
  std::int64_t looked_for_old_map_at_ns_ = 0;
  Pose T_camera_vo_;
  double known_height_m_ = 0.0;  ///< above ground, for the next map's scale; 0 = not known
  double m_per_unit_ = 1.0;      ///< of what is reported; 1 where no height is known
  double map_memory_mb_ = 0.0;   ///< at the last keyframe
  std::optional<VoFrame> previous_;
  std::int64_t lost_at_ns_ = 0;
  double blind_search_s_ = 0.0;  ///< time lost over images that show something
  bool debug_ = false;
};

}  // namespace overfly::odometry
