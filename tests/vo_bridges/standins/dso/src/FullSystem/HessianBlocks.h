#pragma once

#include <util/FrameShell.h>

#include <vector>

namespace dso {

struct PointHessian {
  float u, v, idepth_scaled;
};

struct FrameHessian {
  FrameShell* shell;
  int frameID;
  std::vector<PointHessian*> pointHessians;
};

struct CalibHessian {
  float& fxl() { return values[0]; }
  float& fyl() { return values[1]; }
  float& cxl() { return values[2]; }
  float& cyl() { return values[3]; }
  float values[4];
};

}  // namespace dso
