#include "flight/live/truth_streams.hpp"

#include <tuple>

namespace overfly::flight::live {
namespace {

using logs::SourceOrigin;

bool is_preferred(const LiveStream& stream, TruthPreference preference) {
  const SourceOrigin origin = stream.description.origin;
  if (preference == TruthPreference::kSimulation) return origin == SourceOrigin::kSimulation;
  if (preference == TruthPreference::kEstimate) return origin == SourceOrigin::kEstimate;
  return origin == SourceOrigin::kSimulation || origin == SourceOrigin::kEstimate;
}

}  // namespace

std::optional<TruthStreams> choose_streams(const LiveSamples& samples, TruthPreference preference) {
  const std::deque<LiveStream>& streams = samples.streams();
  const auto rank = [](const LiveStream& stream) {
    return std::tuple(stream.description.origin, stream.description.preference);
  };
  std::optional<logs::StreamId> position;
  for (logs::StreamId i = 0; i < streams.size(); ++i) {
    if (streams[i].positions.empty() || !is_preferred(streams[i], preference)) continue;
    if (!position || rank(streams[i]) < rank(streams[*position])) position = i;
  }
  if (!position) return std::nullopt;
  // An attitude of another origin would be of another aircraft, in a way.
  const SourceOrigin origin = streams[*position].description.origin;
  std::optional<logs::StreamId> attitude;
  if (!streams[*position].attitudes.empty()) attitude = position;
  for (logs::StreamId i = 0; i < streams.size() && attitude != position; ++i) {
    if (streams[i].attitudes.empty() || streams[i].description.origin != origin) continue;
    if (!attitude || rank(streams[i]) < rank(streams[*attitude])) attitude = i;
  }
  if (!attitude) return std::nullopt;
  return TruthStreams{*position, *attitude, origin == SourceOrigin::kSimulation};
}

std::string missing_text(const LiveSamples& samples, TruthPreference preference) {
  if (preference == TruthPreference::kSimulation) {
    return "the vehicle sends no SIM_STATE and no HIL_STATE_QUATERNION";
  }
  bool positions = false;
  bool attitudes = false;
  for (const LiveStream& stream : samples.streams()) {
    if (stream.without_origin > 0 && !stream.origin) {
      return "the origin of " + stream.description.name + " is unknown: no GPS_GLOBAL_ORIGIN came";
    }
    positions = positions || !stream.positions.empty();
    attitudes = attitudes || !stream.attitudes.empty();
  }
  if (samples.streams().empty()) return "no message of the vehicle came";
  std::string text;
  const auto add = [&text](const std::string& what) {
    if (!text.empty()) text += "; ";
    text += what;
  };
  if (!positions) add("no valid position (GLOBAL_POSITION_INT) came");
  if (!attitudes) add("no attitude (ATTITUDE) came");
  if (samples.invalid() > 0) add(std::to_string(samples.invalid()) + " samples were invalid");
  return text.empty() ? "positions and attitudes do not go together" : text;
}

}  // namespace overfly::flight::live
