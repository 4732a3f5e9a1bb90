#pragma once

#include <vector>

namespace dso {

struct FrameHessian;
struct CalibHessian;
class FrameShell;

namespace IOWrap {

class Output3DWrapper {
 public:
  virtual ~Output3DWrapper() = default;
  virtual void publishKeyframes(std::vector<FrameHessian*>&, bool, CalibHessian*) {}
  virtual void publishCamPose(FrameShell*, CalibHessian*) {}
};

}  // namespace IOWrap
}  // namespace dso
