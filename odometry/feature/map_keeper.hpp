// The map and who works on it: the tracking thread itself, or a thread beside it.
#pragma once

#include <condition_variable>
#include <exception>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "odometry/feature/focal_check.hpp"
#include "odometry/feature/frame_image.hpp"
#include "odometry/feature/map.hpp"
#include "odometry/feature/mapper.hpp"
#include "odometry/feature/orb.hpp"
#include "odometry/feature/tracker.hpp"

namespace overfly::odometry {

/// With one thread a keyframe is mapped at once, and `view` is the map itself. With two, a thread
/// owns the map from `begin` to `clear`; `view` is the newest copy that it published: new points as
/// soon as they have a depth, then once more after the adjustment.
///
/// All calls are for one thread, that which tracks.
class MapKeeper {
 public:
  MapKeeper(const PinholeCamera& camera,
            const MapperOptions& options,
            const FeatureParameters& parameters);
  ~MapKeeper();
  MapKeeper(const MapKeeper&) = delete;
  MapKeeper& operator=(const MapKeeper&) = delete;

  /// The empty map, for who makes its first keyframes; `begin` follows when it has them.
  [[nodiscard]] Map& empty_map() { return map_; }
  /// The first keyframes are there: looks for corners in the newest, and works from now on.
  void begin();
  /// Forgets the map and all work on it.
  void clear();
  /// As `clear`. @return the map as it was
  [[nodiscard]] Map release();
  /// Takes a map that was released, in the place of the present one, and works on it from now on.
  void adopt(Map map);

  /// Takes what the thread published last. @return stays as it is until the next call of this
  /// What the thread has thrown since the last call is thrown here.
  const Map& refresh();
  /// As `refresh` returned it, with one thread as it is.
  [[nodiscard]] const Map& view() const { return view_ ? *view_ : map_; }

  /// Counts for each point whether it was found where it should have been.
  void note_sights(const TrackResult& tracked);
  /// Whether a tracked frame should become a keyframe now; no while one is being mapped.
  [[nodiscard]] bool wants_keyframe(const FrameImage& frame, const TrackResult& tracked) const;
  /// Makes it one. @return the frame's pose as known now, T_camera_vo
  Pose insert_keyframe(const FrameImage& frame,
                       const TrackResult& tracked,
                       std::map<std::string, double>& timing_ms);
  /// Adds the wall time that the thread spent since the last call.
  void take_timing(std::map<std::string, double>& timing_ms);
  /// Processor time of the thread since the last call [s]; 0 with one thread.
  [[nodiscard]] double take_cpu_s();
  /// What was found out about the calibration since the last call, for people.
  [[nodiscard]] std::vector<std::string> take_warnings();
  /// Until no keyframe waits or is being mapped.
  void wait_until_idle();

 private:
  /// Of a point since the last keyframe, in frames.
  struct Sights {
    int expected = 0;
    int found = 0;
  };
  struct Work {
    FrameImage frame;
    TrackResult tracked;
    std::map<int, Sights> sights;
  };

  void run();
  void map_keyframe(const Work& work, std::map<std::string, double>& timing_ms);
  void count(const std::map<int, Sights>& sights);
  void publish();

  Mapper mapper_;
  int images_kept_;
  OrbExtractor orb_;
  bool threaded_;
  Map map_;
  FocalCheck focal_check_;
  std::map<int, Sights> sights_;     ///< by the point's id
  std::shared_ptr<const Map> view_;  ///< null with one thread

  mutable std::mutex mutex_;  ///< guards all below
  std::condition_variable changed_;
  std::optional<Work> work_;
  std::exception_ptr failure_;
  bool busy_ = false;
  bool stop_ = false;
  std::shared_ptr<const Map> published_;
  std::map<std::string, double> timing_ms_;
  double cpu_s_ = 0.0;
  std::vector<std::string> warnings_;
  std::thread thread_;  ///< last: it ends before what it uses
};

}  // namespace overfly::odometry
