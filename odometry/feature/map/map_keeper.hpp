// Owns the map and runs mapping, on the tracking thread or on its own thread.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <exception>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <unordered_map>
#include <vector>

#include "odometry/feature/map/focal_check.hpp"
#include "odometry/feature/map/map.hpp"
#include "odometry/feature/map/mapper.hpp"
#include "odometry/feature/orb.hpp"
#include "odometry/feature/tracker.hpp"
#include "odometry/image/frame_image.hpp"

namespace overfly::odometry::feature {

/// With one thread a keyframe is mapped immediately and `view` is the map itself. With two threads
/// the mapping thread owns the map from `begin` to `clear`, and `view` is the newest copy it
/// published: after new points have a depth, and again after the adjustment.
///
/// All calls must come from the tracking thread.
class MapKeeper {
 public:
  MapKeeper(const PinholeCamera& camera,
            const MapperOptions& options,
            const FeatureParameters& parameters);
  ~MapKeeper();
  MapKeeper(const MapKeeper&) = delete;
  MapKeeper& operator=(const MapKeeper&) = delete;

  /// The empty map, to be filled with its first keyframes before `begin` is called.
  [[nodiscard]] Map& empty_map() { return map_; }
  /// Call when the first keyframes exist: searches corners in the newest and starts mapping.
  void begin();
  /// Drops the map and all pending work.
  void clear();
  /// As `clear`. @return the map
  [[nodiscard]] Map release();
  /// Replaces the current map by a released one and starts mapping it.
  void adopt(Map map);

  /// Takes the map that the mapping thread published last. Rethrows an exception of the mapping
  /// thread.
  /// @return valid and unchanged until the next call
  const Map& refresh();
  /// The map that `refresh` returned last; with one thread the map itself.
  [[nodiscard]] const Map& view() const { return view_ ? *view_ : map_; }

  /// Counts for each point whether it was found where it was expected.
  void note_sights(const TrackResult& tracked);
  /// Whether a tracked frame should become a keyframe now; false while one is being mapped.
  [[nodiscard]] bool wants_keyframe(const FrameImage& frame, const TrackResult& tracked) const;
  /// Makes the frame a keyframe. @return its pose T_camera_vo after mapping so far
  Pose insert_keyframe(const FrameImage& frame,
                       const TrackResult& tracked,
                       std::map<std::string, double>& timing_ms);
  /// Adds the wall time of the mapping thread since the last call.
  void take_timing(std::map<std::string, double>& timing_ms);
  /// Processor time of the mapping thread since the last call [s]; 0 with one thread.
  [[nodiscard]] double take_cpu_s();
  /// Of the map, and with two threads of the published copy, whose images are the map's [bytes]:
  /// with two threads when it was published last.
  [[nodiscard]] std::size_t memory_bytes() const;
  /// Warnings about the calibration since the last call, for the user.
  [[nodiscard]] std::vector<std::string> take_warnings();
  /// Blocks until no keyframe is waiting or being mapped.
  void wait_until_idle();

 private:
  /// Counts for a point since the last keyframe, in frames.
  struct Sights {
    int expected = 0;
    int found = 0;
  };
  struct Work {
    FrameImage frame;
    TrackResult tracked;
    std::unordered_map<int, Sights> sights;
  };

  void run();
  void map_keyframe(const Work& work, std::map<std::string, double>& timing_ms);
  void count(const std::unordered_map<int, Sights>& sights);
  void publish();

  Mapper mapper_;
  int images_kept_;
  OrbExtractor orb_;
  bool threaded_;
  Map map_;
  FocalCheck focal_check_;
  std::unordered_map<int, Sights> sights_;  ///< by point id
  std::shared_ptr<const Map> view_;         ///< null with one thread

  mutable std::mutex mutex_;  ///< protects all members below
  std::condition_variable changed_;
  std::optional<Work> work_;
  std::exception_ptr failure_;
  bool busy_ = false;
  bool stop_ = false;
  std::shared_ptr<const Map> published_;
  std::size_t published_bytes_ = 0;  ///< memory_bytes() with two threads
  std::map<std::string, double> timing_ms_;
  double cpu_s_ = 0.0;
  std::vector<std::string> warnings_;
  std::thread thread_;  ///< last member: joined before the members it uses
};

}  // namespace overfly::odometry::feature
