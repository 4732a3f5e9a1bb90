#pragma once

#include <condition_variable>
#include <deque>
#include <mutex>

namespace ORB_SLAM2 {

class LoopClosing;
class Map;

/// Takes keyframes in a thread of its own, some milliseconds for each.
class LocalMapping {
 public:
  LocalMapping(Map* map, LoopClosing* loop_closer) : map_(map), loop_closer_(loop_closer) {}
  void Run();
  void InsertKeyFrame(long unsigned int id);
  bool AcceptKeyFrames();
  int KeyframesInQueue();
  void RequestReset();

 private:
  Map* map_;
  LoopClosing* loop_closer_;
  std::mutex mutex_;
  std::deque<long unsigned int> queue_;
  bool accepts_ = true;
};

}  // namespace ORB_SLAM2
