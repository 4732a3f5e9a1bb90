#include "server/net/stream/viewer.hpp"

#include <algorithm>
#include <utility>

#include "server/net/http/json_text.hpp"
#include "server/net/stream/run_instant.hpp"

namespace overfly::net {
namespace {

using Resume = std::map<std::string, std::size_t>;

constexpr int kProtocol = 2;
constexpr std::int64_t kPlayingTickNs = 16'000'000;  ///< two ticks per frame of a 31 Hz camera
constexpr std::int64_t kRunningTickNs = 100'000'000;
constexpr std::int64_t kIdleTickNs = 1'000'000'000;
constexpr std::int64_t kPlaybackPeriodNs = 50'000'000;
constexpr std::int64_t kExtentPeriodNs = 500'000'000;

void answer(const std::optional<std::int64_t>& request, const Status& status, ViewerPort* port) {
  nlohmann::json message = {{"type", status ? "ok" : "error"}};
  if (request) message["request"] = *request;
  if (!status) {
    message["code"] = to_string(status.error().code);
    message["message"] = status.error().message;
  }
  if (!status || request) port->send_text(to_text(message));
}

nlohmann::json range_json(const std::optional<PlaybackClock::Range>& range) {
  if (!range) return nullptr;
  return {{"begin_ns", range->begin_ns}, {"end_ns", range->end_ns}};
}

nlohmann::json clock_json(const PlaybackClock& clock) {
  const PlaybackClock::Extent& extent = clock.extent();
  return {{"type", "playback"},
          {"t_ns", clock.t_ns()},
          {"playing", clock.playing()},
          {"live", clock.live()},
          {"speed", clock.speed()},
          {"loop", clock.loop()},
          {"range", range_json(clock.range())},
          {"begin_ns", extent.begin_ns},
          {"end_ns", extent.end_ns},
          {"flying", extent.flying}};
}

}  // namespace

/// Executes each command; messages that result from it are sent by the tick after the answer.
struct Viewer::CommandVisitor {
  Viewer& viewer;
  std::int64_t now_ns;

  /// Answered when the run is open.
  Status operator()(const WatchCommand& /*command*/) const { return {}; }
  Status operator()(const UnwatchCommand& command) const { return viewer.unwatch(command); }
  Status operator()(const SubscribeCommand& command) const {
    viewer.pictures_.subscribe(command);
    viewer.pictures_due_ = true;
    return {};
  }
  Status operator()(const ShownCommand& command) const {
    viewer.pictures_.shown(command);
    return {};
  }
  Status operator()(const KeyCommand& command) const {
    return viewer.pictures_.restart_video(command);
  }
  Status operator()(const ViewCommand& command) const {
    return viewer.pictures_.set_view(command, now_ns);
  }
  Status operator()(const SeekCommand& command) const { return viewer.seek(command); }
  Status operator()(const StepCommand& command) const { return viewer.step(command); }
  Status operator()(const PlayCommand& /*command*/) const {
    return with_clock([](PlaybackClock* clock) { clock->play(); });
  }
  Status operator()(const PauseCommand& /*command*/) const {
    viewer.pictures_.show_again();
    return with_clock([](PlaybackClock* clock) { clock->pause(); });
  }
  Status operator()(const SpeedCommand& command) const {
    return with_clock([&](PlaybackClock* clock) { clock->set_speed(command.value); });
  }
  Status operator()(const LoopCommand& command) const {
    return with_clock([&](PlaybackClock* clock) { clock->set_loop(command.value); });
  }
  Status operator()(const RangeCommand& command) const {
    return with_clock([&](PlaybackClock* clock) { clock->set_range(command.range); });
  }
  Status operator()(const AlignCommand& command) const { return viewer.align(command); }
  Status operator()(const LiveCommand& /*command*/) const {
    bool live = false;
    Status status = with_clock([&](PlaybackClock* clock) { live = clock->go_live(); });
    if (status && !live) return Error{ErrorCode::kConflict, "no watched run flies"};
    return status;
  }

 private:
  template <typename Action>
  Status with_clock(Action action) const {
    if (viewer.watches_.empty()) return Error{ErrorCode::kConflict, "no run is watched"};
    action(&viewer.clock_);
    viewer.playback_due_ = true;
    return {};
  }
};

void Viewer::greet(const std::string& connection_name) {
  port_.send_text(to_text({{"type", "hello"},
                           {"protocol", kProtocol},
                           {"server", std::string("overfly ") + OVERFLY_VERSION},
                           {"access", access_ == Access::kViewer ? "viewer" : "operator"},
                           {"connection", connection_name}}));
}

void Viewer::take_text(const std::string& text, std::int64_t now_ns) {
  if (opening_) {
    waiting_.push_back(text);
  } else {
    carry_out(text, now_ns);
  }
}

void Viewer::take_binary(std::span<const std::uint8_t> /*bytes*/, std::int64_t now_ns) {
  take_text(std::string(), now_ns);
}

void Viewer::carry_out(const std::string& text, std::int64_t now_ns) {
  refresh(now_ns);
  const ClientMessage message = parse_client_message(text);
  Status status = message.status;
  if (const auto* command = std::get_if<WatchCommand>(&message.command);
      command != nullptr && status && !watch_known(*command, &status)) {
    opening_ = Opening{message.request, *command};
    port_.open_run(command->run_id);
    return;
  }
  if (status) status = std::visit(CommandVisitor{*this, now_ns}, message.command);
  answer(message.request, status, &port_);
  tick(now_ns);
}

bool Viewer::watch_known(const WatchCommand& command, Status* status) {
  const auto known = std::find_if(watches_.begin(), watches_.end(), [&](const auto& watch) {
    return watch->run_id() == command.run_id;
  });
  if (known == watches_.end()) {
    if (watches_.size() < kMaxRuns) return false;
    *status =
        Error{ErrorCode::kConflict,
              "watch.run: " + std::to_string(kMaxRuns) + " runs are watched, which is the limit"};
    return true;
  }
  if (command.resume) return false;
  if (command.offset_ns) {
    (*known)->set_offset(*command.offset_ns);
    set_extent();
    playback_due_ = true;
    pictures_.show_again();
  }
  return true;
}

void Viewer::run_opened(Result<std::shared_ptr<server::RunTimeline>> timeline,
                        std::int64_t now_ns) {
  if (!opening_) return;
  const Opening opening = *std::exchange(opening_, std::nullopt);
  const Status status =
      timeline ? RowFeed::check_resume(**timeline, opening.command.resume.value_or(Resume()))
               : Status(timeline.error());
  if (status) watch(opening.command, std::move(*timeline));
  answer(opening.request, status, &port_);
  tick(now_ns);
  while (!opening_ && !waiting_.empty()) {
    const std::string text = std::move(waiting_.front());
    waiting_.pop_front();
    carry_out(text, now_ns);
  }
}

void Viewer::watch(const WatchCommand& command,
                   std::shared_ptr<const server::RunTimeline> timeline) {
  const bool first = watches_.empty();
  const Result<RunWatch*> known = watched(command.run_id);
  const bool again = !first && known;
  auto watch =
      std::make_unique<RunWatch>(command.run_id,
                                 std::move(timeline),
                                 command.offset_ns.value_or(again ? (*known)->begin_ns() : 0),
                                 command.resume.value_or(Resume()));
  if (again) {
    (void)watch->align((*known)->alignment());
    for (auto& entry : watches_) {
      if (entry.get() == *known) entry = std::move(watch);
    }
  } else {
    watches_.push_back(std::move(watch));
  }
  if (first) {
    clock_ = PlaybackClock();
    set_extent();
    clock_ = PlaybackClock(clock_.extent());
  } else {
    set_extent();
  }
  pictures_.restart(command.run_id);
  pictures_due_ = true;
  playback_due_ = true;
}

Status Viewer::unwatch(const UnwatchCommand& command) {
  const Result<RunWatch*> watch = watched(command.run_id);
  if (!watch) return watch.error();
  std::erase_if(watches_, [&](const auto& entry) { return entry.get() == *watch; });
  pictures_.restart(command.run_id);
  set_extent();
  playback_due_ = !watches_.empty();
  return {};
}

Result<RunWatch*> Viewer::watched(const std::string& run_id) {
  for (const auto& watch : watches_) {
    if (run_id.empty() || watch->run_id() == run_id) return watch.get();
  }
  if (run_id.empty()) return Error{ErrorCode::kConflict, "no run is watched"};
  return Error{ErrorCode::kConflict, "run " + run_id + " is not watched"};
}

Status Viewer::align(const AlignCommand& command) {
  const Result<RunWatch*> watch = watched(command.run_id);
  if (!watch) return watch.error();
  if (Status status = (*watch)->align(command.mode); !status) return status;
  playback_due_ = true;
  pictures_.show_again();
  return {};
}

Status Viewer::seek(const SeekCommand& command) {
  const Result<RunWatch*> watch = watched(command.run_id);
  if (!watch) return watch.error();
  std::int64_t t_ns = command.t_ns.value_or(0);
  if (command.frame) {
    t_ns = (*watch)->begin_ns() + time_of_frame((*watch)->timeline(), *command.frame).value_or(0);
  }
  clock_.seek(t_ns);
  playback_due_ = true;
  pictures_.show_after_jump();
  return {};
}

Status Viewer::step(const StepCommand& command) {
  const Result<RunWatch*> watch = watched(command.run_id);
  if (!watch) return watch.error();
  clock_.pause();
  const std::int64_t t_ns = clock_.t_ns() - (*watch)->begin_ns();
  const auto stepped = time_of_step((*watch)->timeline(), t_ns, command.frames);
  clock_.seek((*watch)->begin_ns() + stepped.value_or(0));
  playback_due_ = true;
  pictures_.show_again();
  return {};
}

void Viewer::set_extent() {
  if (watches_.empty()) {
    clock_ = PlaybackClock();
    return;
  }
  PlaybackClock::Extent extent{watches_.front()->begin_ns(), watches_.front()->end_ns()};
  std::optional<std::int64_t> flying_ns;
  std::optional<std::int64_t> flown_ns;
  for (const auto& watch : watches_) {
    extent.begin_ns = std::min(extent.begin_ns, watch->begin_ns());
    extent.end_ns = std::max(extent.end_ns, watch->end_ns());
    if (watch->flying()) flying_ns = std::max(flying_ns.value_or(watch->end_ns()), watch->end_ns());
    if (watch->has_flown())
      flown_ns = std::max(flown_ns.value_or(watch->end_ns()), watch->end_ns());
  }
  extent.flying = flying_ns.has_value();
  extent.newest_ns = flying_ns.value_or(flown_ns.value_or(extent.end_ns));
  clock_.set_extent(extent);
}

void Viewer::refresh(std::int64_t now_ns) {
  bool grown = false;
  for (const auto& watch : watches_) grown = watch->refresh() || grown;
  if (grown) set_extent();
  clock_.advance(now_ns);
}

void Viewer::tick(std::int64_t now_ns) {
  refresh(now_ns);
  if (pictures_.set_limit_hz(port_.picture_limit_hz())) pictures_due_ = true;
  if (pictures_.reduction_changed()) pictures_due_ = true;
  if (pictures_due_) {
    pictures_due_ = false;
    port_.send_text(to_text(pictures_.pictures_json()));
  }
  for (const auto& watch : watches_) watch->send_due(&port_, now_ns);
  send_playback(now_ns);
  pump_pictures(now_ns);
}

void Viewer::send_playback(std::int64_t now_ns) {
  if (watches_.empty()) return;
  const auto is_due = [&](std::int64_t period_ns) {
    return !playback_at_ns_ || now_ns - *playback_at_ns_ >= period_ns;
  };
  const SentClock now{clock_.t_ns(),
                      clock_.playing(),
                      clock_.live(),
                      clock_.loop(),
                      clock_.speed(),
                      clock_.range()};
  const bool moved = now != clock_sent_ && is_due(kPlaybackPeriodNs);
  const bool grew = clock_.extent() != extent_sent_ && is_due(kExtentPeriodNs);
  if (!playback_due_ && !moved && !grew) return;
  // Skipped on a slow connection, because the next message contains the position too.
  if (!playback_due_ && port_.unsent_bytes() > kHighWaterBytes) return;
  playback_due_ = false;
  clock_sent_ = now;
  extent_sent_ = clock_.extent();
  playback_at_ns_ = now_ns;
  nlohmann::json message = clock_json(clock_);
  nlohmann::json runs = nlohmann::json::object();
  for (const auto& watch : watches_) runs[watch->run_id()] = watch->instant(clock_.t_ns());
  message["runs"] = std::move(runs);
  port_.send_text(to_text(message));
}

void Viewer::pump_pictures(std::int64_t now_ns) {
  std::vector<PictureStreams::Instant> instants;
  for (const auto& watch : watches_) {
    const std::int64_t at_ns = watch->run_t_ns(clock_.t_ns());
    const auto row = watch->timeline().frame_at(at_ns);
    if (!row) continue;
    const bool live = clock_.live() && watch->flying();
    const bool at_end = row->t_ns >= end_of(watch->timeline());
    instants.push_back({&watch->timeline(),
                        watch->run_id(),
                        row->frame,
                        row->t_ns,
                        at_ns,
                        at_end,
                        live,
                        watch->alignment()});
  }
  pictures_.pump(instants, clock_.playing(), &port_, now_ns);
}

void Viewer::picture_ready(const PictureTicket& ticket,
                           const Result<server::Picture>& picture,
                           std::int64_t now_ns) {
  pictures_.ready(ticket, picture, &port_, now_ns);
  tick(now_ns);
}

void Viewer::picture_sent(const PictureTicket& ticket, std::int64_t now_ns) {
  pictures_.sent(ticket);
  tick(now_ns);
}

std::optional<std::int64_t> Viewer::tick_after_ns() const {
  if (watches_.empty()) return std::nullopt;
  const bool behind = std::any_of(
      watches_.begin(), watches_.end(), [](const auto& watch) { return watch->behind(); });
  if (clock_.playing() || pictures_.waiting() || behind) return kPlayingTickNs;
  return clock_.extent().flying ? kRunningTickNs : kIdleTickNs;
}

}  // namespace overfly::net
