#pragma once

#include <atomic>

namespace ORB_SLAM2 {

class Map;

/// Feeds the keyframe database for ten keyframes after the last loop; closes a loop with each
/// keyframe after them.
class LoopClosing {
 public:
  explicit LoopClosing(Map* map) : mLastLoopKFid(0), map_(map) {}
  void InsertKeyFrame(long unsigned int id);
  void RequestReset();
  int in_database() const { return in_database_; }

 protected:
  long unsigned int mLastLoopKFid;

 private:
  Map* map_;
  std::atomic<int> in_database_{0};
};

}  // namespace ORB_SLAM2
