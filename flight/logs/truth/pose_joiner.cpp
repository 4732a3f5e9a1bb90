#include "flight/logs/truth/pose_joiner.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "core/time.hpp"

namespace overfly::flight::logs {
namespace {

/// Later attitudes are not older than the latest one by more than this (BootClock).
constexpr std::int64_t kMaxDisorderNs = 2 * kNsPerS;
constexpr std::size_t kJoinBlock = 4096;

/// The attitude at a time between the first one not before it and the one in front of that.
/// @param next  index of the first one not before the time
std::optional<Eigen::Quaterniond> attitude_at(const std::vector<LogAttitude>& attitudes,
                                              std::size_t next,
                                              std::int64_t t_ns) {
  if (next == attitudes.size()) return std::nullopt;
  const LogAttitude& after = attitudes[next];
  if (after.t_ns == t_ns) {
    return after.R_ned_body.cast<double>().normalized();
  }
  if (next == 0) return std::nullopt;
  const LogAttitude& before = attitudes[next - 1];
  if (t_ns - before.t_ns > kMaxAttitudeStepNs || after.t_ns - t_ns > kMaxAttitudeStepNs) {
    return std::nullopt;
  }
  const double alpha =
      static_cast<double>(t_ns - before.t_ns) / static_cast<double>(after.t_ns - before.t_ns);
  return before.R_ned_body.cast<double>().normalized().slerp(
      alpha, after.R_ned_body.cast<double>().normalized());
}

/// Sorts by time, keeping the order of equal ones, and removes all but the first of equal ones.
/// @return the number of those that were removed
std::size_t order_attitudes(std::vector<LogAttitude>& attitudes) {
  const auto earlier = [](const LogAttitude& a, const LogAttitude& b) { return a.t_ns < b.t_ns; };
  if (!std::is_sorted(attitudes.begin(), attitudes.end(), earlier)) {
    std::stable_sort(attitudes.begin(), attitudes.end(), earlier);
  }
  const auto end = std::unique(
      attitudes.begin(), attitudes.end(), [](const LogAttitude& a, const LogAttitude& b) {
        return a.t_ns == b.t_ns;
      });
  const auto removed = static_cast<std::size_t>(attitudes.end() - end);
  attitudes.erase(end, attitudes.end());
  return removed;
}

}  // namespace

PoseJoiner::Run& PoseJoiner::run_of(std::uint32_t boot) {
  const auto [entry, first] = runs_.try_emplace(boot);
  Run& run = entry->second;
  if (!first) return run;
  run.join_at = kJoinBlock;
  if (runs_.size() == 1) run.poses.reserve(expected_);
  return run;
}

void PoseJoiner::position(const LogTime& time, const Eigen::Vector3d& value) {
  Run& run = run_of(time.boot);
  ++positions_;
  ++run.positions;
  if (run.last_position_ns && time.t_ns <= *run.last_position_ns) {
    ++run.out_of_order;
    return;
  }
  run.last_position_ns = time.t_ns;
  run.waiting.push_back({time.t_ns, static_cast<std::uint32_t>(origins_.size()), value});
  join_some(run);
}

void PoseJoiner::attitude(const LogTime& time, const Eigen::Quaterniond& R_ned_body) {
  Run& run = run_of(time.boot);
  run.latest_attitude_ns =
      run.attitudes.empty() ? time.t_ns : std::max(run.latest_attitude_ns, time.t_ns);
  run.attitudes.push_back({time.t_ns, R_ned_body.cast<float>()});
  join_some(run);
}

void PoseJoiner::local_origin(const LocalOrigin& origin) {
  if (origins_.empty() || !(origins_.back() == origin)) origins_.push_back(origin);
}

void PoseJoiner::join_some(Run& run) {
  if (run.waiting.size() + run.attitudes.size() < run.join_at) return;
  if (!run.attitudes.empty()) join(run, run.latest_attitude_ns - kMaxDisorderNs);
  run.join_at = 2 * (run.waiting.size() + run.attitudes.size()) + kJoinBlock;
}

void PoseJoiner::join(Run& run, std::int64_t until_ns) {
  run.doubled += order_attitudes(run.attitudes);
  std::size_t next = 0;
  std::size_t done = 0;
  for (; done < run.waiting.size() && run.waiting[done].t_ns <= until_ns; ++done) {
    const Position& position = run.waiting[done];
    while (next < run.attitudes.size() && run.attitudes[next].t_ns < position.t_ns) ++next;
    if (const auto attitude = attitude_at(run.attitudes, next, position.t_ns)) {
      add_pose(run, position, *attitude);
    } else {
      ++run.without_attitude;
    }
  }
  run.waiting.erase(run.waiting.begin(), run.waiting.begin() + static_cast<std::ptrdiff_t>(done));
  // Later positions are after the last one; of the attitudes before it they need one.
  const std::int64_t needed_ns =
      std::min(until_ns, run.last_position_ns.value_or(std::numeric_limits<std::int64_t>::min()));
  const auto keep = std::partition_point(
      run.attitudes.begin(), run.attitudes.end(), [&](const LogAttitude& attitude) {
        return attitude.t_ns <= needed_ns;
      });
  if (keep - run.attitudes.begin() <= 1) return;
  if (keep_attitudes_) run.used.insert(run.used.end(), run.attitudes.begin(), keep - 1);
  run.attitudes.erase(run.attitudes.begin(), keep - 1);
}

void PoseJoiner::keep_attitudes_of(Run& run) {
  kept_attitudes_ = std::move(run.used);
  kept_attitudes_.insert(kept_attitudes_.end(), run.attitudes.begin(), run.attitudes.end());
  (void)order_attitudes(kept_attitudes_);
  if (run.poses.empty()) return;
  // Every pose has attitudes on both sides.
  const auto after = std::partition_point(
      kept_attitudes_.begin(), kept_attitudes_.end(), [&](const LogAttitude& attitude) {
        return attitude.t_ns < run.poses.back().t_ns;
      });
  kept_attitudes_.erase(after + 1, kept_attitudes_.end());
  const auto from = std::partition_point(
      kept_attitudes_.begin(), kept_attitudes_.end(), [&](const LogAttitude& attitude) {
        return attitude.t_ns <= run.poses.front().t_ns;
      });
  kept_attitudes_.erase(kept_attitudes_.begin(), from - 1);
}

void PoseJoiner::add_pose(Run& run, const Position& position, const Eigen::Quaterniond& R) {
  Eigen::Vector3d value = position.value;
  if (position.origin > 0) {
    value = geodetic_from_local(origins_[position.origin - 1], value);
  } else {
    ++run.without_origin;
  }
  run.poses.push_back({position.t_ns, value, R});
}

PoseJoiner::JoinedPoses PoseJoiner::take_poses(std::vector<std::string>& warnings) {
  const auto most = std::max_element(runs_.begin(), runs_.end(), [](const auto& a, const auto& b) {
    return a.second.positions < b.second.positions;
  });
  Run& run = most->second;
  join(run, std::numeric_limits<std::int64_t>::max());
  if (keep_attitudes_) keep_attitudes_of(run);
  if (!origins_.empty()) {
    for (std::size_t i = 0; i < run.without_origin; ++i) {
      run.poses[i].position = geodetic_from_local(origins_.front(), run.poses[i].position);
    }
  }
  const auto warn = [&](std::size_t count, const std::string& text) {
    if (count > 0) warnings.push_back(std::to_string(count) + " " + text);
  };
  const auto others = std::count_if(runs_.begin(), runs_.end(), [&](const auto& other) {
    return &other.second != &run && other.second.positions > 0;
  });
  warn(positions_ - run.positions,
       "positions of " + std::to_string(others) +
           " other runs of the clock were left out: it starts again within the log");
  warn(run.doubled, "attitudes were left out: a time that another one has");
  warn(run.out_of_order, "positions were left out: not later than the one before");
  warn(run.without_attitude, "positions were left out: no attitude on both sides within 1 s");
  if (origins_.size() > 1) {
    warnings.push_back("the origin of the local positions changes " +
                       std::to_string(origins_.size() - 1) + " times");
  }
  return {most->first, std::move(run.poses)};
}

}  // namespace overfly::flight::logs
