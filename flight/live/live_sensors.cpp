#include "flight/live/live_sensors.hpp"

#include <algorithm>
#include <cstdio>
#include <optional>

#include "core/time.hpp"
#include "flight/mavlink/message_table.hpp"
#include "flight/mavlink/messages.hpp"

namespace overfly::flight::live {
namespace {

std::vector<ImuSample>& list_of(SensorSamples& all, const ImuSample*) { return all.imu; }
std::vector<BarometerSample>& list_of(SensorSamples& all, const BarometerSample*) {
  return all.barometer;
}
std::vector<GpsSample>& list_of(SensorSamples& all, const GpsSample*) { return all.gps; }
std::vector<AirspeedSample>& list_of(SensorSamples& all, const AirspeedSample*) {
  return all.airspeed;
}
std::vector<MagnetometerSample>& list_of(SensorSamples& all, const MagnetometerSample*) {
  return all.magnetometer;
}
std::vector<RangeSample>& list_of(SensorSamples& all, const RangeSample*) { return all.range; }

/// The samples of a track's sensor.
template <typename Sample>
std::vector<Sample>& list_of(SensorSamples& all, const SensorTrack<Sample>& /*track*/) {
  return list_of(all, static_cast<const Sample*>(nullptr));
}

/// A receiver's answer is sent more often than it is measured.
template <typename Sample>
bool is_repeated(const SensorTrack<Sample>& /*track*/, const Sample& /*sample*/) {
  return false;
}
bool is_repeated(const SensorTrack<GpsSample>& track, const GpsSample& sample) {
  return sample.fix != GpsFixType::kNone && sample.t_ns <= track.last_measured_ns;
}

/// @return whether a sample was left out
template <typename Sample>
bool insert_in_order(SensorTrack<Sample>& track, const Sample& sample) {
  if (available_ns(sample) <= track.last_taken_ns) return true;
  if (is_repeated(track, sample)) return false;
  std::deque<Sample>& waiting = track.waiting;
  const auto at = std::lower_bound(
      waiting.begin(),
      waiting.end(),
      available_ns(sample),
      [](const Sample& each, std::int64_t t_ns) { return available_ns(each) < t_ns; });
  if (at != waiting.end() && available_ns(*at) == available_ns(sample)) return false;
  waiting.insert(at, sample);
  track.last_measured_ns = std::max(track.last_measured_ns, sample.t_ns);
  if (waiting.size() <= LiveSensors::kMaxWaiting) return false;
  waiting.pop_front();
  return true;
}

template <typename Sample>
void move_times(Sample& sample, std::int64_t by_ns) {
  sample.t_ns += by_ns;
  if constexpr (requires { sample.delivered_ns; }) sample.delivered_ns += by_ns;
}

}  // namespace

void LiveSensors::take(const mavlink::Frame& frame, std::int64_t latest_ns) {
  if (static_cast<mavlink::MessageId>(frame.message_id) == mavlink::MessageId::kHeartbeat) {
    autopilot_ = mavlink::decode_heartbeat(frame).autopilot;
    return;
  }
  std::optional<mavlink::MessageSamples> measured =
      mavlink::sensor_samples_of(frame, {latest_ns, autopilot_, geoid_separation_m_});
  if (!measured) return;
  const auto add = [&](auto& track) {
    for (const auto& sample : list_of(measured->samples, track)) {
      if (measured->preference < track.preference && !track.taken) {
        track.preference = measured->preference;
        const mavlink::MessageFacts* const facts = mavlink::message_facts(frame.message_id);
        track.message = facts != nullptr ? facts->name : std::to_string(frame.message_id);
        track.waiting.clear();
        track.last_measured_ns = std::numeric_limits<std::int64_t>::min();
      }
      if (measured->preference == track.preference && insert_in_order(track, sample)) ++left_out_;
    }
  };
  std::apply([&](auto&... track) { (add(track), ...); }, tracks_);
}

void LiveSensors::forget_before(std::int64_t t_ns) {
  const auto forget = [t_ns](auto& track) {
    while (!track.waiting.empty() && track.waiting.front().t_ns < t_ns) track.waiting.pop_front();
  };
  std::apply([&](auto&... track) { (forget(track), ...); }, tracks_);
}

SensorSamples LiveSensors::take_until(std::int64_t t_ns, std::int64_t start_ns) {
  SensorSamples samples;
  const auto take_from = [&](auto& track) {
    auto& list = list_of(samples, track);
    while (!track.waiting.empty() && available_ns(track.waiting.front()) <= t_ns) {
      auto sample = track.waiting.front();
      track.waiting.pop_front();
      if (sample.t_ns < start_ns) continue;
      if (!track.taken) track.first_taken_ns = available_ns(sample);
      track.taken = true;
      track.last_taken_ns = available_ns(sample);
      ++track.count;
      move_times(sample, -start_ns);
      list.push_back(sample);
    }
  };
  std::apply([&](auto&... track) { (take_from(track), ...); }, tracks_);
  return samples;
}

std::string LiveSensors::report() const {
  std::string sent;
  std::string not_sent;
  const auto describe = [&](const char* sensor, const auto& track) {
    if (!track.taken) {
      not_sent += (not_sent.empty() ? "" : ", ") + std::string(sensor);
      return;
    }
    const double duration_s = s_from_ns(track.last_taken_ns - track.first_taken_ns);
    const double rate_hz =
        duration_s > 0.0 ? static_cast<double>(track.count - 1) / duration_s : 0.0;
    char rate[32];
    std::snprintf(rate, sizeof rate, " (%.1f Hz)", rate_hz);
    sent += (sent.empty() ? "" : ", ") + std::string(sensor) + " from " + track.message + rate;
  };
  describe("imu", std::get<0>(tracks_));
  describe("barometer", std::get<1>(tracks_));
  describe("gps", std::get<2>(tracks_));
  describe("airspeed", std::get<3>(tracks_));
  describe("magnetometer", std::get<4>(tracks_));
  describe("range", std::get<5>(tracks_));
  if (sent.empty()) return {};
  std::string text = "sensors of the vehicle: " + sent;
  if (!not_sent.empty()) text += "; not sent: " + not_sent;
  if (left_out_ > 0) text += "; " + std::to_string(left_out_) + " samples came too late";
  return text;
}

}  // namespace overfly::flight::live
