#pragma once

namespace svo {

class DepthFilter {
 public:
  void stopThread() { in_thread = false; }
  bool in_thread = true;
};

}  // namespace svo
