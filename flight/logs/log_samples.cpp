#include "flight/logs/log_samples.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "core/cancel.hpp"
#include "core/text/number_text.hpp"
#include "core/time.hpp"

namespace overfly::flight::logs {
namespace {

/// Attitudes this much before and after the positions are needed to interpolate.
constexpr std::int64_t kAttitudeMarginNs = kNsPerS;

struct LoggedPosition {
  LogTime time;
  std::uint32_t origin = 0;  ///< of a local position: 1 + index of its origin; 0: none yet
  Eigen::Vector3d value;
};

/// Keeps the samples of two streams.
class SampleSink final : public LogSink {
 public:
  SampleSink(const OpenedLog& log,
             const TruthChoice& truth,
             const TrajectoryRequest& request,
             const std::atomic<bool>* cancel)
      : log_(log), truth_(truth), request_(request), cancel_(cancel) {}

  [[nodiscard]] bool stream(StreamId id, const StreamDescription& /*description*/) override {
    return id == truth_.position || id == truth_.attitude;
  }
  void message(StreamId /*id*/, const std::optional<LogTime>& /*time*/) override {}
  void local_origin(StreamId id, const LocalOrigin& origin) override {
    if (id != truth_.position || (!origins_.empty() && origins_.back() == origin)) return;
    origins_.push_back(origin);
  }
  void event(LogEvent /*event*/) override {}
  void warning(const std::string& /*text*/) override {}
  [[nodiscard]] bool progress(std::uint64_t /*bytes*/) override { return !is_cancelled(cancel_); }

  std::vector<LoggedPosition> positions;
  std::map<std::uint32_t, std::vector<LogAttitude>> attitudes;  ///< by boot
  [[nodiscard]] const std::vector<LocalOrigin>& origins() const { return origins_; }

 private:
  [[nodiscard]] bool is_asked_for(std::int64_t t_ns, std::int64_t margin_ns) const {
    return (!request_.from_ns || t_ns >= *request_.from_ns - margin_ns) &&
           (!request_.to_ns || t_ns <= *request_.to_ns + margin_ns);
  }
  void take_position(StreamId id, const LogTime& time, const Eigen::Vector3d& value) override {
    if (id != truth_.position || !is_asked_for(time.t_ns, 0)) return;
    positions.push_back({time, static_cast<std::uint32_t>(origins_.size()), value});
  }
  void take_attitude(StreamId id,
                     const LogTime& time,
                     const Eigen::Quaterniond& R_ned_body) override {
    const std::int64_t t_ns = time.t_ns + request_.attitude_offset_ns;
    if (id != truth_.attitude || !is_asked_for(t_ns, kAttitudeMarginNs)) return;
    attitudes[time.boot].push_back({t_ns, R_ned_body.cast<float>()});
  }
  void take_invalid(StreamId /*id*/) override {}
  [[nodiscard]] PositionKind position_kind(StreamId id) const override {
    // The pass that opened the log met more streams only if the file has grown since.
    return id < log_.streams.size() ? log_.streams[id].description.position : PositionKind::kNone;
  }

  const OpenedLog& log_;
  const TruthChoice& truth_;
  const TrajectoryRequest& request_;
  const std::atomic<bool>* cancel_;
  std::vector<LocalOrigin> origins_;
};

/// The boot with the most positions; the others are reported.
std::uint32_t main_boot(const std::vector<LoggedPosition>& positions,
                        std::vector<std::string>& warnings) {
  std::map<std::uint32_t, std::size_t> counts;
  for (const LoggedPosition& position : positions) ++counts[position.time.boot];
  const auto most =
      std::max_element(counts.begin(), counts.end(), [](const auto& a, const auto& b) {
        return a.second < b.second;
      });
  if (counts.size() > 1) {
    warnings.push_back(std::to_string(positions.size() - most->second) + " positions of " +
                       std::to_string(counts.size() - 1) +
                       " other runs of the clock were left out: it starts again within the log");
  }
  return most->first;
}

/// Sorts by time, keeping the order of equal ones, and removes all but the first of equal ones.
std::size_t sort_attitudes(std::vector<LogAttitude>& attitudes) {
  std::stable_sort(attitudes.begin(), attitudes.end(), [](const auto& a, const auto& b) {
    return a.t_ns < b.t_ns;
  });
  const std::size_t count = attitudes.size();
  attitudes.erase(std::unique(attitudes.begin(),
                              attitudes.end(),
                              [](const auto& a, const auto& b) { return a.t_ns == b.t_ns; }),
                  attitudes.end());
  return count - attitudes.size();
}

/// Positions of a boot with increasing times, as latitude and longitude where the origin is known.
void take_positions(const SampleSink& sink, std::uint32_t boot, LogSamples& samples) {
  std::size_t out_of_order = 0;
  for (const LoggedPosition& position : sink.positions) {
    if (position.time.boot != boot) continue;
    const std::int64_t t_ns = position.time.t_ns;
    if (!samples.positions.empty() && t_ns <= samples.positions.back().t_ns) {
      ++out_of_order;
      continue;
    }
    Eigen::Vector3d value = position.value;
    if (!sink.origins().empty()) {
      // Positions before the first origin count from it as well.
      value = geodetic_from_local(sink.origins()[std::max(position.origin, 1U) - 1], value);
    }
    samples.positions.push_back({t_ns, value});
  }
  if (out_of_order > 0) {
    samples.warnings.push_back(std::to_string(out_of_order) +
                               " positions were left out: not later than the one before");
  }
  if (sink.origins().size() > 1) {
    samples.warnings.push_back("the origin of the local positions changes " +
                               std::to_string(sink.origins().size() - 1) + " times");
  }
}

}  // namespace

Result<LogSamples> read_log_samples(const OpenedLog& log,
                                    const TrajectoryRequest& request,
                                    const std::atomic<bool>* cancel) {
  const Result<TruthChoice> truth = choose_truth(log, request.source);
  if (!truth) return truth.error();
  const StreamInfo& source = log.streams[truth->position];
  const auto failed = [&](const std::string& what) {
    return Error{ErrorCode::kUnreadable,
                 log.file.string() + ": " + source.description.name + ": " + what};
  };
  if (!truth->attitude) return failed("no attitudes of the same vehicle are in the log");
  SampleSink sink(log, *truth, request, cancel);
  sink.positions.reserve(source.positions);
  if (Status status = read_log_into(log, sink); !status) return status.error();
  if (sink.positions.empty()) return failed("no valid positions in the time asked for");

  LogSamples samples;
  samples.position_source = source.description.name;
  samples.attitude_source = log.streams[*truth->attitude].description.name;
  samples.height = source.description.height;
  samples.georeferenced =
      source.description.position == PositionKind::kGeodetic || !sink.origins().empty();
  const std::uint32_t boot = main_boot(sink.positions, samples.warnings);
  samples.attitudes = std::move(sink.attitudes[boot]);
  if (const std::size_t doubled = sort_attitudes(samples.attitudes); doubled > 0) {
    samples.warnings.push_back(std::to_string(doubled) +
                               " attitudes were left out: a time that another one has");
  }
  take_positions(sink, boot, samples);
  return samples;
}

Result<double> separation_of(HeightDatum height,
                             const std::string& source,
                             double geoid_separation_m) {
  if (height == HeightDatum::kMeanSeaLevel) return geoid_separation_m;
  if (geoid_separation_m == 0.0) return 0.0;
  return Error{ErrorCode::kInvalidArgument,
               "geoid_separation_m = " + number_text(geoid_separation_m) + ": the heights of " +
                   source + " are above the ellipsoid already"};
}

}  // namespace overfly::flight::logs
