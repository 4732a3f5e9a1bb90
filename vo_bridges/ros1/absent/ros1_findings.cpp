#include "vo_bridges/ros1/ros1_findings.hpp"

namespace overfly {

Ros1Findings ros1_findings() {
  return {false,
          false,
          "not built in",
          "apt-get install libroscpp-dev libsensor-msgs-dev libnav-msgs-dev libtf2-msgs-dev "
          "librosbag-storage-dev, and rebuild"};
}

}  // namespace overfly
