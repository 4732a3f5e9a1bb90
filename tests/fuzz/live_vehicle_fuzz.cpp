// A hostile vehicle: its messages change the state that viewers see, the samples of a flight and
// the course of every operation.
#include <deque>

#include "flight/live/live_samples.hpp"
#include "flight/live/stop_watch.hpp"
#include "flight/live/truth_streams.hpp"
#include "flight/mavlink/frame_finder.hpp"
#include "flight/mavlink/link/signing.hpp"
#include "flight/mavlink/vehicle/commands.hpp"
#include "flight/mavlink/vehicle/message_rates.hpp"
#include "flight/mavlink/vehicle/mission.hpp"
#include "flight/mavlink/vehicle/parameters.hpp"
#include "flight/mavlink/vehicle/time_sync.hpp"
#include "flight/mavlink/vehicle/vehicle_state.hpp"

namespace {

using namespace overfly;
using namespace overfly::flight;
using namespace overfly::flight::mavlink;

/// Answers whatever is asked with the same messages, then with silence. Nothing has come before it
/// is waited for.
class HostileVehicle final : public Exchange {
 public:
  explicit HostileVehicle(std::deque<HeldMessage> messages) : messages_(std::move(messages)) {}
  [[nodiscard]] Target target() const override {
    return {1, 1, static_cast<std::uint8_t>(messages_.size() % 2 == 0 ? 3 : 12)};
  }
  [[nodiscard]] Status send(MessageId /*id*/, const PayloadWriter& /*payload*/) override {
    return {};
  }
  [[nodiscard]] Result<std::optional<HeldMessage>> next(TimePoint deadline) override {
    if (messages_.empty() || deadline <= now_) {
      now_ = std::max(now_, deadline);
      return std::optional<HeldMessage>();
    }
    std::optional<HeldMessage> message = std::move(messages_.front());
    messages_.pop_front();
    return message;
  }
  [[nodiscard]] TimePoint now() const override { return now_; }

 private:
  std::deque<HeldMessage> messages_;
  TimePoint now_;
};

void operate(unsigned operation, std::deque<HeldMessage> messages) {
  HostileVehicle vehicle(std::move(messages));
  switch (operation % 6) {
    case 0:
      (void)read_all_parameters(vehicle);
      return;
    case 1:
      (void)set_parameter(vehicle, "SIM_SPEEDUP", 5.0);
      return;
    case 2:
      (void)upload_mission(vehicle, std::vector<MissionItem>(3));
      return;
    case 3:
      (void)download_mission(vehicle);
      return;
    case 4:
      (void)arm(vehicle, std::chrono::seconds(5));
      return;
    default:
      (void)request_message_rate(vehicle, MessageId::kAttitude, 50.0);
      return;
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  std::span<const std::uint8_t> rest(data + 1, size - 1);
  FrameFinder finder;
  VehicleState state;
  TimeSync sync;
  live::LiveSamples samples(0.0);
  live::StopWatch stop({true, true, 3});
  SignatureCheck signatures(SigningKey{}, 0);
  std::deque<HeldMessage> messages;
  while (true) {
    const FrameFinder::Found found = finder.next(rest, true);
    if (!found.frame) break;
    rest = rest.subspan(found.consumed_bytes);
    const Frame& frame = *found.frame;
    (void)signatures.accepts(frame, found.bytes);
    take_message(frame, state);
    samples.take(frame);
    (void)stop.take(frame);
    const PayloadReader payload(frame.payload);
    sync.take(0, payload.at<std::int64_t>(0), payload.at<std::int64_t>(8));
    messages.push_back(
        {frame.message_id, frame.component, {frame.payload.begin(), frame.payload.end()}});
  }
  (void)sync.vehicle_ns_at(0);
  for (const auto preference : {live::TruthPreference::kBest,
                                live::TruthPreference::kSimulation,
                                live::TruthPreference::kEstimate}) {
    (void)live::missing_text(samples, preference);
    if (const auto streams = live::choose_streams(samples, preference)) {
      samples.keep_only(streams->position, streams->attitude);
      samples.forget_before(samples.latest_ns().value_or(0));
    }
  }
  operate(data[0], std::move(messages));
  return 0;
}
