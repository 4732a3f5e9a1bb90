// Which of a live vehicle's streams are its truth. Private to live.
#pragma once

#include <optional>

#include "flight/live/live_options.hpp"
#include "flight/live/live_samples.hpp"

namespace overfly::flight::live {

struct TruthStreams {
  logs::StreamId position = 0;
  logs::StreamId attitude = 0;
  bool simulation = false;
};

/// The best georeferenced positions and the best attitudes that go with them, as in recordings;
/// empty if there are none of the preferred origin.
[[nodiscard]] std::optional<TruthStreams> choose_streams(const LiveSamples& samples,
                                                         TruthPreference preference);

/// What is missing, for messages: "no SIM_STATE has come".
[[nodiscard]] std::string missing_text(const LiveSamples& samples, TruthPreference preference);

}  // namespace overfly::flight::live
