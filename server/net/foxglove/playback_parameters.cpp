#include "server/net/foxglove/playback_parameters.hpp"

#include <cmath>

#include "core/time.hpp"

namespace overfly::net::foxglove {
namespace {

using nlohmann::json;

Error must_be(const std::string& name, const std::string& limit) {
  return {ErrorCode::kInvalidArgument, name + ": must be " + limit};
}

Status set_flag(const std::string& name, const json& value, FlightFeed* feed) {
  if (!value.is_boolean()) return must_be(name, "true or false");
  const bool on = value.get<bool>();
  if (name == "loop") {
    feed->clock().set_loop(on);
  } else if (!on) {
    feed->clock().pause();
  } else if (name == "playing") {
    feed->clock().play();
  } else if (!feed->go_live()) {
    return Error{ErrorCode::kConflict, "live: the run does not fly"};
  }
  return {};
}

Status set_number(const std::string& name, const json& value, FlightFeed* feed) {
  const double number = value.is_number() ? value.get<double>() : std::nan("");
  if (name == "speed") {
    if (!(number >= kMinSpeed && number <= kMaxSpeed)) return must_be(name, "in [0.1, 50]");
    feed->clock().set_speed(number);
    return {};
  }
  constexpr double kLongestS = 1e8;
  if (!(number >= 0.0 && number <= kLongestS)) return must_be(name, "in [0, 1e8] s");
  feed->seek(std::llround(number * static_cast<double>(kNsPerS)));
  return {};
}

}  // namespace

std::vector<Parameter> playback_parameters(const FlightFeed& feed) {
  const PlaybackClock& clock = feed.clock();
  const double t_s = static_cast<double>(clock.t_ns()) / static_cast<double>(kNsPerS);
  return {{"run", feed.timeline().info().id, false},
          {"playing", clock.playing(), false},
          {"live", clock.live(), false},
          {"loop", clock.loop(), false},
          {"speed", clock.speed(), true},
          {"t_s", t_s, true},
          {"alignment", feed.messages().places().mode, false}};
}

Status set_playback_parameter(const std::string& name, const json& value, FlightFeed* feed) {
  if (name == "playing" || name == "live" || name == "loop") return set_flag(name, value, feed);
  if (name == "speed" || name == "t_s") return set_number(name, value, feed);
  if (name == "alignment") {
    if (!value.is_string()) return must_be(name, "the name of an alignment");
    return feed->align(value.get<std::string>());
  }
  if (name == "run") return Error{ErrorCode::kConflict, "run: cannot be set; connect again"};
  return Error{ErrorCode::kNotFound, "parameter " + name + ": does not exist"};
}

}  // namespace overfly::net::foxglove
