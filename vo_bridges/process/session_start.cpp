// Starts and ends a session.
#include <algorithm>
#include <cmath>
#include <utility>

#include "core/cancellable_wait.hpp"
#include "vo_bridges/process/session.hpp"
#include "vo_bridges/process_usage.hpp"

namespace overfly::process {

namespace {

using std::chrono::milliseconds;

/// Time that an estimator gets to end by itself after STOP.
constexpr milliseconds kStopPatience(3000);
/// Time that a program gets to exit after its connection broke, so that its last output is
/// complete.
constexpr milliseconds kDeathPatience(1000);

}  // namespace

std::string duration_text(double seconds) {
  return text_of(ParameterValue(std::round(seconds * 10.0) / 10.0)) + " s";
}

Result<std::unique_ptr<Session>> Session::open(const ProcessEstimatorOptions& options) {
  std::unique_ptr<Session> session(new Session(options));
  const auto deadline = Clock::now() + std::chrono::duration_cast<Clock::duration>(
                                           std::chrono::duration<double>(options.start_timeout_s));
  if (Status status = session->output_->open_file(options.output_file); !status) {
    return status.error();
  }
  Result<Listener> listener =
      options.listen.empty() ? Listener::open_private() : Listener::open(options.listen);
  if (!listener) return listener.error();
  if (!options.command.empty()) {
    const ChildCommand command{options.command,
                               {"OVERFLY_VO_ADDRESS=" + listener->address()},
                               options.working_folder,
                               options.cpus,
                               options.memory_limit_mb};
    Result<std::unique_ptr<ChildProcess>> child = ChildProcess::start(command, session->output_);
    if (!child) return child.error();
    session->child_ = std::move(child).value();
  }
  Status status = session->connect(std::move(listener).value(), deadline);
  if (status) status = session->greet(deadline);
  if (!status) return session->end(status.error());
  return session;
}

Status Session::connect(Listener listener, Clock::time_point deadline) {
  while (Clock::now() < deadline) {
    if (is_cancelled(options_.cancel)) return cancelled("the estimator's connection");
    // Check before accept, so that a child that connected and ended is still accepted.
    const bool child_gone = child_ != nullptr && !child_->running();
    Result<std::optional<Peer>> peer = listener.accept(kCancelPeriod);
    if (!peer) return peer.error();
    if (*peer) {
      local_ = (*peer)->local;
      peer_pid_ = (*peer)->pid;
      channel_.emplace(std::move((*peer)->socket));
      return {};
    }
    if (child_gone) {
      return Error{ErrorCode::kInternal, "the estimator ended before it sent HELLO"};
    }
  }
  return Error{ErrorCode::kInternal,
               "no estimator connected to " + listener.address() + " within " +
                   duration_text(options_.start_timeout_s)};
}

Result<std::optional<Message>> Session::next(Clock::time_point deadline, milliseconds patience) {
  for (;;) {
    if (is_cancelled(options_.cancel)) {
      if (!cancelled_at_) cancelled_at_ = Clock::now();
      if (Clock::now() >= *cancelled_at_ + patience) return cancelled("the estimator");
    }
    const auto step = options_.cancel == nullptr ? deadline : Clock::now() + kCancelPeriod;
    Result<std::optional<Message>> message = channel_->next(std::min(deadline, step));
    if (!message || *message || Clock::now() >= deadline) return message;
  }
}

Status Session::greet(Clock::time_point deadline) {
  Result<std::optional<Message>> message = next(deadline);
  if (!message) return message.error();
  if (!*message) {
    return Error{ErrorCode::kInternal,
                 "the estimator connected, but did not say hello within " +
                     duration_text(options_.start_timeout_s)};
  }
  if ((*message)->type != MessageType::kHello) {
    return Error{
        ErrorCode::kInternal,
        "the estimator's first message is " + name_of((*message)->type) + ": must be HELLO"};
  }
  Result<EstimatorHello> hello = hello_from((*message)->payload);
  if (!hello) return hello.error();
  hello_ = std::move(hello).value();
  {
    const std::lock_guard lock(mutex_);
    parameters_["estimator.name"] = hello_.name;
    parameters_["estimator.version"] = hello_.version;
  }
  channel_->enqueue(server_hello(options_.lockstep, options_.parameters));
  return wait_ready(MessageType::kHello, deadline);
}

Status Session::wait_ready(MessageType done, Clock::time_point deadline) {
  for (;;) {
    Result<std::optional<Message>> message = next(deadline);
    if (!message) return message.error();
    if (!*message) {
      return Error{ErrorCode::kInternal,
                   "the estimator was not ready after " + name_of(done) + " within " +
                       duration_text(options_.start_timeout_s)};
    }
    const Result<bool> noticed = take_notice(**message);
    if (!noticed) return noticed.error();
    if (*noticed) continue;
    const MessageType type = (*message)->type;
    if (type != MessageType::kReady) {
      return Error{ErrorCode::kInternal,
                   "the estimator sent " + name_of(type) + " instead of READY for " +
                       name_of(done) + " must come"};
    }
    if (ByteReader((*message)->payload).u32() == static_cast<std::uint32_t>(done)) return {};
    return Error{
        ErrorCode::kInternal,
        "the estimator is ready for " + shown((*message)->payload) + ", not for " + name_of(done)};
  }
}

std::string Session::described() const {
  if (!hello_.name.empty()) return "estimator " + hello_.name;
  return options_.command.empty() ? options_.listen : std::string("'") + options_.command[0] + "'";
}

Error Session::end(const Error& why) {
  if (ended_) return *ended_;
  std::string text = described() + ": " + why.message;
  if (child_) {
    const bool ends_by_itself = channel_ && channel_->closed();
    const bool by_itself = child_->wait(ends_by_itself ? kDeathPatience : milliseconds(0));
    if (by_itself) output_->wait_closed(kDeathPatience);
    const std::string how = child_->how_it_ended();
    // Kill it while it is still connected, so that its last lines are not about the lost
    // connection.
    child_->stop();
    if (by_itself) text += "; it " + how;
    if (why.code != ErrorCode::kCancelled) text += output_->last_words();
  }
  channel_.reset();
  ended_ = Error{why.code, text};
  return *ended_;
}

Session::~Session() {
  if (channel_ && !ended_) {
    channel_->enqueue(message_of(MessageType::kStop));
    channel_->begin_counts();
    const auto deadline = Clock::now() + (child_ ? kStopPatience : kDeathPatience);
    // Keep reading, so that an estimator that still sends data is not blocked in its exit. The
    // connection may outlive it in a process that it started.
    for (bool open = true; open && Clock::now() < deadline;) {
      const auto message = channel_->next(std::min(deadline, Clock::now() + milliseconds(50)));
      open = message.ok() && (!child_ || child_->running());
      if (open && *message) static_cast<void>(take_notice(**message));
    }
    channel_.reset();
    if (child_) {
      child_->wait(std::max(milliseconds(0),
                            std::chrono::duration_cast<milliseconds>(deadline - Clock::now())));
    }
  }
  if (child_) child_->stop();
}

std::optional<ResourceUse> Session::resource_use() const {
  if (child_) return child_->resource_use();
  return peer_pid_ > 0 ? usage_of(peer_pid_) : std::nullopt;
}

std::map<std::string, std::string> Session::parameters() const {
  const std::lock_guard lock(mutex_);
  return parameters_;
}

}  // namespace overfly::process
