#include "server/report/figures/estimate_lines.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/time.hpp"

namespace overfly::server::report {
namespace {

using plot::kGap;
using plot::Point;

/// Builds a line: a gap where it is interrupted, or where time passes without a point.
class LineBuilder {
 public:
  explicit LineBuilder(std::int64_t gap_limit_ns) : gap_limit_ns_(gap_limit_ns) {}

  void add(std::int64_t t_ns, const Point& point) {
    if (!points_.empty() && t_ns - last_ns_ > gap_limit_ns_) interrupt(point.x);
    points_.push_back(point);
    last_ns_ = t_ns;
  }
  void interrupt(double x) {
    if (!points_.empty() && !points_.back().is_gap()) points_.push_back({x, kGap});
  }
  [[nodiscard]] std::vector<Point> line() && { return std::move(points_); }

 private:
  std::int64_t gap_limit_ns_;
  std::int64_t last_ns_ = 0;
  std::vector<Point> points_;
};

std::int64_t gap_limit_of(const ReportRun& run, const ReportEstimate& estimate) {
  return gap_limit_ns(run.frames.at(estimate.camera));
}

/// @param point_at  of a row's time [ns] and pose
template <typename PointAt>
std::vector<Point> truth_line(const ReportRun& run, const PointAt& point_at) {
  LineBuilder line(gap_limit_ns(run.main_frames()));
  for (const FrameRow& row : run.main_frames()) {
    line.add(row.t_ns, point_at(row.t_ns, row.T_world_body));
  }
  return std::move(line).line();
}

template <typename PointAt>
std::vector<Point> estimate_line(const ReportRun& run,
                                 const ReportEstimate& estimate,
                                 const PointAt& point_at) {
  LineBuilder line(gap_limit_of(run, estimate));
  for (const ReportAnswer& answer : estimate.answers) {
    if (answer.T_world_body) {
      line.add(answer.t_ns, point_at(answer.t_ns, *answer.T_world_body));
    } else {
      line.interrupt(s_from_ns(answer.t_ns));
    }
  }
  return std::move(line).line();
}

}  // namespace

double height_m(const Pose& T_world_body) { return T_world_body.translation.z(); }

double roll_deg(const Pose& T_world_body) {
  return deg_from_rad(attitude_from(T_world_body.rotation).roll_rad);
}

double pitch_deg(const Pose& T_world_body) {
  return deg_from_rad(attitude_from(T_world_body.rotation).pitch_rad);
}

double yaw_deg(const Pose& T_world_body) {
  const double yaw = deg_from_rad(attitude_from(T_world_body.rotation).yaw_rad);
  return yaw < 0.0 ? yaw + 360.0 : yaw;
}

std::int64_t gap_limit_ns(const std::vector<FrameRow>& frames) {
  constexpr std::int64_t kLeastNs = kNsPerS / 2;
  if (frames.size() < 2) return kLeastNs;
  const auto intervals = static_cast<std::int64_t>(frames.size() - 1);
  return std::max(kLeastNs, 3 * ((frames.back().t_ns - frames.front().t_ns) / intervals));
}

std::vector<Point> truth_over_time(const ReportRun& run, const PoseValue& value) {
  return truth_line(run, [&](std::int64_t t_ns, const Pose& pose) {
    return Point{s_from_ns(t_ns), value(pose)};
  });
}

std::vector<Point> estimate_over_time(const ReportRun& run,
                                      const ReportEstimate& estimate,
                                      const PoseValue& value) {
  return estimate_line(run, estimate, [&](std::int64_t t_ns, const Pose& pose) {
    return Point{s_from_ns(t_ns), value(pose)};
  });
}

std::vector<Point> truth_path(const ReportRun& run, int x, int y) {
  return truth_line(run, [&](std::int64_t, const Pose& pose) {
    return Point{pose.translation[x], pose.translation[y]};
  });
}

std::vector<Point> estimate_path(const ReportRun& run,
                                 const ReportEstimate& estimate,
                                 int x,
                                 int y) {
  return estimate_line(run, estimate, [&](std::int64_t, const Pose& pose) {
    return Point{pose.translation[x], pose.translation[y]};
  });
}

std::vector<Point> matched_over_time(const ReportRun& run,
                                     const ReportEstimate& estimate,
                                     const std::vector<double>& values) {
  const std::vector<std::int64_t>& matched_t_ns = run.metrics_of(estimate).score.matched_t_ns;
  LineBuilder line(gap_limit_of(run, estimate));
  std::size_t next = 0;
  for (const ReportAnswer& answer : estimate.answers) {
    const std::int64_t t_ns = answer.t_ns;
    while (next < matched_t_ns.size() && matched_t_ns[next] < t_ns) ++next;
    const bool matched = answer.scored && next < matched_t_ns.size() && next < values.size() &&
                         matched_t_ns[next] == t_ns;
    if (matched) {
      line.add(t_ns, {s_from_ns(t_ns), values[next]});
    } else {
      line.interrupt(s_from_ns(t_ns));
    }
  }
  return std::move(line).line();
}

std::vector<Point> latency_over_time(const ReportRun& run, const ReportEstimate& estimate) {
  LineBuilder line(gap_limit_of(run, estimate));
  for (const ReportAnswer& answer : estimate.answers) {
    if (answer.latency_ms > 0.0) {
      line.add(answer.t_ns, {s_from_ns(answer.t_ns), answer.latency_ms});
    }
  }
  return std::move(line).line();
}

std::vector<Point> frames_over_time(
    const ReportRun& run,
    std::size_t camera,
    const std::function<std::optional<double>(const FrameRow&)>& value) {
  const std::vector<FrameRow>& frames = run.frames.at(camera);
  LineBuilder line(gap_limit_ns(frames));
  for (const FrameRow& row : frames) {
    if (const std::optional<double> at = value(row)) {
      line.add(row.t_ns, {s_from_ns(row.t_ns), *at});
    } else {
      line.interrupt(s_from_ns(row.t_ns));
    }
  }
  return std::move(line).line();
}

std::vector<plot::Band> state_bands(const ReportRun& run, const ReportEstimate& estimate) {
  const std::int64_t limit_ns = gap_limit_of(run, estimate);
  const auto kind_of = [](TrackingState state) {
    switch (state) {
      case TrackingState::kInitialising:
        return plot::BandKind::kInitialising;
      case TrackingState::kTracking:
        return plot::BandKind::kTracking;
      case TrackingState::kLost:
        return plot::BandKind::kLost;
    }
    return plot::BandKind::kNone;
  };
  std::vector<plot::Band> bands;
  const std::vector<ReportAnswer>& answers = estimate.answers;
  const std::int64_t last_ns = run.main_frames().back().t_ns;
  for (std::size_t i = 0; i < answers.size(); ++i) {
    const std::int64_t t_ns = answers[i].t_ns;
    const std::int64_t next_ns =
        i + 1 < answers.size() ? answers[i + 1].t_ns : std::max(t_ns, last_ns);
    bands.push_back({s_from_ns(t_ns),
                     s_from_ns(std::min(next_ns, t_ns + limit_ns)),
                     kind_of(answers[i].state)});
  }
  return bands;
}

}  // namespace overfly::server::report
