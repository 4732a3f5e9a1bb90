#include "flight/replay/logged_sensors.hpp"

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "core/cancel.hpp"
#include "core/sensors/sensor_tracks.hpp"
#include "core/time.hpp"

namespace overfly::flight {
namespace {

class LoggedSensors final : public SampleSource {
 public:
  explicit LoggedSensors(std::int64_t begin_ns) : begin_ns_(begin_ns) {}

  [[nodiscard]] SensorSamples take_samples(std::int64_t t_ns) override {
    return tracks.take_until(begin_ns_ + t_ns, begin_ns_);
  }
  [[nodiscard]] std::string sensor_report() const override {
    const std::string left_out = left_out_text();
    std::string sensors = tracks.report(left_out.empty() ? "not logged" : "not given");
    if (sensors.empty() && left_out.empty()) return {};
    if (sensors.empty()) sensors = "none is given";
    if (!left_out.empty()) {
      sensors += "; logged, but left out because the flight is moved: " + left_out;
    }
    if (without_value > 0) {
      sensors += "; " + std::to_string(without_value) + " messages had no value that can be right";
    }
    return "sensors of the log: " + sensors;
  }

  SensorTracks tracks{kMaxLoggedSamples};
  std::uint64_t without_value = 0;  ///< messages of sensors

  /// Leaves out what would give the old place and its heights.
  void take_place_out(SensorSamples& samples) {
    const auto take_out = [](auto& list, bool& left_out) {
      left_out = left_out || !list.empty();
      list.clear();
    };
    take_out(samples.barometer, left_out_.barometer);
    take_out(samples.gps, left_out_.gps);
    take_out(samples.magnetometer, left_out_.magnetometer);
    take_out(samples.range, left_out_.range);
  }

 private:
  [[nodiscard]] std::string left_out_text() const {
    std::string names;
    for (const auto& [name, left_out] : {std::pair{"barometer", left_out_.barometer},
                                         std::pair{"gps", left_out_.gps},
                                         std::pair{"magnetometer", left_out_.magnetometer},
                                         std::pair{"range", left_out_.range}}) {
      if (left_out) names += (names.empty() ? "" : ", ") + std::string(name);
    }
    return names;
  }

  /// Sensors whose samples the log has, but a moved flight has not.
  struct LeftOut {
    bool barometer = false;
    bool gps = false;
    bool magnetometer = false;
    bool range = false;
  };

  LeftOut left_out_;
  std::int64_t begin_ns_;
};

/// Takes the samples of one vehicle in one run of its clock.
class SensorSink final : public logs::LogSink {
 public:
  SensorSink(const logs::OpenedLog& log,
             const SensorRequest& request,
             LoggedSensors& sensors,
             const std::atomic<bool>* cancel)
      : request_(request), sensors_(sensors), cancel_(cancel) {
    for (const logs::StreamInfo& stream : log.streams) {
      if (stream.description.name == request.source) vehicle_ = stream.description.vehicle;
    }
  }

  [[nodiscard]] bool stream(logs::StreamId id,
                            const logs::StreamDescription& description) override {
    streams_.resize(std::max<std::size_t>(streams_.size(), id + 1));
    streams_[id] = {description.name, description.height};
    return description.sensors && description.vehicle == vehicle_;
  }
  void message(logs::StreamId /*id*/, const std::optional<logs::LogTime>& /*time*/) override {}
  void local_origin(logs::StreamId /*id*/, const logs::LocalOrigin& /*origin*/) override {}
  void event(logs::LogEvent /*event*/) override {}
  void warning(const std::string& /*text*/) override {}
  [[nodiscard]] bool progress(std::uint64_t /*bytes*/) override { return !is_cancelled(cancel_); }
  void samples(logs::StreamId id,
               const logs::LogTime& time,
               int preference,
               const SensorSamples& samples) override {
    constexpr std::int64_t kMarginNs = 2 * kNsPerS;  // messages are slightly out of order
    if (time.boot != request_.boot || time.t_ns < request_.begin_ns - kMarginNs ||
        time.t_ns > request_.end_ns + kMarginNs) {
      return;
    }
    if (samples.empty()) ++sensors_.without_value;
    SensorSamples kept = samples;
    if (request_.moved) sensors_.take_place_out(kept);
    if (streams_[id].height == logs::HeightDatum::kMeanSeaLevel) {
      for (GpsSample& gps : kept.gps) gps.place.alt_ellipsoid_m += request_.geoid_separation_m;
    }
    sensors_.tracks.add(preference, streams_[id].name, kept);
  }

 private:
  void take_position(logs::StreamId /*id*/,
                     const logs::LogTime& /*time*/,
                     const Eigen::Vector3d& /*value*/) override {}
  void take_attitude(logs::StreamId /*id*/,
                     const logs::LogTime& /*time*/,
                     const Eigen::Quaterniond& /*R_ned_body*/) override {}
  void take_invalid(logs::StreamId /*id*/) override {}
  [[nodiscard]] logs::PositionKind position_kind(logs::StreamId /*id*/) const override {
    return logs::PositionKind::kNone;
  }

  const SensorRequest& request_;
  LoggedSensors& sensors_;
  const std::atomic<bool>* cancel_;
  std::string vehicle_;
  struct Stream {
    std::string name;
    logs::HeightDatum height = logs::HeightDatum::kMeanSeaLevel;
  };
  std::vector<Stream> streams_;  ///< by StreamId
};

}  // namespace

Result<std::unique_ptr<SampleSource>> read_logged_sensors(const logs::OpenedLog& log,
                                                          const SensorRequest& request,
                                                          const std::atomic<bool>* cancel) {
  auto sensors = std::make_unique<LoggedSensors>(request.begin_ns);
  SensorSink sink(log, request, *sensors, cancel);
  if (Status status = logs::read_log_into(log, sink); !status) return status.error();
  return std::unique_ptr<SampleSource>(std::move(sensors));
}

}  // namespace overfly::flight
