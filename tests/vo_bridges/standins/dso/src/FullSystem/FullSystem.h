// A stand-in for DSO with the interface that the adapter uses: written for its test, knows the
// camera's path (flown_path.hpp), takes its orders from the frames' first pixel.
#pragma once

#include <IOWrapper/Output3DWrapper.h>
#include <util/FrameShell.h>
#include <util/ImageAndExposure.h>

#include <memory>
#include <vector>

namespace dso {

class FullSystem {
 public:
  void addActiveFrame(ImageAndExposure* image, int id);
  void setGammaFunction(float* response) { has_response_ = response != nullptr; }

  std::vector<IOWrap::Output3DWrapper*> outputWrapper;
  bool isLost = false;
  bool initFailed = false;
  bool initialized = false;
  bool linearizeOperation = true;

 private:
  void publish_keyframe(FrameShell* shell);

  int frames_ = 0;
  int keyframes_ = 0;
  bool has_response_ = false;
  std::vector<std::unique_ptr<FrameShell>> shells_;
};

}  // namespace dso
