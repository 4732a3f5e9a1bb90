#pragma once

#include <sophus/se3.h>

#include <list>
#include <memory>

#include "feature.h"
#include "point.h"

namespace svo {

class Frame {
 public:
  ~Frame() {
    for (Feature* feature : fts_) {
      delete feature->point;
      delete feature;
    }
  }
  Eigen::Vector3d w2f(const Eigen::Vector3d& p_world) const { return T_f_w_ * p_world; }
  Sophus::SE3 T_f_w_;
  std::list<Feature*> fts_;
};

using FramePtr = std::shared_ptr<Frame>;

}  // namespace svo
