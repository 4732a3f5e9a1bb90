#pragma once

namespace vk {

class AbstractCamera {
 public:
  AbstractCamera(double width, double height) : width(width), height(height) {}
  virtual ~AbstractCamera() = default;
  double width, height;
};

class PinholeCamera : public AbstractCamera {
 public:
  PinholeCamera(double width,
                double height,
                double fx,
                double fy,
                double cx,
                double cy,
                double d0 = 0.0,
                double d1 = 0.0,
                double d2 = 0.0,
                double d3 = 0.0,
                double d4 = 0.0)
      : AbstractCamera(width, height), fx(fx), fy(fy), cx(cx), cy(cy), d{d0, d1, d2, d3, d4} {}
  double fx, fy, cx, cy;
  double d[5];
};

}  // namespace vk
