#include "server/logs/log_residuals.hpp"

#include <array>
#include <cmath>
#include <utility>

#include "core/measure/bounded_series.hpp"
#include "core/motion/pose.hpp"
#include "core/time.hpp"
#include "flight/replay/smooth_log.hpp"

namespace overfly::server {
namespace {

namespace smoothing = flight::smoothing;
using Json = nlohmann::json;
using Names = std::array<const char*, 3>;

constexpr Names kPositionNames = {"east_m", "north_m", "up_m"};
constexpr Names kAttitudeNames = {"x_deg", "y_deg", "z_deg"};

/// Rows of samples, column by column. @param factor  converts the unit
Json table_of(const BoundedSeries& series, const Names& names, double factor) {
  constexpr double kSteps = 1e5;
  Json table = {{"t_s", Json::array()}};
  for (const char* name : names) table[name] = Json::array();
  for (const SeriesPoint& point : series.points()) {
    table["t_s"].push_back(s_from_ns(point.t_ns));
    for (std::size_t i = 0; i < names.size(); ++i) {
      table[names[i]].push_back(std::round(point.values[i] * factor * kSteps) / kSteps);
    }
  }
  return table;
}

Json fit_json(const flight::SmoothedLog& log,
              const smoothing::FitReport& report,
              const Names& names,
              double factor,
              std::size_t max_points) {
  // Each interval keeps at most two points for each of three values.
  const std::size_t intervals = (max_points - 2) / (2 * kSeriesChannels);
  BoundedSeries used(3, intervals);
  BoundedSeries shifted(3, intervals);
  BoundedSeries left_out(3, intervals);
  for (const smoothing::SampleResidual& row : report.residuals) {
    const Eigen::Vector3d& value = row.residual;
    BoundedSeries& series = !row.used ? left_out : row.shifted ? shifted : used;
    series.add({log.epoch_ns + ns_from_s(row.t_s), {value.x(), value.y(), value.z()}});
  }
  return {{"used_count", report.used},
          {"shifted_count", report.shifted},
          {"left_out_count", report.left_out},
          {"longest_gap_s", report.longest_gap_s},
          {"used", table_of(used, names, factor)},
          {"shifted", table_of(shifted, names, factor)},
          {"left_out", table_of(left_out, names, factor)}};
}

Json jump_json(const flight::SmoothedLog& log, const smoothing::Jump& jump) {
  return {{"t_s", s_from_ns(log.epoch_ns + ns_from_s(jump.t_s))},
          {"kind", to_string(jump.kind)},
          {"text", flight::jump_text(log, jump)}};
}

}  // namespace

Result<Json> log_residuals(const flight::logs::OpenedLog& log,
                           const ResidualRequest& request,
                           const std::atomic<bool>* cancel,
                           const smoothing::SmoothingProgress& progress) {
  smoothing::SmoothingOptions options;
  options.time_offset_s = request.time_offset_s;
  // The separation moves all positions alike: it does not change what is left of them.
  const Result<flight::SmoothedLog> smoothed =
      flight::smooth_log(log,
                         {request.source, request.slice.from_ns, request.slice.to_ns},
                         options,
                         0.0,
                         cancel,
                         progress);
  if (!smoothed) return smoothed.error();
  const smoothing::SmoothedMotion& motion = smoothed->smoothed;
  Json positions = fit_json(*smoothed, motion.positions, kPositionNames, 1.0, request.max_points);
  positions["source"] = smoothed->position_source;
  positions["rms_m"] = motion.positions.rms;
  positions["noise_horizontal_m"] = motion.position_noise.horizontal_m;
  positions["noise_vertical_m"] = motion.position_noise.vertical_m;
  Json attitudes =
      fit_json(*smoothed, motion.attitudes, kAttitudeNames, deg_from_rad(1.0), request.max_points);
  attitudes["source"] = smoothed->attitude_source;
  attitudes["rms_deg"] = deg_from_rad(motion.attitudes.rms);
  attitudes["noise_deg"] = deg_from_rad(motion.attitude_noise_rad);
  constexpr std::size_t kMaxJumps = 200;
  Json jumps = Json::array();
  for (std::size_t i = 0; i < std::min(kMaxJumps, motion.jumps.size()); ++i) {
    jumps.push_back(jump_json(*smoothed, motion.jumps[i]));
  }
  Json json = {{"positions", std::move(positions)},
               {"attitudes", std::move(attitudes)},
               {"time_offset_s", motion.motion.time_offset_s},
               {"time_offset_sigma_s", nullptr},
               {"jump_count", motion.jumps.size()},
               {"jumps", std::move(jumps)},
               {"warnings", smoothed->warnings}};
  if (motion.estimated_offset) json["time_offset_sigma_s"] = motion.estimated_offset->sigma_s;
  return json;
}

}  // namespace overfly::server
