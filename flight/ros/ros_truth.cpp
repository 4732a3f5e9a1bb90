#include "flight/ros/ros_truth.hpp"

#include <algorithm>
#include <deque>
#include <functional>
#include <limits>
#include <memory>
#include <set>
#include <utility>

#include "core/sensors/sample_source.hpp"
#include "core/text/number_text.hpp"
#include "core/text/printable_text.hpp"
#include "flight/live/live_motion.hpp"
#include "flight/live/state_wait.hpp"
#include "flight/logs/ros/ros_cursor.hpp"
#include "flight/ros/ros_samples.hpp"
#include "middleware/ros1/topic_listener.hpp"

namespace overfly::flight::ros_live {
namespace {

/// What a message of mavros_msgs/State says: header, connected, armed, guided, manual_input, mode.
struct MavrosState {
  std::int64_t stamp_ns = 0;  ///< 0: not set
  bool connected = false;
  bool armed = false;
  std::string mode;
};

std::optional<MavrosState> decode_mavros_state(std::span<const std::uint8_t> bytes) {
  logs::RosCursor message(bytes, logs::RosEncoding::kRos1, false);
  MavrosState state;
  (void)message.number<std::uint32_t>();  // seq
  const std::int64_t stamp_s = message.number<std::uint32_t>();
  state.stamp_ns = stamp_s * kNsPerS + message.number<std::uint32_t>();
  (void)message.text();  // frame_id
  state.connected = message.number<std::uint8_t>() != 0;
  state.armed = message.number<std::uint8_t>() != 0;
  (void)message.number<std::uint8_t>();  // guided
  (void)message.number<std::uint8_t>();  // manual_input
  constexpr std::size_t kMostLetters = 32;
  const auto mode = message.text().substr(0, kMostLetters);
  state.mode = printable_text({reinterpret_cast<const std::uint8_t*>(mode.data()), mode.size()});
  if (!message.ok()) return std::nullopt;
  return state;
}

/// A publisher that changes the mode all the time does not fill the memory.
constexpr std::size_t kMaxWaitingEvents = 1000;

class RosTruth final : public TruthSource, public SampleSource {
 public:
  RosTruth(const RosFlight& flight, const LocalFrame& frame)
      : flight_(flight),
        origin_(flight.origin.value_or(frame.origin())),
        samples_(std::make_unique<RosSamples>(flight, origin_)),
        motion_(frame, 0.0, flight.gap_limit_ns) {}

  Status open(const std::atomic<bool>* cancel) {
    std::set<std::string> topics = {flight_.position_topic(), flight_.attitude_topic()};
    topics.insert(flight_.sensor_topics.begin(), flight_.sensor_topics.end());
    if (!flight_.state_topic.empty()) topics.insert(flight_.state_topic);
    ros1::TopicListenerOptions options;
    options.master_uri = flight_.master_uri;
    options.node_name = flight_.node_name;
    options.topics.assign(topics.begin(), topics.end());
    options.patience = flight_.patience;
    auto listener = ros1::TopicListener::open(
        options, [this](const ros1::ListenedMessage& message) { take(message); }, cancel);
    if (!listener) return listener.error();
    listener_ = std::move(*listener);
    return wait(
        "waiting for the flight's start", [this] { return started_; }, cancel);
  }
  ~RosTruth() override { listener_.reset(); }

  [[nodiscard]] std::optional<std::int64_t> duration_ns() const override { return std::nullopt; }
  [[nodiscard]] std::string description() const override {
    return "ROS topics at " + flight_.master_uri + ": " + flight_.position_topic() +
           (flight_.position_topic() == flight_.attitude_topic() ? ""
                                                                 : ", " + flight_.attitude_topic());
  }
  [[nodiscard]] std::vector<std::string> warnings() const override {
    const std::lock_guard lock(news_.mutex);
    std::vector<std::string> warnings;
    if (restarts_ > 0) {
      warnings.push_back("stamps went back before the flight (" + counted(restarts_, "time") +
                         "): what had come was forgotten");
    }
    if (const auto gaps = motion_.gaps_text(start_ns_)) warnings.push_back(*gaps);
    if (const std::uint64_t count = listener_->too_large(); count > 0) {
      warnings.push_back(std::to_string(count) + " messages were larger than " +
                         std::to_string(ros1::TopicListener::kMostBytes) +
                         " bytes and were left out");
    }
    if (end_ns_) {
      warnings.push_back("the flight ended at " + live::seconds_shown(*end_ns_ - start_ns_) + ": " +
                         end_reason_);
    }
    return warnings;
  }
  void begin() override {
    const std::lock_guard lock(news_.mutex);
    if (end_ns_) return;
    start_ns_ = known_until_ns();
    samples_->forget_before(start_ns_);
    news_.arrivals.use_latest();
  }
  [[nodiscard]] std::vector<FlightEvent> take_events(std::int64_t t_ns) override {
    const std::lock_guard lock(news_.mutex);
    std::vector<FlightEvent> taken;
    while (!events_.empty() && events_.front().t_ns <= start_ns_ + t_ns) {
      FlightEvent event = std::move(events_.front());
      events_.pop_front();
      event.t_ns -= start_ns_;
      // Of what was before the start, only the last mode is still in force.
      const bool is_mode = event.kind == FlightEventKind::kMode;
      if (event.t_ns < 0 && !is_mode) continue;
      if (is_mode && !taken.empty() && event.t_ns <= 0) taken.clear();
      event.t_ns = std::max<std::int64_t>(event.t_ns, 0);
      taken.push_back(std::move(event));
    }
    return taken;
  }
  [[nodiscard]] SampleSource* sample_source() override { return this; }
  [[nodiscard]] SensorSamples take_samples(std::int64_t t_ns) override {
    const std::lock_guard lock(news_.mutex);
    return samples_->sensors().take_until(start_ns_ + t_ns, start_ns_);
  }
  [[nodiscard]] std::string sensor_report() const override {
    const std::lock_guard lock(news_.mutex);
    const std::string sensors = samples_->sensors().report("not published");
    return sensors.empty() ? sensors : "sensors of the vehicle: " + sensors;
  }
  [[nodiscard]] std::optional<std::int64_t> heard_ns() const override {
    const std::lock_guard lock(news_.mutex);
    return news_.arrivals.used_ns();
  }

 private:
  void take(const ros1::ListenedMessage& message) {
    {
      const std::lock_guard lock(news_.mutex);
      if (end_ns_) return;
      if (message.topic == flight_.state_topic && message.type == "mavros_msgs/State") {
        take_state(message.bytes);
      } else {
        take_sample(message);
      }
    }
    news_.arrived.notify_all();
  }

  void take_sample(const ros1::ListenedMessage& message) {
    const std::int64_t before_ns =
        started_ ? known_until_ns() : std::numeric_limits<std::int64_t>::min();
    samples_->take(message.topic, message.type, message.bytes);
    if (!started_ && !samples_->restarted().empty()) return start_over(message);
    if (!started_ && !samples_->positions().empty() && !samples_->attitudes().empty()) {
      start_ns_ = std::max(samples_->positions().front().t_ns, samples_->attitudes().front().t_ns);
      started_ = known_until_ns() >= start_ns_;
      if (started_) {
        samples_->forget_before(start_ns_);
        samples_->sensors().forget_before(start_ns_);
      }
    }
    if (!started_) return;
    if (known_until_ns() > before_ns) news_.arrivals.add(known_until_ns());
    if (!samples_->restarted().empty()) {
      end("the stamps of " + samples_->restarted() + " went back");
    } else {
      end_if_disarmed(false);
    }
  }

  /// Stamps went back before the flight: all that has come is forgotten.
  /// @param message  the first one that proves it
  void start_over(const ros1::ListenedMessage& message) {
    ++restarts_;
    samples_ = std::make_unique<RosSamples>(flight_, origin_);
    events_.clear();
    mode_.clear();
    armed_.reset();
    was_armed_ = false;
    disarmed_ns_.reset();
    news_.arrivals.restart();
    samples_->take(message.topic, message.type, message.bytes);
  }

  void take_state(std::span<const std::uint8_t> bytes) {
    const std::optional<MavrosState> state = decode_mavros_state(bytes);
    if (!state || !state->connected) return;
    note_changes(*state);
    const bool is_change = was_armed_ && !state->armed;
    was_armed_ = state->armed;
    if (state->armed) {
      disarmed_ns_.reset();
    } else if (is_change) {
      disarmed_ns_ = state->stamp_ns > 0 ? state->stamp_ns : (started_ ? known_until_ns() : 0);
    }
    // The message that says so may have overtaken poses on their own connection; it is repeated.
    if (!is_change) end_if_disarmed(true);
  }

  /// Ends the flight if the vehicle was disarmed in it, not before.
  /// @param heard_again  what is known so far is all that comes
  void end_if_disarmed(bool heard_again) {
    if (!started_ || !disarmed_ns_) return;
    if (*disarmed_ns_ < start_ns_) {
      disarmed_ns_.reset();
      return;
    }
    const bool is_reached = heard_again || known_until_ns() >= *disarmed_ns_;
    if (is_reached && flight_.stop_on_disarm) end("the vehicle was disarmed");
  }

  /// Modes, and whether the vehicle is armed, at the stamps of the messages.
  void note_changes(const MavrosState& state) {
    std::int64_t stamp_ns = state.stamp_ns;
    if (stamp_ns == 0 && started_) stamp_ns = known_until_ns();
    if (!events_.empty()) stamp_ns = std::max(stamp_ns, events_.back().t_ns);
    const auto add = [&](FlightEventKind kind, const std::string& text) {
      if (events_.size() < kMaxWaitingEvents) events_.push_back({stamp_ns, kind, text});
    };
    if (state.mode != mode_ && !state.mode.empty()) add(FlightEventKind::kMode, state.mode);
    if (armed_ && *armed_ != state.armed) {
      add(FlightEventKind::kOther, state.armed ? "armed" : "disarmed");
    }
    mode_ = state.mode;
    armed_ = state.armed;
  }

  void end(const std::string& reason) {
    end_reason_ = reason;
    end_ns_ = known_until_ns();
  }

  /// The stamp up to which position and attitude are known. @pre there are some of both
  [[nodiscard]] std::int64_t known_until_ns() const {
    return std::min(samples_->positions().back().t_ns, samples_->attitudes().back().t_ns);
  }

  /// Waits until `ready` returns true or the flight ends.
  Status wait(const std::string& what,
              const std::function<bool()>& ready,
              const std::atomic<bool>* cancel) {
    live::AwaitedSource source;
    source.name = "the ROS topics";
    source.patience = flight_.patience;
    source.ended = [this] { return end_ns_.has_value(); };
    source.full = [this] { return samples_->full(); };
    source.missing = [this] {
      return started_ ? std::string("no new state") : samples_->missing_text();
    };
    source.heard = [this] { return listener_->publishers(); };
    return live::wait_for_states(news_, source, flight_.master_uri + ": " + what, ready, cancel);
  }

  [[nodiscard]] Result<std::optional<AircraftState>> find_state(
      std::int64_t t_ns, const std::atomic<bool>* cancel) override {
    if (Status status = live::check_flight_time(t_ns); !status) return status.error();
    const std::int64_t stamp_ns = start_ns_ + t_ns;
    const Status waited = wait(
        "the state at " + live::seconds_shown(t_ns),
        [this, stamp_ns] { return known_until_ns() >= stamp_ns; },
        cancel);
    if (!waited) return waited.error();
    const std::lock_guard lock(news_.mutex);
    if (end_ns_ && stamp_ns > *end_ns_) return std::optional<AircraftState>();
    samples_->forget_before(stamp_ns);
    news_.arrivals.use(stamp_ns);
    const bool joint = flight_.position_topic() == flight_.attitude_topic();
    AircraftState state = motion_.at(samples_->positions(), samples_->attitudes(), joint, stamp_ns);
    state.t_ns = t_ns;
    return std::optional(state);
  }

  const RosFlight flight_;
  live::StateNews news_;
  Geodetic origin_;  ///< of local positions
  std::unique_ptr<RosSamples> samples_;
  std::uint64_t restarts_ = 0;  ///< of stamps before the flight
  live::LiveMotion motion_;
  bool started_ = false;
  bool was_armed_ = false;
  std::optional<std::int64_t> disarmed_ns_;  ///< a stamp; empty while armed, and before
  std::string mode_;                         ///< of the latest message about the vehicle's state
  std::optional<bool> armed_;
  std::deque<FlightEvent> events_;  ///< not taken yet; their times are stamps
  std::int64_t start_ns_ = 0;
  std::string end_reason_;
  std::optional<std::int64_t> end_ns_;  ///< a stamp
  std::unique_ptr<ros1::TopicListener> listener_;
};

}  // namespace

Result<std::unique_ptr<TruthSource>> fly_ros(const RosFlight& flight,
                                             const LocalFrame& frame,
                                             const std::atomic<bool>* cancel) {
  auto truth = std::make_unique<RosTruth>(flight, frame);
  if (Status status = truth->open(cancel); !status) return status.error();
  return std::unique_ptr<TruthSource>(std::move(truth));
}

}  // namespace overfly::flight::ros_live
