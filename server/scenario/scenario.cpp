#include "server/scenario/scenario.hpp"

#include <algorithm>

namespace overfly::server {

const char* to_string(Pacing pacing) {
  return pacing == Pacing::kRealTime ? "real_time" : "lockstep";
}

const CameraSpec* Scenario::recorded_camera() const {
  const auto found = std::find_if(cameras.begin(), cameras.end(), [](const CameraSpec& camera) {
    return camera.images.has_value();
  });
  return found == cameras.end() ? nullptr : &*found;
}

}  // namespace overfly::server
