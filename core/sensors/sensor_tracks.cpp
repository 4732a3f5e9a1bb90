#include "core/sensors/sensor_tracks.hpp"

#include <algorithm>
#include <cstdio>
#include <limits>
#include <string>
#include <type_traits>
#include <utility>

namespace overfly {
namespace {

constexpr double kSecondsPerNs = 1e-9;
/// Time after the first sample taken in which a better source still replaces the one chosen: which
/// of a vehicle's messages comes first is chance, and all usual rates are at least 1 Hz.
constexpr std::int64_t kChoosingNs = 1'000'000'000;

/// The samples of a track's sensor, of a list that may be constant.
template <typename Samples, typename Sample>
auto& list_of(Samples& all, const SensorTrack<Sample>& /*track*/) {
  if constexpr (std::is_same_v<Sample, ImuSample>) {
    return all.imu;
  } else if constexpr (std::is_same_v<Sample, BarometerSample>) {
    return all.barometer;
  } else if constexpr (std::is_same_v<Sample, GpsSample>) {
    return all.gps;
  } else if constexpr (std::is_same_v<Sample, AirspeedSample>) {
    return all.airspeed;
  } else if constexpr (std::is_same_v<Sample, MagnetometerSample>) {
    return all.magnetometer;
  } else {
    return all.range;
  }
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
bool insert_in_order(SensorTrack<Sample>& track, const Sample& sample, std::size_t max_waiting) {
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
  if (waiting.size() <= max_waiting) return false;
  waiting.pop_front();
  return true;
}

template <typename Sample>
void move_times(Sample& sample, std::int64_t by_ns) {
  sample.t_ns += by_ns;
  if constexpr (requires { sample.delivered_ns; }) sample.delivered_ns += by_ns;
}

}  // namespace

void SensorTracks::add(int preference, const std::string& source, const SensorSamples& samples) {
  const auto add_to = [&](auto& track) {
    for (const auto& sample : list_of(samples, track)) {
      const bool open = !track.taken || available_ns(sample) < track.first_taken_ns + kChoosingNs;
      if (preference < track.preference && open) {
        track.preference = preference;
        track.source = source;
        track.waiting.clear();
        track.taken = false;
        track.count = 0;
        track.last_measured_ns = std::numeric_limits<std::int64_t>::min();
      }
      if (preference == track.preference && insert_in_order(track, sample, max_waiting_)) {
        ++left_out_;
      }
    }
  };
  std::apply([&](auto&... track) { (add_to(track), ...); }, tracks_);
}

void SensorTracks::forget_before(std::int64_t t_ns) {
  const auto forget = [t_ns](auto& track) {
    while (!track.waiting.empty() && track.waiting.front().t_ns < t_ns) track.waiting.pop_front();
  };
  std::apply([&](auto&... track) { (forget(track), ...); }, tracks_);
}

SensorSamples SensorTracks::take_until(std::int64_t t_ns, std::int64_t start_ns) {
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

std::string SensorTracks::report(const std::string& missing) const {
  std::string sent;
  std::string not_sent;
  const auto describe = [&](const char* sensor, const auto& track) {
    if (!track.taken) {
      not_sent += (not_sent.empty() ? "" : ", ") + std::string(sensor);
      return;
    }
    const double duration_s =
        kSecondsPerNs * static_cast<double>(track.last_taken_ns - track.first_taken_ns);
    const double rate_hz =
        duration_s > 0.0 ? static_cast<double>(track.count - 1) / duration_s : 0.0;
    char rate[32];
    std::snprintf(rate, sizeof rate, " (%.1f Hz)", rate_hz);
    sent += (sent.empty() ? "" : ", ") + std::string(sensor) + " from " + track.source + rate;
  };
  describe("imu", std::get<0>(tracks_));
  describe("barometer", std::get<1>(tracks_));
  describe("gps", std::get<2>(tracks_));
  describe("airspeed", std::get<3>(tracks_));
  describe("magnetometer", std::get<4>(tracks_));
  describe("range", std::get<5>(tracks_));
  if (sent.empty()) return {};
  std::string text = sent;
  if (!not_sent.empty()) text += "; " + missing + ": " + not_sent;
  if (left_out_ > 0) text += "; " + std::to_string(left_out_) + " samples came too late";
  return text;
}

}  // namespace overfly
