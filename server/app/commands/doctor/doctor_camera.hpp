// `overfly doctor --camera`: the error of depth and pose, in pixels of the next image.
#pragma once

#include <string>

namespace overfly::app {

struct DoctorCameraArguments {
  std::string scenario;  ///< file; empty = a built-in one, drawn by every available backend
  int pairs = 4;
  double limit_px = 0.1;
  bool json = false;
};

/// Prints one row for each camera and backend. @return exit code: 4 if a limit is exceeded
int check_cameras(const DoctorCameraArguments& arguments);

}  // namespace overfly::app
