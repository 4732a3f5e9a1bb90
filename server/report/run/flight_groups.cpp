#include "server/report/run/flight_groups.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "core/motion/trajectory.hpp"
#include "core/time.hpp"

namespace overfly::server::report {
namespace {

constexpr std::int64_t kDurationNs = kNsPerS / 2;
constexpr double kPlaceM = 0.1;
constexpr double kOriginRad = 1e-10;  // 0.6 mm on the ground
constexpr double kOriginM = 1e-3;

bool same_origin(const ReportRun& a, const ReportRun& b) {
  const auto origin_of = [](const ReportRun& run) {
    return run.manifest.world ? run.manifest.world->origin : std::nullopt;
  };
  const std::optional<Geodetic> here = origin_of(a);
  const std::optional<Geodetic> there = origin_of(b);
  if (!here || !there) return false;
  return std::abs(here->lat_rad - there->lat_rad) <= kOriginRad &&
         std::abs(here->lon_rad - there->lon_rad) <= kOriginRad &&
         std::abs(here->alt_ellipsoid_m - there->alt_ellipsoid_m) <= kOriginM;
}

Trajectory flown_path(const ReportRun& run) {
  Trajectory path;
  for (const FrameRow& row : run.main_frames()) {
    // Rows whose times do not increase are left out.
    static_cast<void>(path.append({row.t_ns, row.T_world_body}));
  }
  return path;
}

}  // namespace

bool same_flight(const ReportRun& a, const ReportRun& b) {
  if (!same_origin(a, b)) return false;
  const Trajectory here = flown_path(a);
  const Trajectory there = flown_path(b);
  if (here.empty() || there.empty()) return false;
  if (std::abs(here.end_ns() - there.end_ns()) > kDurationNs) return false;
  std::size_t compared = 0;
  for (const StampedPose& stamped : here.poses()) {
    const std::optional<Pose> other = there.at(stamped.t_ns);
    if (!other) continue;
    ++compared;
    if (!((other->translation - stamped.pose.translation).norm() <= kPlaceM)) return false;
  }
  return compared > 0;
}

std::vector<std::vector<std::size_t>> flight_groups(const std::vector<ReportRun>& runs) {
  std::vector<std::vector<std::size_t>> groups;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const auto group =
        std::find_if(groups.begin(), groups.end(), [&](const std::vector<std::size_t>& members) {
          return same_flight(runs[members.front()], runs[i]);
        });
    if (group != groups.end()) {
      group->push_back(i);
    } else {
      groups.push_back({i});
    }
  }
  return groups;
}

}  // namespace overfly::server::report
