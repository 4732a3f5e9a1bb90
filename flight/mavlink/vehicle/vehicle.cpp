#include "flight/mavlink/vehicle/vehicle.hpp"

#include <algorithm>
#include <condition_variable>
#include <cstdio>
#include <deque>
#include <mutex>
#include <set>
#include <thread>
#include <utility>
#include <vector>

#include "core/barrier.hpp"
#include "core/cancellable_wait.hpp"
#include "flight/mavlink/vehicle/time_sync.hpp"

namespace overfly::flight::mavlink {
namespace {

using std::chrono::milliseconds;

constexpr std::size_t kMaxWaitingSends = 256;
constexpr milliseconds kHeartbeatPeriod{1000};
constexpr milliseconds kTimesyncPeriod{1000};
constexpr milliseconds kFirstTimesyncPeriod{100};
constexpr int kFirstTimesyncs = 10;
/// The longest wait for bytes: the period at which the thread looks after its other work.
constexpr milliseconds kStepPatience{50};

std::int64_t local_ns(LinkClock::time_point time) {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(time.time_since_epoch()).count();
}

}  // namespace

struct Vehicle::Impl {
  struct OutgoingMessage {
    std::uint32_t id = 0;
    std::vector<std::uint8_t> payload;
  };

  VehicleOptions options;
  std::unique_ptr<FrameLink> link;  ///< used by the thread only, but for wake()
  LinkAddress address;
  std::atomic<bool> stops{false};
  std::thread thread;

  std::mutex listener_mutex;  ///< taken before `mutex`
  std::function<void(const Frame&)> listener;

  mutable std::mutex mutex;
  std::condition_variable heard;
  VehicleState state;
  LinkCounts counts;
  std::string other_senders;
  TimeSync sync;
  std::optional<LinkClock::time_point> last_message;
  std::optional<Error> failure;
  std::deque<OutgoingMessage> outgoing;
  std::set<Conversation*> conversations;

  // Of the thread only:
  LinkClock::time_point next_heartbeat;
  LinkClock::time_point next_timesync;
  int timesyncs = 0;
  std::int64_t asked_ns = 0;  ///< in the latest TIMESYNC request

  void run();
  void take(const Frame& frame);
  void take_timesync(const Frame& frame);
  [[nodiscard]] bool is_of_vehicle(const Frame& frame);
  void send_regularly(LinkClock::time_point now);
  void send_waiting();
  void copy_counts();
  [[nodiscard]] Status queue(MessageId id, std::vector<std::uint8_t> payload);
  [[nodiscard]] std::string last_heard() const;  ///< @pre `mutex` is held
};

/// A conversation over the session.
class Vehicle::Conversation final : public Exchange {
 public:
  Conversation(Impl& impl, const std::atomic<bool>* cancel) : impl_(impl), cancel_(cancel) {
    const std::lock_guard lock(impl_.mutex);
    impl_.conversations.insert(this);
  }
  ~Conversation() override {
    const std::lock_guard lock(impl_.mutex);
    impl_.conversations.erase(this);
  }

  [[nodiscard]] Target target() const override {
    const std::lock_guard lock(impl_.mutex);
    return {impl_.state.system,
            impl_.state.component,
            impl_.state.heartbeat ? impl_.state.heartbeat->autopilot : std::uint8_t{0}};
  }
  [[nodiscard]] Status send(MessageId id, const PayloadWriter& payload) override {
    return impl_.queue(id, payload.bytes());
  }
  [[nodiscard]] TimePoint now() const override { return LinkClock::now(); }
  [[nodiscard]] Result<std::optional<HeldMessage>> next(TimePoint deadline) override {
    const auto wait = [&](std::chrono::nanoseconds timeout) {
      std::unique_lock lock(impl_.mutex);
      return impl_.heard.wait_for(
          lock, timeout, [&] { return impl_.failure.has_value() || !held_.empty(); });
    };
    (void)wait_unless_cancelled(cancel_, deadline, wait);
    if (is_cancelled(cancel_)) return cancelled("the vehicle");
    const std::lock_guard lock(impl_.mutex);
    if (impl_.failure) return *impl_.failure;
    if (held_.empty()) return std::optional<HeldMessage>();
    std::optional<HeldMessage> message = std::move(held_.front());
    held_.pop_front();
    return message;
  }

  /// @pre the session's mutex is held
  void hold(const Frame& frame) {
    if (held_.size() >= kMaxHeldMessages) held_.pop_front();
    held_.push_back(
        {frame.message_id, frame.component, {frame.payload.begin(), frame.payload.end()}});
  }

 private:
  Impl& impl_;
  const std::atomic<bool>* cancel_;
  std::deque<HeldMessage> held_;
};

bool Vehicle::Impl::is_of_vehicle(const Frame& frame) {
  if (state.system != 0) return frame.system == state.system;
  if (static_cast<MessageId>(frame.message_id) != MessageId::kHeartbeat ||
      (options.system != 0 && frame.system != options.system) || frame.system == 0 ||
      frame.system == options.link.system || !decode_heartbeat(frame).is_autopilot()) {
    return false;
  }
  state.system = frame.system;
  state.component = frame.component;
  return true;
}

void Vehicle::Impl::take_timesync(const Frame& frame) {
  const PayloadReader payload(frame.payload);
  const auto answered_ns = payload.at<std::int64_t>(0);
  const auto asked_at_ns = payload.at<std::int64_t>(8);
  const std::int64_t now_ns = local_ns(LinkClock::now());
  if (answered_ns != 0) {
    if (asked_at_ns == asked_ns && asked_ns != 0) {
      sync.take(asked_ns, answered_ns, now_ns);
      asked_ns = 0;
    }
    return;
  }
  const std::optional<std::int64_t> vehicle_ns = sync.vehicle_ns_at(now_ns);
  if (!vehicle_ns || options.link.read_only || outgoing.size() >= kMaxWaitingSends) return;
  outgoing.push_back({frame.message_id,
                      PayloadWriter(18)
                          .put(0, *vehicle_ns)
                          .put(8, asked_at_ns)
                          .put(16, frame.system)
                          .put(17, frame.component)
                          .bytes()});
}

void Vehicle::Impl::take(const Frame& frame) {
  const std::lock_guard listening(listener_mutex);
  {
    const std::lock_guard lock(mutex);
    if (!is_of_vehicle(frame)) return;
    if (frame.component == state.component) {
      last_message = LinkClock::now();
      take_message(frame, state);
      if (static_cast<MessageId>(frame.message_id) == MessageId::kTimesync) take_timesync(frame);
    }
    if (is_addressed_to(frame, options.link.system, options.link.component)) {
      for (Conversation* const conversation : conversations) conversation->hold(frame);
    }
  }
  if (listener && frame.component == state.component) listener(frame);
}

void Vehicle::Impl::send_regularly(LinkClock::time_point now) {
  if (options.link.read_only) return;
  if (now >= next_heartbeat) {
    next_heartbeat = now + kHeartbeatPeriod;
    // MAV_TYPE_GCS, no autopilot, active, MAVLink version 3.
    const PayloadWriter heartbeat = PayloadWriter(9)
                                        .put(4, std::uint8_t{6})
                                        .put(5, std::uint8_t{8})
                                        .put(7, std::uint8_t{4})
                                        .put(8, std::uint8_t{3});
    (void)link->send(static_cast<std::uint32_t>(MessageId::kHeartbeat), heartbeat.bytes(), 0);
  }
  if (now >= next_timesync && state.system != 0) {
    next_timesync = now + (timesyncs < kFirstTimesyncs ? kFirstTimesyncPeriod : kTimesyncPeriod);
    ++timesyncs;
    asked_ns = local_ns(LinkClock::now());
    const PayloadWriter request =
        PayloadWriter(18).put(8, asked_ns).put(16, state.system).put(17, state.component);
    (void)link->send(
        static_cast<std::uint32_t>(MessageId::kTimesync), request.bytes(), state.system);
  }
}

void Vehicle::Impl::send_waiting() {
  std::deque<OutgoingMessage> messages;
  std::uint8_t system = 0;
  {
    const std::lock_guard lock(mutex);
    messages.swap(outgoing);
    system = state.system;
  }
  // Every message was checked before it was queued.
  for (const OutgoingMessage& message : messages) {
    (void)link->send(message.id, message.payload, system);
  }
}

void Vehicle::Impl::copy_counts() {
  const std::lock_guard lock(mutex);
  counts = link->counts();
  other_senders.clear();
  std::size_t others = 0;
  for (const auto& [key, sender] : link->senders()) {
    const unsigned system = key >> 8U;
    const unsigned component = key & 0xFFU;
    if (system == state.system && component == state.component) {
      state.lost_messages = sender.sequence.lost();
    } else if (++others <= 8) {
      other_senders +=
          (others == 1 ? "" : ", ") + std::to_string(system) + "." + std::to_string(component);
    }
  }
}

void Vehicle::Impl::run() {
  LinkClock::time_point next_counts;
  while (!stops.load()) {
    const LinkClock::time_point now = LinkClock::now();
    send_regularly(now);
    link->step(now, kStepPatience, [&](const Frame& frame) { take(frame); });
    send_waiting();
    if (now >= next_counts) {
      next_counts = now + kStepPatience;
      copy_counts();
    }
    heard.notify_all();
  }
}

Status Vehicle::Impl::queue(MessageId id, std::vector<std::uint8_t> payload) {
  if (options.link.read_only) {
    return Error{ErrorCode::kConflict, address.text() + ": the link is read-only"};
  }
  const auto number = static_cast<std::uint32_t>(id);
  // Errors of the message are found here, not on the thread.
  const Frame frame{Version::kTwo, 0, 1, 1, number, false, payload};
  if (const auto encoded = encode_frame(frame); !encoded) return encoded.error();
  {
    const std::lock_guard lock(mutex);
    if (state.system == 0) {
      return Error{ErrorCode::kConflict, address.text() + ": no vehicle was heard yet"};
    }
    if (outgoing.size() >= kMaxWaitingSends) {
      return Error{
          ErrorCode::kConflict,
          address.text() + ": " + std::to_string(kMaxWaitingSends) + " messages wait to be sent"};
    }
    outgoing.push_back({number, std::move(payload)});
  }
  link->wake();
  return {};
}

std::string Vehicle::Impl::last_heard() const {
  std::string text;
  if (last_message) {
    const double silence_s =
        std::chrono::duration<double>(LinkClock::now() - *last_message).count();
    char shown[32];
    std::snprintf(shown, sizeof shown, "%.1f", silence_s);
    text = "the last message of vehicle " + std::to_string(state.system) + "." +
           std::to_string(state.component) + " came " + shown + " s ago";
  } else if (counts.received_frames > 0) {
    text = "messages came only from " + other_senders;
    if (options.system != 0) text += ", none from system " + std::to_string(options.system);
  } else if (counts.received_bytes > 0) {
    text = std::to_string(counts.received_bytes) + " bytes came, but no valid MAVLink message";
  } else {
    text = "nothing was heard";
  }
  if (counts.refused_signatures > 0) {
    text += "; " + std::to_string(counts.refused_signatures) +
            " messages were refused: not signed with the key";
  }
  if (!counts.last_failure.empty()) text += "; last failure: " + counts.last_failure;
  return text;
}

Vehicle::Vehicle(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}

Vehicle::~Vehicle() {
  impl_->stops = true;
  impl_->link->wake();
  if (impl_->thread.joinable()) impl_->thread.join();
}

Result<std::unique_ptr<Vehicle>> Vehicle::open(const LinkAddress& address,
                                               const VehicleOptions& options) {
  Result<std::unique_ptr<FrameLink>> link =
      FrameLink::create(address, options.link, LinkClock::now());
  if (!link) return link.error();
  auto impl = std::make_unique<Impl>();
  impl->options = options;
  impl->link = std::move(*link);
  impl->address = impl->link->address();
  std::unique_ptr<Vehicle> vehicle(new Vehicle(std::move(impl)));
  Impl* const session = vehicle->impl_.get();
  const auto body = [session] {
    contained([&] { session->run(); },
              [&](const std::string& what) {
                const std::lock_guard lock(session->mutex);
                session->failure = Error{ErrorCode::kInternal,
                                         session->address.text() + ": the session failed: " + what};
                session->heard.notify_all();
              });
  };
  const bool started =
      contained([&] { session->thread = std::thread(body); }, [](const std::string& /*what*/) {});
  if (!started) {
    return Error{ErrorCode::kInternal, session->address.text() + ": no thread could be started"};
  }
  return vehicle;
}

Status Vehicle::wait_until_heard(milliseconds patience, const std::atomic<bool>* cancel) {
  const auto wait = [&](std::chrono::nanoseconds timeout) {
    std::unique_lock lock(impl_->mutex);
    return impl_->heard.wait_for(
        lock, timeout, [&] { return impl_->failure.has_value() || impl_->state.heartbeat; });
  };
  (void)wait_unless_cancelled(cancel, LinkClock::now() + patience, wait);
  if (is_cancelled(cancel)) return cancelled("a heartbeat on " + impl_->address.text());
  const std::lock_guard lock(impl_->mutex);
  if (impl_->failure) return *impl_->failure;
  if (impl_->state.heartbeat) return {};
  return Error{
      ErrorCode::kIo,
      impl_->address.text() + ": no heartbeat of " +
          (impl_->options.system == 0 ? "an autopilot"
                                      : "system " + std::to_string(impl_->options.system)) +
          " within " + std::to_string(patience.count()) + " ms: " + impl_->last_heard()};
}

VehicleState Vehicle::state() const {
  const std::lock_guard lock(impl_->mutex);
  return impl_->state;
}

LinkCounts Vehicle::link_counts() const {
  const std::lock_guard lock(impl_->mutex);
  return impl_->counts;
}

std::optional<VehicleClock> Vehicle::clock() const {
  const std::lock_guard lock(impl_->mutex);
  const std::optional<std::int64_t> vehicle_ns =
      impl_->sync.vehicle_ns_at(local_ns(LinkClock::now()));
  if (!vehicle_ns) return std::nullopt;
  return VehicleClock{*vehicle_ns, impl_->sync.rate(), impl_->sync.round_trip_ns().value_or(0)};
}

const LinkAddress& Vehicle::address() const { return impl_->address; }

std::string Vehicle::last_heard() const {
  const std::lock_guard lock(impl_->mutex);
  return impl_->last_heard();
}

std::unique_ptr<Exchange> Vehicle::converse(const std::atomic<bool>* cancel) {
  return std::make_unique<Conversation>(*impl_, cancel);
}

Status Vehicle::send(MessageId id, const PayloadWriter& payload) {
  return impl_->queue(id, payload.bytes());
}

void Vehicle::set_listener(std::function<void(const Frame&)> listener) {
  const std::lock_guard listening(impl_->listener_mutex);
  impl_->listener = std::move(listener);
}

}  // namespace overfly::flight::mavlink
