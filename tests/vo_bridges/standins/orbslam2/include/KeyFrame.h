#pragma once

namespace ORB_SLAM2 {

class KeyFrame {
 public:
  explicit KeyFrame(long unsigned int id) : mnId(id) {}
  long unsigned int mnId;
};

}  // namespace ORB_SLAM2
