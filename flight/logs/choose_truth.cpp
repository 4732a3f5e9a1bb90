#include <algorithm>
#include <tuple>

#include "flight/logs/flight_log.hpp"

namespace overfly::flight::logs {
namespace {

/// What follows the sender in a name: "SIM_STATE" of "1.1/SIM_STATE".
std::string short_name(const std::string& name) {
  const std::size_t slash = name.find('/');
  return slash == std::string::npos ? name : name.substr(slash + 1);
}

/// Smaller is better.
auto position_rank(const StreamInfo& stream) {
  const StreamDescription& description = stream.description;
  return std::tuple(!stream.georeferenced, description.origin, description.preference);
}

bool has_positions(const StreamInfo& stream) { return stream.positions > 0; }

std::string names_of_sources(const std::vector<StreamInfo>& streams) {
  std::string names;
  for (const StreamInfo& stream : streams) {
    if (has_positions(stream)) names += (names.empty() ? "" : ", ") + stream.description.name;
  }
  return names;
}

Result<StreamId> named_source(const std::vector<StreamInfo>& streams, const std::string& name) {
  std::optional<StreamId> found;
  for (std::size_t i = 0; i < streams.size(); ++i) {
    const std::string& candidate = streams[i].description.name;
    if (!has_positions(streams[i])) continue;
    if (candidate == name || candidate == name + "[0]") return static_cast<StreamId>(i);
    if (short_name(candidate) != name) continue;
    if (found) {
      return Error{ErrorCode::kInvalidArgument,
                   "source " + name + ": several senders have it: name it in full, one of " +
                       names_of_sources(streams)};
    }
    found = static_cast<StreamId>(i);
  }
  if (found) return *found;
  return Error{ErrorCode::kInvalidArgument,
               "source " + name +
                   ": must be one of the sources with positions: " + names_of_sources(streams)};
}

/// @param same_origin  prefers attitudes of the position's origin to more trusted ones
std::optional<StreamId> attitude_for(const std::vector<StreamInfo>& streams,
                                     StreamId position,
                                     bool same_origin) {
  const StreamInfo& source = streams[position];
  if (source.attitudes > 0) return position;
  std::optional<StreamId> best;
  const auto rank = [&](const StreamInfo& stream) {
    const SourceOrigin origin = stream.description.origin;
    return std::tuple(
        same_origin && origin != source.description.origin, origin, stream.description.preference);
  };
  for (std::size_t i = 0; i < streams.size(); ++i) {
    const StreamInfo& candidate = streams[i];
    if (candidate.attitudes == 0 || candidate.description.vehicle != source.description.vehicle) {
      continue;
    }
    if (!best || rank(candidate) < rank(streams[*best])) best = static_cast<StreamId>(i);
  }
  return best;
}

std::string reason_for(const std::vector<StreamInfo>& streams, StreamId position) {
  const SourceOrigin origin = streams[position].description.origin;
  const bool georeferenced = streams[position].georeferenced;
  const std::string place =
      georeferenced ? "" : ", in metres from an origin that the log does not state";
  const bool others = std::any_of(streams.begin(), streams.end(), [](const StreamInfo& stream) {
    return has_positions(stream) && stream.description.origin != SourceOrigin::kGps;
  });
  switch (origin) {
    case SourceOrigin::kSimulation:
      return "the simulator's own state, without the errors of an estimator" + place;
    case SourceOrigin::kEstimate:
      return "the autopilot's estimate: the log has no state of a simulator" + place;
    default:
      return others ? "unfiltered GPS: all other positions count from an origin that the log does "
                      "not state"
                    : "unfiltered GPS: the log has neither a simulator's state nor an estimate" +
                          place;
  }
}

}  // namespace

Result<TruthChoice> choose_truth(const std::vector<StreamInfo>& streams, const std::string& name) {
  std::optional<StreamId> best;
  for (std::size_t i = 0; i < streams.size(); ++i) {
    if (!has_positions(streams[i])) continue;
    if (!best || position_rank(streams[i]) < position_rank(streams[*best])) {
      best = static_cast<StreamId>(i);
    }
  }
  if (!best) {
    std::string message = "the log has no valid positions";
    for (const StreamInfo& stream : streams) {
      if (stream.description.position == PositionKind::kNone) continue;
      if (const std::string text = wrong_values_text(stream); !text.empty()) message += "; " + text;
    }
    return Error{ErrorCode::kUnreadable, message};
  }
  TruthChoice choice{*best, std::nullopt, reason_for(streams, *best)};
  if (!name.empty()) {
    const Result<StreamId> named = named_source(streams, name);
    if (!named) return named.error();
    choice.position = *named;
    choice.reason = "as asked for";
  }
  choice.attitude = attitude_for(streams, choice.position, !name.empty());
  return choice;
}

Result<TruthChoice> choose_truth(const OpenedLog& log, const std::string& name) {
  Result<TruthChoice> choice = choose_truth(log.streams, name);
  if (choice) return choice;
  if (choice.error().code == ErrorCode::kUnreadable && !log.slice.is_whole()) {
    return Error{ErrorCode::kUnreadable,
                 log.file.string() + ": no valid positions in the time asked for"};
  }
  return choice.error().in(log.file.string());
}

}  // namespace overfly::flight::logs
