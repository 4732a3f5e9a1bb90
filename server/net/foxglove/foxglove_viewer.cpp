#include "server/net/foxglove/foxglove_viewer.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "server/net/foxglove/playback_parameters.hpp"

namespace overfly::net::foxglove {
namespace {

constexpr std::int64_t kBusyTickNs = 16'000'000;  ///< two ticks per frame of a 31 Hz camera
constexpr std::int64_t kQuietTickNs = 500'000'000;
/// Of the changes of parameters, one of which is the time.
constexpr std::int64_t kParametersPeriodNs = 500'000'000;

PlaybackStatus playback_status(const PlaybackClock& clock) {
  if (clock.playing()) return PlaybackStatus::kPlaying;
  const bool ended = clock.t_ns() >= clock.extent().end_ns;
  return ended ? PlaybackStatus::kEnded : PlaybackStatus::kPaused;
}

/// Time of the run that a client asks for [ns]; may lie outside the run.
std::int64_t t_ns_of(std::uint64_t utc_ns, std::int64_t epoch_utc_ns) {
  constexpr std::uint64_t kLatest = std::numeric_limits<std::int64_t>::max();
  return static_cast<std::int64_t>(std::min(utc_ns, kLatest)) - epoch_utc_ns;
}

}  // namespace

struct FoxgloveViewer::CommandVisitor {
  FoxgloveViewer& viewer;

  void operator()(const Subscribe& command) const { viewer.subscribe(command); }
  void operator()(const Unsubscribe& command) const { viewer.unsubscribe(command); }
  void operator()(const GetParameters& command) const { viewer.get_parameters(command); }
  void operator()(const SetParameters& command) const { viewer.set_parameters(command); }
  void operator()(const WatchParameters& command) const { viewer.watch_parameters(command); }
  void operator()(const PlaybackControl& command) const { viewer.control_playback(command); }
  void operator()(const NotOffered& command) const {
    viewer.refuse(command.what + ": this server does not offer it");
  }
};

void FoxgloveViewer::greet(const std::string& /*connection_name*/) {
  if (options_.run_id.empty()) {
    port_.open_newest_run();
  } else {
    port_.open_run(options_.run_id);
  }
}

void FoxgloveViewer::take_text(const std::string& text, std::int64_t now_ns) {
  take(parse_text(text), now_ns);
}

void FoxgloveViewer::take_binary(std::span<const std::uint8_t> bytes, std::int64_t now_ns) {
  take(parse_binary(bytes), now_ns);
}

void FoxgloveViewer::take(Result<Command> command, std::int64_t now_ns) {
  if (opening_) {
    waiting_.push_back(std::move(command));
  } else {
    carry_out(command, now_ns);
  }
}

void FoxgloveViewer::carry_out(const Result<Command>& command, std::int64_t now_ns) {
  if (!command) {
    refuse(command.error().message);
    return;
  }
  if (feed_ && feed_->advance(now_ns)) offer_channels();
  std::visit(CommandVisitor{*this}, *command);
  tick(now_ns);
}

void FoxgloveViewer::refuse(const std::string& what) {
  port_.send_text(status_text(StatusLevel::kWarning, what));
}

void FoxgloveViewer::run_opened(Result<std::shared_ptr<server::RunTimeline>> timeline,
                                std::int64_t now_ns) {
  if (!opening_) return;
  opening_ = false;
  if (timeline) {
    feed_ = std::make_unique<FlightFeed>(
        std::move(*timeline), port_, subscriptions_, options_.folder_of);
    const bool offered = feed_->advance(now_ns);
    send_info();
    if (offered) offer_channels();
  } else {
    send_info();
    port_.send_text(status_text(StatusLevel::kError, timeline.error().message));
  }
  for (const Result<Command>& command : std::exchange(waiting_, {})) carry_out(command, now_ns);
  tick(now_ns);
}

void FoxgloveViewer::send_info() {
  ServerInfo info;
  info.name = std::string("overfly ") + OVERFLY_VERSION;
  info.session = options_.session;
  if (feed_) {
    const server::RunInfo run = feed_->timeline().info();
    const PlaybackClock::Extent& extent = feed_->clock().extent();
    info.name += ", run " + run.id;
    info.metadata = {{"run", run.id}, {"scenario", run.scenario}};
    controlled_ =
        options_.playback_control && !extent.flying && feed_->messages().check_epoch().ok();
    if (controlled_) {
      const FlightMessages& messages = feed_->messages();
      info.span_utc_ns = {messages.utc_ns(extent.begin_ns), messages.utc_ns(extent.end_ns)};
    }
  }
  port_.send_text(info_text(info));
}

void FoxgloveViewer::offer_channels() {
  if (!subscriptions_.channels().empty()) {
    port_.send_text(unadvertise_text(subscriptions_.channels()));
  }
  port_.send_text(advertise_text(subscriptions_.offer(feed_->messages().names())));
}

/// A client that has no controls sees the flight from its beginning.
void FoxgloveViewer::begin_to_play() {
  if (std::exchange(begun_, true) || feed_->clock().live()) return;
  feed_->clock().play();
}

void FoxgloveViewer::subscribe(const Subscribe& command) {
  std::vector<std::string> refused;
  const std::vector<Channel> added = subscriptions_.subscribe(command, &refused);
  for (const std::string& what : refused) refuse(what);
  if (!feed_ || added.empty()) return;
  begin_to_play();
  feed_->send_present(added);
}

void FoxgloveViewer::unsubscribe(const Unsubscribe& command) {
  std::vector<std::string> refused;
  subscriptions_.unsubscribe(command, &refused);
  for (const std::string& what : refused) refuse(what);
}

void FoxgloveViewer::get_parameters(const GetParameters& command) {
  std::vector<Parameter> parameters;
  if (feed_) parameters = playback_parameters(*feed_);
  if (!command.names.empty()) {
    std::erase_if(parameters, [&](const Parameter& parameter) {
      return std::find(command.names.begin(), command.names.end(), parameter.name) ==
             command.names.end();
    });
  }
  port_.send_text(parameters_text(parameters, command.id));
}

void FoxgloveViewer::set_parameters(const SetParameters& command) {
  GetParameters answer;
  answer.id = command.id;
  for (const auto& [name, value] : command.values) {
    begun_ = begun_ || name == "playing" || name == "live" || name == "t_s";
    answer.names.push_back(name);
    if (!feed_) continue;
    if (Status status = set_playback_parameter(name, value, feed_.get()); !status) {
      refuse(status.error().message);
    }
  }
  if (answer.id && !answer.names.empty()) get_parameters(answer);
}

void FoxgloveViewer::watch_parameters(const WatchParameters& command) {
  if (command.names.empty()) {
    watches_all_ = command.wanted;
    if (!command.wanted) watched_.clear();
  }
  for (const std::string& name : command.names) {
    if (!command.wanted) {
      watched_.erase(name);
    } else if (watched_.size() < kMostEntries) {
      watched_.insert(name);
    }
  }
}

bool FoxgloveViewer::is_watched(const std::string& parameter) const {
  return watches_all_ || watched_.contains(parameter);
}

void FoxgloveViewer::control_playback(const PlaybackControl& command) {
  if (!controlled_) {
    refuse("playback control: is offered for a run that has flown");
    return;
  }
  if (!std::isfinite(command.speed)) {
    refuse("playback control: the speed must be a number");
    return;
  }
  begun_ = true;
  PlaybackClock& clock = feed_->clock();
  clock.set_speed(std::clamp(command.speed, kMinSpeed, kMaxSpeed));
  if (command.seek_utc_ns) {
    feed_->seek(t_ns_of(*command.seek_utc_ns, feed_->messages().utc_ns(0)));
  }
  if (command.play && !clock.playing()) clock.play();
  if (!command.play) clock.pause();
  send_playback(feed_->take_jumped(), command.request_id);
}

void FoxgloveViewer::tick(std::int64_t now_ns) {
  if (!feed_) return;
  if (feed_->advance(now_ns)) offer_channels();
  if (const Status status = feed_->messages().check_epoch();
      !status && !std::exchange(epoch_told_, true)) {
    port_.send_text(status_text(StatusLevel::kError, status.error().message));
  }
  const bool jumped = feed_->take_jumped();
  const PlaybackClock& clock = feed_->clock();
  if (jumped || playback_sent_ != std::pair(playback_status(clock), clock.speed())) {
    send_playback(jumped, "");
  }
  feed_->send_due(now_ns);
  send_parameter_changes(now_ns);
}

void FoxgloveViewer::send_playback(bool jumped, const std::string& request_id) {
  if (!controlled_) return;
  const PlaybackClock& clock = feed_->clock();
  PlaybackState state;
  state.status = playback_status(clock);
  state.utc_ns = feed_->messages().utc_ns(clock.t_ns());
  state.speed = clock.speed();
  state.did_seek = jumped;
  state.request_id = request_id;
  playback_sent_ = std::pair(state.status, state.speed);
  port_.send_binary(playback_message(state));
}

void FoxgloveViewer::send_parameter_changes(std::int64_t now_ns) {
  if (!watches_all_ && watched_.empty()) return;
  if (parameters_at_ns_ && now_ns - *parameters_at_ns_ < kParametersPeriodNs) return;
  if (port_.unsent_bytes() > kHighWaterBytes) return;
  std::vector<Parameter> changed = playback_parameters(*feed_);
  std::erase_if(changed, [&](const Parameter& parameter) {
    const auto sent = parameters_sent_.find(parameter.name);
    const bool same = sent != parameters_sent_.end() && sent->second == parameter.value;
    return same || !is_watched(parameter.name);
  });
  if (changed.empty()) return;
  parameters_at_ns_ = now_ns;
  for (const Parameter& parameter : changed) parameters_sent_[parameter.name] = parameter.value;
  port_.send_text(parameters_text(changed, std::nullopt));
}

void FoxgloveViewer::picture_ready(const PictureTicket& ticket,
                                   const Result<server::Picture>& picture,
                                   std::int64_t now_ns) {
  if (!feed_) return;
  feed_->picture_ready(ticket, picture);
  tick(now_ns);
}

void FoxgloveViewer::picture_sent(const PictureTicket& ticket, std::int64_t now_ns) {
  if (!feed_) return;
  feed_->picture_sent(ticket);
  tick(now_ns);
}

std::optional<std::int64_t> FoxgloveViewer::tick_after_ns() const {
  if (!feed_) return std::nullopt;
  return feed_->busy() ? kBusyTickNs : kQuietTickNs;
}

}  // namespace overfly::net::foxglove
