#include "server/scenario/scenario.hpp"

namespace overfly::engine {

const char* to_string(Pacing pacing) {
  return pacing == Pacing::kRealTime ? "real_time" : "lockstep";
}

}  // namespace overfly::engine
