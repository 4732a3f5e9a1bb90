#include "server/scenario/scenario.hpp"

namespace overfly::server {

const char* to_string(Pacing pacing) {
  return pacing == Pacing::kRealTime ? "real_time" : "lockstep";
}

}  // namespace overfly::server
