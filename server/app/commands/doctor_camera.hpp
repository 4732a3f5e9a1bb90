// `overfly doctor --camera`: how far depth and pose miss the next image, in pixels.
#pragma once

#include <string>

namespace overfly::app {

struct DoctorCameraArguments {
  std::string scenario;  ///< name
  int pairs = 4;
  double limit_px = 0.1;
  bool json = false;
};

/// Prints one row for each camera and backend. @return exit code: 4 where a limit is exceeded
int check_cameras(const DoctorCameraArguments& arguments);

}  // namespace overfly::app
