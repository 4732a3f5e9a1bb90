#include "server/timeline/gps_errors.hpp"

#include <algorithm>

#include "core/time.hpp"

namespace overfly::server {
namespace {

constexpr std::int64_t kLongestNs = kNsPerS / 2;

}  // namespace

GpsErrors::GpsErrors(const RunTimeline& timeline, const Geodetic& origin) : world_(origin) {
  constexpr std::size_t kChunk = 2000;
  while (true) {
    const std::vector<FrameRow> rows = timeline.frames(times_ns_.size(), kChunk);
    if (rows.empty()) return;
    for (const FrameRow& row : rows) {
      times_ns_.push_back(row.t_ns);
      places_world_m_.push_back(row.T_world_body.translation);
    }
  }
}

std::optional<Eigen::Vector3d> GpsErrors::of(const GpsSample& fix) const {
  if (fix.fix == GpsFixType::kNone) return std::nullopt;
  const auto after = std::lower_bound(times_ns_.begin(), times_ns_.end(), fix.t_ns);
  if (after == times_ns_.end()) return std::nullopt;
  const auto next = static_cast<std::size_t>(after - times_ns_.begin());
  Eigen::Vector3d place = places_world_m_[next];
  if (*after != fix.t_ns) {
    if (next == 0 || *after - times_ns_[next - 1] > kLongestNs) return std::nullopt;
    const std::int64_t before_ns = times_ns_[next - 1];
    const double share =
        static_cast<double>(fix.t_ns - before_ns) / static_cast<double>(*after - before_ns);
    place = places_world_m_[next - 1] + share * (place - places_world_m_[next - 1]);
  }
  return world_.world_from_geodetic(fix.place) - place;
}

}  // namespace overfly::server
