#include "middleware/ros1/findings.hpp"

namespace overfly::ros1 {

bool is_built_in() { return false; }

Findings findings() {
  return {false,
          false,
          "not built in",
          "apt-get install libroscpp-dev libsensor-msgs-dev libnav-msgs-dev libtf2-msgs-dev "
          "librosbag-storage-dev, and rebuild"};
}

}  // namespace overfly::ros1
