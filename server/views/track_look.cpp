#include "server/views/track_look.hpp"

namespace overfly::server {
namespace {

/// Those of the dashboard's dark theme, which suit dark ground.
constexpr std::array<TrackRgb, 6> kEstimatorRgb = {{{0.15F, 0.45F, 1.0F},
                                                    {0.10F, 0.72F, 0.35F},
                                                    {0.95F, 0.65F, 0.10F},
                                                    {0.65F, 0.35F, 0.90F},
                                                    {0.24F, 0.82F, 0.67F},
                                                    {0.90F, 0.47F, 0.75F}}};

}  // namespace

TrackRgb estimator_rgb(std::size_t index) { return kEstimatorRgb[index % kEstimatorRgb.size()]; }

TrackRgb TrackLook::truth_rgb() const {
  const auto chosen = colours.find("");
  return chosen == colours.end() ? kTruthRgb : chosen->second;
}

TrackRgb TrackLook::rgb_of(const std::string& name, std::size_t index) const {
  const auto chosen = colours.find(name);
  return chosen == colours.end() ? estimator_rgb(first_colour + index) : chosen->second;
}

}  // namespace overfly::server
