#include "flight/logs/log_samples.hpp"

#include <algorithm>
#include <map>
#include <utility>

namespace overfly::flight::logs {
namespace {

struct LoggedPosition {
  LogTime time;
  std::uint32_t origin = 0;  ///< of a local position: 1 + index of its origin; 0: none yet
  Eigen::Vector3d value;
};

/// Keeps all samples.
class SampleKeeper final : public TruthSampleSink {
 public:
  void expect(std::size_t count) override { positions.reserve(count); }
  void local_origin(const LocalOrigin& origin) override {
    if (origins.empty() || !(origins.back() == origin)) origins.push_back(origin);
  }
  void position(const LogTime& time, const Eigen::Vector3d& value) override {
    positions.push_back({time, static_cast<std::uint32_t>(origins.size()), value});
  }
  void attitude(const LogTime& time, const Eigen::Quaterniond& R_ned_body) override {
    attitudes[time.boot].push_back({time.t_ns, R_ned_body.cast<float>()});
  }

  std::vector<LoggedPosition> positions;
  std::map<std::uint32_t, std::vector<LogAttitude>> attitudes;  ///< by boot
  std::vector<LocalOrigin> origins;
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

/// Positions of the chosen boot with increasing times, as latitude and longitude where the origin
/// is known.
void take_positions(const SampleKeeper& kept, LogSamples& samples) {
  std::size_t out_of_order = 0;
  for (const LoggedPosition& position : kept.positions) {
    if (position.time.boot != samples.boot) continue;
    const std::int64_t t_ns = position.time.t_ns;
    if (!samples.positions.empty() && t_ns <= samples.positions.back().t_ns) {
      ++out_of_order;
      continue;
    }
    Eigen::Vector3d value = position.value;
    if (!kept.origins.empty()) {
      // Positions before the first origin count from it as well.
      value = geodetic_from_local(kept.origins[std::max(position.origin, 1U) - 1], value);
    }
    samples.positions.push_back({t_ns, value});
  }
  if (out_of_order > 0) {
    samples.warnings.push_back(std::to_string(out_of_order) +
                               " positions were left out: not later than the one before");
  }
  if (kept.origins.size() > 1) {
    samples.warnings.push_back("the origin of the local positions changes " +
                               std::to_string(kept.origins.size() - 1) + " times");
  }
}

}  // namespace

Result<LogSamples> read_log_samples(const OpenedLog& log,
                                    const TrajectoryRequest& request,
                                    const std::atomic<bool>* cancel) {
  SampleKeeper kept;
  Result<LoggedTruth> truth = read_truth_samples(log, request, kept, cancel);
  if (!truth) return truth.error();
  LogSamples samples{std::move(*truth), {}, {}};
  samples.boot = main_boot(kept.positions, samples.warnings);
  samples.attitudes = std::move(kept.attitudes[samples.boot]);
  if (const std::size_t doubled = sort_attitudes(samples.attitudes); doubled > 0) {
    samples.warnings.push_back(std::to_string(doubled) +
                               " attitudes were left out: a time that another one has");
  }
  take_positions(kept, samples);
  return samples;
}

}  // namespace overfly::flight::logs
