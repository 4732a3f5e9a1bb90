#include "core/motion/estimate.hpp"

namespace overfly {

const char* to_string(TrackingState state) {
  switch (state) {
    case TrackingState::kInitialising:
      return "INITIALISING";
    case TrackingState::kTracking:
      return "TRACKING";
    case TrackingState::kLost:
      return "LOST";
  }
  return "LOST";
}

std::optional<TrackingState> tracking_state_from(const std::string& text) {
  for (TrackingState state :
       {TrackingState::kInitialising, TrackingState::kTracking, TrackingState::kLost}) {
    if (text == to_string(state)) return state;
  }
  return std::nullopt;
}

}  // namespace overfly
