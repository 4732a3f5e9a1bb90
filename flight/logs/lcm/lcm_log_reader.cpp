#include "flight/logs/lcm/lcm_log_reader.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/text/printable_text.hpp"
#include "flight/logs/boot_clock.hpp"
#include "flight/logs/held_messages.hpp"
#include "flight/logs/lcm/lcm_events.hpp"
#include "flight/logs/lcm/lcm_messages.hpp"

namespace overfly::flight::logs {
namespace {

constexpr std::size_t kMaxChannels = 4096;
/// More than a truth_t has: of other types only the time is read.
constexpr std::size_t kMostReadBytes = 256;

class LcmPass {
 public:
  explicit LcmPass(LogSink& sink) : sink_(sink) {}

  void take(const LcmEvent& event);
  void report();

 private:
  struct Channel {
    StreamId id = 0;
    bool wanted = false;
    bool sensors = false;
    LcmType type = LcmType::kOther;
    BootClock clock;
    HeldMessages<std::vector<std::uint8_t>> held;  ///< all that is read of each message
  };

  /// Null if there are too many.
  Channel* channel_of(const LcmEvent& event);
  void pass(const Channel& channel,
            const std::optional<LogTime>& time,
            std::span<const std::uint8_t> data);
  void pass_held(Channel& channel);

  LogSink& sink_;
  std::map<std::pair<std::string, LcmType>, Channel> channels_;
  std::uint64_t short_messages_ = 0;
  std::uint64_t left_out_events_ = 0;
};

LcmPass::Channel* LcmPass::channel_of(const LcmEvent& event) {
  const LcmType type = lcm_type_of(event.data);
  const std::string name = printable_text(event.channel);
  const auto known = channels_.find({name, type});
  if (known != channels_.end()) return &known->second;
  if (channels_.size() >= kMaxChannels) return nullptr;
  const auto id = static_cast<StreamId>(channels_.size());
  Channel& channel = channels_[{name, type}];
  channel.id = id;
  channel.type = type;
  const StreamDescription description = describe_channel(name, type);
  channel.sensors = description.sensors;
  channel.wanted = sink_.stream(id, description);
  return &channel;
}

void LcmPass::take(const LcmEvent& event) {
  Channel* const channel = channel_of(event);
  if (channel == nullptr) {
    ++left_out_events_;
    return;
  }
  constexpr std::int64_t kMaxUs = std::int64_t{1} << 52U;
  const bool possible = event.recorded_us >= 0 && event.recorded_us < kMaxUs;
  std::optional<std::int64_t> t_ns = possible ? event.recorded_us * 1000 : -1;
  if (channel->type != LcmType::kOther) t_ns = lcm_time_ns(event.data);
  if (!t_ns) ++short_messages_;
  const std::optional<LogTime> time = t_ns ? channel->clock.take(*t_ns) : std::optional<LogTime>();
  if (channel->held.must_hold(channel->clock)) {
    const auto data = event.data.first(std::min(event.data.size(), kMostReadBytes));
    sink_.declaration();
    channel->held.hold(time, {data.begin(), data.end()});
    return;
  }
  pass_held(*channel);
  pass(*channel, time, event.data);
}

void LcmPass::pass_held(Channel& channel) {
  channel.held.release(channel.clock,
                       [&](const auto& time, const auto& data) { pass(channel, time, data); });
}

void LcmPass::pass(const Channel& channel,
                   const std::optional<LogTime>& time,
                   std::span<const std::uint8_t> data) {
  sink_.message(channel.id, time);
  if (!channel.wanted || !time) return;
  if (channel.sensors) {
    const std::optional<SensorSamples> samples = lcm_samples_in(channel.type, data);
    if (!samples) ++short_messages_;
    if (samples) sink_.samples(channel.id, *time, static_cast<int>(channel.id), *samples);
    return;
  }
  if (channel.type == LcmType::kTruth && !pass_truth(data, channel.id, *time, sink_))
    ++short_messages_;
}

void LcmPass::report() {
  for (auto& [key, channel] : channels_) pass_held(channel);
  const auto warn = [&](std::uint64_t count, const std::string& text) {
    if (count > 0) sink_.warning(std::to_string(count) + " " + text);
  };
  warn(short_messages_, "messages are shorter than their type and were left out");
  warn(left_out_events_,
       "events were left out: only " + std::to_string(kMaxChannels) + " channels are read");
  std::uint64_t implausible = 0;
  for (const auto& [key, channel] : channels_) implausible += channel.clock.implausible();
  warn(implausible, "stamps of messages are implausible and were not used");
}

}  // namespace

Status read_lcm_log(ForwardReader& file, LogSink& sink) {
  LcmPass pass(sink);
  Status status = read_lcm_events(file, sink, [&](const LcmEvent& event) { pass.take(event); });
  if (status) pass.report();
  return status;
}

}  // namespace overfly::flight::logs
