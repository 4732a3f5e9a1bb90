#pragma once

#include <memory>

#include "ORBextractor.h"

namespace ORB_SLAM2 {

class Tracking {
 public:
  enum eTrackingState { SYSTEM_NOT_READY = -1, NO_IMAGES_YET, NOT_INITIALIZED, OK, LOST };
  explicit Tracking(ORBextractor* extractor) : mpORBextractorLeft(extractor) {}
  eTrackingState mState = NO_IMAGES_YET;
  int since_start = 0;
  long unsigned int next_keyframe = 0;

 protected:
  ORBextractor* mpORBextractorLeft;
};

}  // namespace ORB_SLAM2
