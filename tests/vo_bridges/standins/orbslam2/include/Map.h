#pragma once

#include <atomic>

namespace ORB_SLAM2 {

class Map {
 public:
  long unsigned int KeyFramesInMap() { return keyframes; }
  long unsigned int MapPointsInMap() { return 100 * keyframes; }
  int GetLastBigChangeIdx() { return big_changes; }

  std::atomic<long unsigned int> keyframes{0};
  std::atomic<int> big_changes{0};
};

}  // namespace ORB_SLAM2
