#include "flight/playback/play.hpp"

#include <algorithm>
#include <charconv>
#include <tuple>

namespace overfly::flight::playback {
namespace {

using TimePoint = PlaybackClock::TimePoint;

constexpr std::chrono::milliseconds kLongestStep{20};
/// Times of messages in one step, so that commands are heard also at the highest speed.
constexpr int kMostAtOnce = 2000;

class Playback {
 public:
  Playback(PlaybackOutput& output, const PlaybackOptions& options, TimePoint now)
      : output_(output), options_(options), clock_(options.speed, options.from_us, now) {}

  Status begin() { return output_.seek(options_.from_us); }

  /// @return whether the playback goes on
  Result<bool> obey(const PlaybackCommand& command, TimePoint now) {
    switch (command.kind) {
      case PlaybackCommand::Kind::kPause:
        clock_.pause(now);
        return true;
      case PlaybackCommand::Kind::kPlay:
        clock_.play(now);
        return true;
      case PlaybackCommand::Kind::kSpeed:
        clock_.set_speed(command.value, now);
        return true;
      case PlaybackCommand::Kind::kSeek: {
        const auto wanted_us = static_cast<std::int64_t>(command.value * 1e6);
        return go_to(std::clamp<std::int64_t>(wanted_us, 0, output_.duration_us()), now);
      }
      case PlaybackCommand::Kind::kQuit:
        break;
    }
    return false;
  }

  /// Sends what is due. @return whether the playback goes on
  Result<bool> send_due(TimePoint now) {
    for (int i = 0; i < kMostAtOnce; ++i) {
      Result<std::optional<std::int64_t>> next_us = output_.next_us();
      if (!next_us) return next_us.error();
      if (!*next_us) {
        if (!options_.repeat) return false;
        return go_to(options_.from_us, now);
      }
      next_us_ = **next_us;
      if (next_us_ > clock_.position_us(now)) break;
      if (Status status = output_.send(summary_); !status) return status.error();
      next_us_ = 0;
    }
    return true;
  }

  /// Holds the position while nobody listens.
  void wait_here(TimePoint now) { clock_.move_to(clock_.position_us(last_), now); }
  void passed(TimePoint now) { last_ = now; }

  [[nodiscard]] std::chrono::milliseconds patience(TimePoint now) const {
    if (clock_.paused()) return kLongestStep;
    const double left_us = static_cast<double>(next_us_ - clock_.position_us(now)) / clock_.speed();
    return std::chrono::milliseconds(std::clamp<std::int64_t>(
        static_cast<std::int64_t>(left_us / 1000.0), 0, kLongestStep.count()));
  }
  [[nodiscard]] const PlaybackClock& clock() const { return clock_; }
  [[nodiscard]] const PlaybackSummary& summary() const { return summary_; }

 private:
  Result<bool> go_to(std::int64_t position_us, TimePoint now) {
    if (Status status = output_.seek(position_us); !status) return status.error();
    next_us_ = 0;
    clock_.move_to(position_us, now);
    return true;
  }

  PlaybackOutput& output_;
  PlaybackOptions options_;
  PlaybackClock clock_;
  std::int64_t next_us_ = 0;  ///< of the next message, as far as it is known
  PlaybackSummary summary_;
  TimePoint last_;
};

}  // namespace

Result<PlaybackCommand> parse_playback_command(const std::string& line) {
  using Kind = PlaybackCommand::Kind;
  if (line == "pause") return PlaybackCommand{Kind::kPause};
  if (line == "play") return PlaybackCommand{Kind::kPlay};
  if (line == "quit") return PlaybackCommand{Kind::kQuit};
  for (const auto& [name, kind, least, most] :
       {std::tuple("speed ", Kind::kSpeed, kSlowest, kFastest),
        std::tuple("seek ", Kind::kSeek, 0.0, 1e9)}) {
    if (!line.starts_with(name)) continue;
    const char* const begin = line.data() + std::string_view(name).size();
    const char* const end = line.data() + line.size();
    double value = 0.0;
    const auto [at, failed] = std::from_chars(begin, end, value);
    if (failed == std::errc() && at == end && value >= least && value <= most) {
      return PlaybackCommand{kind, value};
    }
  }
  return Error{ErrorCode::kInvalidArgument,
               "\"" + line.substr(0, 40) +
                   "\": must be pause, play, speed X (0.01 to 1000), seek SECONDS, or quit"};
}

Result<PlaybackSummary> play(PlaybackOutput& output,
                             const PlaybackOptions& options,
                             const PlaybackPorts& ports,
                             const std::atomic<bool>& stop) {
  if (Status status = output.open(&stop); !status) return status.error();
  if (ports.opened) ports.opened(output);
  Playback playback(output, options, ports.now());
  if (Status status = playback.begin(); !status) return status.error();
  bool goes_on = true;
  bool waiting = options.wait_for_listener;
  playback.passed(ports.now());
  while (goes_on && !stop.load()) {
    output.wait(ports.now(), waiting ? kLongestStep : playback.patience(ports.now()));
    const TimePoint now = ports.now();
    waiting = waiting && !output.is_heard();
    if (waiting) playback.wait_here(now);
    playback.passed(now);
    for (const PlaybackCommand& command : ports.commands()) {
      const Result<bool> obeyed = playback.obey(command, now);
      if (!obeyed) return obeyed.error();
      goes_on = goes_on && *obeyed;
      if (ports.changed) ports.changed(playback.clock(), playback.clock().position_us(now));
    }
    if (!goes_on || waiting) continue;
    const Result<bool> more = playback.send_due(now);
    if (!more) return more.error();
    goes_on = *more;
  }
  if (Status status = output.finish(); !status) return status.error();
  return playback.summary();
}

}  // namespace overfly::flight::playback
