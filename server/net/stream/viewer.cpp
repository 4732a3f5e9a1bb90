#include "server/net/stream/viewer.hpp"

#include <utility>

#include "server/net/http/json_text.hpp"
#include "server/net/stream/playback_state.hpp"

namespace overfly::net {
namespace {

constexpr int kProtocol = 1;
constexpr std::int64_t kPlayingTickNs = 16'000'000;  ///< two ticks per frame of a 31 Hz camera
constexpr std::int64_t kRunningTickNs = 100'000'000;
constexpr std::int64_t kIdleTickNs = 1'000'000'000;

void answer(const std::optional<std::int64_t>& request, const Status& status, ViewerPort* port) {
  nlohmann::json message = {{"type", status ? "ok" : "error"}};
  if (request) message["request"] = *request;
  if (!status) {
    message["code"] = to_string(status.error().code);
    message["message"] = status.error().message;
  }
  if (!status || request) port->send_text(to_text(message));
}

}  // namespace

/// Executes each command; messages that result from it are sent by the tick after the answer.
struct Viewer::CommandVisitor {
  Viewer& viewer;

  /// Answered when the run is open.
  Status operator()(const AttachCommand& /*command*/) const { return {}; }
  Status operator()(const DetachCommand& /*command*/) const {
    viewer.detach();
    return {};
  }
  Status operator()(const SubscribeCommand& command) const {
    viewer.pictures_.subscribe(command.streams);
    viewer.streams_due_ = true;
    return {};
  }
  Status operator()(const ViewCommand& command) const {
    viewer.pictures_.set_view(command);
    return {};
  }
  Status operator()(const SeekCommand& command) const { return viewer.seek(command); }
  Status operator()(const StepCommand& command) const { return viewer.step(command); }
  Status operator()(const PlayCommand& /*command*/) const {
    return with_cursor([](PlaybackCursor* cursor) { cursor->play(); });
  }
  Status operator()(const PauseCommand& /*command*/) const {
    viewer.pictures_.show_again();
    return with_cursor([](PlaybackCursor* cursor) { cursor->pause(); });
  }
  Status operator()(const SpeedCommand& command) const {
    return with_cursor([&](PlaybackCursor* cursor) { cursor->set_speed(command.value); });
  }
  Status operator()(const LoopCommand& command) const {
    return with_cursor([&](PlaybackCursor* cursor) { cursor->set_loop(command.value); });
  }
  Status operator()(const AlignCommand& command) const { return viewer.align(command); }
  Status operator()(const LiveCommand& /*command*/) const {
    bool live = false;
    Status status = with_cursor([&](PlaybackCursor* cursor) { live = cursor->go_live(); });
    if (status && !live) return Error{ErrorCode::kConflict, "the run is no longer running"};
    return status;
  }

 private:
  template <typename Action>
  Status with_cursor(Action action) const {
    if (!viewer.watch_) return Error{ErrorCode::kConflict, "no run is attached"};
    action(&viewer.watch_->cursor());
    viewer.watch_->cursor_commanded();
    return {};
  }
};

void Viewer::greet(const std::string& connection_name) {
  port_.send_text(to_text({{"type", "hello"},
                           {"protocol", kProtocol},
                           {"server", std::string("overfly ") + OVERFLY_VERSION},
                           {"connection", connection_name}}));
}

void Viewer::handle(const std::string& text, std::int64_t now_ns) {
  if (opening_) {
    waiting_.push_back(text);
  } else {
    carry_out(text, now_ns);
  }
}

void Viewer::carry_out(const std::string& text, std::int64_t now_ns) {
  if (watch_) watch_->refresh(now_ns);
  const ClientMessage message = parse_client_message(text);
  if (const auto* command = std::get_if<AttachCommand>(&message.command);
      command != nullptr && message.status) {
    opening_ = Opening{message.request, *command};
    port_.open_run(command->run_id);
    return;
  }
  const Status status =
      message.status ? std::visit(CommandVisitor{*this}, message.command) : message.status;
  answer(message.request, status, &port_);
  tick(now_ns);
}

void Viewer::run_opened(Result<std::shared_ptr<server::RunTimeline>> timeline,
                        std::int64_t now_ns) {
  if (!opening_) return;
  const Opening opening = *std::exchange(opening_, std::nullopt);
  if (timeline) attach(opening.command, std::move(*timeline));
  answer(opening.request, timeline ? Status() : Status(timeline.error()), &port_);
  tick(now_ns);
  while (!opening_ && !waiting_.empty()) {
    const std::string text = std::move(waiting_.front());
    waiting_.pop_front();
    carry_out(text, now_ns);
  }
}

void Viewer::attach(const AttachCommand& command,
                    std::shared_ptr<const server::RunTimeline> timeline) {
  pictures_.restart();
  pictures_.set_alignment(server::kRecordedAlignment);
  run_id_ = command.run_id;
  watch_.emplace(std::move(timeline), command.resume);
  streams_due_ = true;
}

Status Viewer::align(const AlignCommand& command) {
  if (!watch_) return Error{ErrorCode::kConflict, "no run is attached"};
  if (Status status = watch_->align(command.mode); !status) return status;
  pictures_.set_alignment(command.mode);
  return {};
}

void Viewer::detach() {
  watch_.reset();
  run_id_.clear();
  pictures_.restart();
}

Status Viewer::seek(const SeekCommand& command) {
  if (!watch_) return Error{ErrorCode::kConflict, "no run is attached"};
  std::int64_t t_ns = command.t_ns.value_or(0);
  if (command.frame) t_ns = time_of_frame(watch_->timeline(), *command.frame).value_or(0);
  watch_->cursor().seek(t_ns);
  watch_->cursor_commanded();
  pictures_.show_again();
  return {};
}

Status Viewer::step(const StepCommand& command) {
  if (!watch_) return Error{ErrorCode::kConflict, "no run is attached"};
  PlaybackCursor& cursor = watch_->cursor();
  cursor.pause();
  const auto t_ns = time_of_step(watch_->timeline(), cursor.t_ns(), command.frames);
  cursor.seek(t_ns.value_or(0));
  watch_->cursor_commanded();
  pictures_.show_again();
  return {};
}

void Viewer::tick(std::int64_t now_ns) {
  if (watch_) watch_->refresh(now_ns);
  if (pictures_.set_limit_hz(port_.picture_limit_hz())) streams_due_ = true;
  if (streams_due_) {
    streams_due_ = false;
    port_.send_text(to_text(pictures_.streams_json()));
  }
  if (watch_) watch_->send_due(&port_, now_ns);
  pump_pictures(now_ns);
}

void Viewer::pump_pictures(std::int64_t now_ns) {
  if (!watch_) return;
  const auto row = watch_->timeline().frame_at(watch_->cursor().t_ns());
  if (!row) return;
  pictures_.pump({watch_->timeline(), run_id_, row->frame, row->t_ns, watch_->cursor().live()},
                 &port_,
                 now_ns);
}

void Viewer::picture_ready(const PictureTicket& ticket,
                           const Result<server::Picture>& picture,
                           std::int64_t now_ns) {
  pictures_.ready(ticket, picture, &port_);
  tick(now_ns);
}

void Viewer::picture_sent(const PictureTicket& ticket, std::int64_t now_ns) {
  pictures_.sent(ticket);
  tick(now_ns);
}

std::optional<std::int64_t> Viewer::tick_after_ns() const {
  if (!watch_) return std::nullopt;
  if (watch_->cursor().playing() || pictures_.waiting() || watch_->behind()) return kPlayingTickNs;
  return watch_->cursor().running() ? kRunningTickNs : kIdleTickNs;
}

}  // namespace overfly::net
