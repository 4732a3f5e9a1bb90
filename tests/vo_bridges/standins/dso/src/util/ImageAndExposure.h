#pragma once

namespace dso {

class ImageAndExposure {
 public:
  ImageAndExposure(int width, int height, double timestamp = 0)
      : image(new float[width * height]), w(width), h(height), timestamp(timestamp) {}
  ~ImageAndExposure() { delete[] image; }
  ImageAndExposure(const ImageAndExposure&) = delete;
  ImageAndExposure& operator=(const ImageAndExposure&) = delete;
  float* image;
  int w, h;
  double timestamp;
  float exposure_time = 1.0F;
};

}  // namespace dso
