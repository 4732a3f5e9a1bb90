#include "flight/playback/play_records.hpp"

#include <poll.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <memory>
#include <utility>

#include "flight/mavlink/link/byte_link.hpp"
#include "flight/mavlink/link/open_byte_link.hpp"

namespace overfly::flight::playback {
namespace {

using mavlink::ByteLink;
using TimePoint = PlaybackClock::TimePoint;

constexpr std::chrono::seconds kReopenAfter{1};
constexpr std::chrono::milliseconds kLongestStep{20};
/// Frames in one step, so that commands are heard also at the highest speed.
constexpr int kMostFramesAtOnce = 2000;

/// Everybody who listens.
class Listeners {
 public:
  explicit Listeners(mavlink::LinkAddress address) : address_(std::move(address)) {}

  Status open() {
    auto link = mavlink::open_byte_link(address_, false);
    if (!link) return link.error();
    link_ = std::move(*link);
    address_ = link_->address();
    heard_.fill(false);
    return {};
  }

  /// Waits, takes what the other side sends, and opens the link again after a failure.
  void step(TimePoint now, std::chrono::milliseconds patience) {
    if (!link_ && now >= retry_ && !open()) retry_ = now + kReopenAfter;
    std::vector<pollfd> descriptors;
    if (link_) link_->add_to_poll(descriptors);
    (void)::poll(descriptors.data(), descriptors.size(), static_cast<int>(patience.count()));
    if (!link_) return;
    const auto hear = [this](mavlink::PeerId peer, std::span<const std::uint8_t> /*bytes*/) {
      heard_[peer] = true;
    };
    if (link_->exchange(hear)) return;
    link_.reset();
    retry_ = now + kReopenAfter;
  }

  [[nodiscard]] bool any() const {
    if (!link_) return false;
    if (address_.kind != mavlink::LinkKind::kUdpListen) return link_->connected();
    return std::find(heard_.begin(), heard_.end(), true) != heard_.end();
  }

  bool send(std::span<const std::uint8_t> frame) {
    if (!link_) return false;
    if (address_.kind != mavlink::LinkKind::kUdpListen) return link_->send(0, frame);
    bool sent = false;
    for (mavlink::PeerId peer = 0; peer < mavlink::kMaxPeers; ++peer) {
      if (heard_[peer]) sent = link_->send(peer, frame) || sent;
    }
    return sent;
  }

  [[nodiscard]] const mavlink::LinkAddress& address() const { return address_; }

 private:
  mavlink::LinkAddress address_;
  std::unique_ptr<ByteLink> link_;
  std::array<bool, mavlink::kMaxPeers> heard_{};
  TimePoint retry_;
};

class Playback {
 public:
  Playback(PlaybackRecords& records,
           Listeners& listeners,
           const PlaybackOptions& options,
           TimePoint now)
      : records_(records),
        listeners_(listeners),
        options_(options),
        clock_(options.speed, options.from_us, now) {}

  Status begin() { return records_.seek(options_.from_us); }

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
        return go_to(std::clamp<std::int64_t>(wanted_us, 0, records_.duration_us()), now);
      }
      case PlaybackCommand::Kind::kQuit:
        break;
    }
    return false;
  }

  /// Sends what is due. @return whether the playback goes on
  Result<bool> send_due(TimePoint now) {
    for (int i = 0; i < kMostFramesAtOnce; ++i) {
      if (!next_) {
        Result<std::optional<PlaybackRecords::Record>> record = records_.next();
        if (!record) return record.error();
        if (!*record) {
          if (!options_.repeat) return false;
          return go_to(options_.from_us, now);
        }
        next_ = **record;
      }
      if (next_->t_us > clock_.position_us(now)) break;
      ++(listeners_.send(next_->frame) ? summary_.sent : summary_.unsent);
      next_.reset();
    }
    return true;
  }

  /// Holds the position while nobody listens.
  void wait_here(TimePoint now) { clock_.move_to(clock_.position_us(last_), now); }
  void passed(TimePoint now) { last_ = now; }

  [[nodiscard]] std::chrono::milliseconds patience(TimePoint now) const {
    if (clock_.paused()) return kLongestStep;
    if (!next_) return std::chrono::milliseconds(0);
    const double left_us =
        static_cast<double>(next_->t_us - clock_.position_us(now)) / clock_.speed();
    return std::chrono::milliseconds(std::clamp<std::int64_t>(
        static_cast<std::int64_t>(left_us / 1000.0), 0, kLongestStep.count()));
  }
  [[nodiscard]] const PlaybackClock& clock() const { return clock_; }
  [[nodiscard]] const PlaybackSummary& summary() const { return summary_; }

 private:
  Result<bool> go_to(std::int64_t position_us, TimePoint now) {
    if (Status status = records_.seek(position_us); !status) return status.error();
    next_.reset();
    clock_.move_to(position_us, now);
    return true;
  }

  PlaybackRecords& records_;
  Listeners& listeners_;
  PlaybackOptions options_;
  PlaybackClock clock_;
  std::optional<PlaybackRecords::Record> next_;
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

Result<PlaybackSummary> play_records(PlaybackRecords& records,
                                     const mavlink::LinkAddress& address,
                                     const PlaybackOptions& options,
                                     const PlaybackPorts& ports,
                                     const std::atomic<bool>& stop) {
  Listeners listeners(address);
  if (Status status = listeners.open(); !status) return status.error();
  if (ports.opened) ports.opened(listeners.address());
  Playback playback(records, listeners, options, ports.now());
  if (Status status = playback.begin(); !status) return status.error();
  bool goes_on = true;
  bool waiting = options.wait_for_listener;
  playback.passed(ports.now());
  while (goes_on && !stop.load()) {
    listeners.step(ports.now(), waiting ? kLongestStep : playback.patience(ports.now()));
    const TimePoint now = ports.now();
    waiting = waiting && !listeners.any();
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
  // What waits in a buffer of the link.
  listeners.step(ports.now(), std::chrono::milliseconds(0));
  return playback.summary();
}

}  // namespace overfly::flight::playback
