#include "flight/replay/logged_flight.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "core/motion/trajectory.hpp"
#include "core/text/number_text.hpp"
#include "core/time.hpp"
#include "flight/known_flight.hpp"
#include "flight/logs/ned_attitude.hpp"
#include "flight/logs/truth/log_trajectory.hpp"
#include "flight/pose_flight.hpp"
#include "flight/replay/flight_events.hpp"
#include "flight/replay/logged_sensors.hpp"
#include "flight/replay/smooth_log.hpp"

namespace overfly::flight {
namespace {

/// A rebase looks at the flight this often.
constexpr double kPlacementStepS = 0.2;
constexpr std::size_t kMaxListedJumps = 20;

/// A flight whose states a smooth motion gives.
class SmoothedFlight final : public KnownFlight {
 public:
  SmoothedFlight(SmoothedLog log,
                 const Pose& T_world_log,
                 std::vector<std::string> warnings,
                 std::string description)
      : KnownFlight(std::move(description), std::move(warnings)),
        log_(std::move(log)),
        T_world_log_(T_world_log) {}

  [[nodiscard]] std::optional<std::int64_t> log_start_ns() const override {
    return log_.begin_ns();
  }

 private:
  [[nodiscard]] std::int64_t end_ns() const override { return log_.end_ns() - log_.begin_ns(); }
  [[nodiscard]] AircraftState state(std::int64_t t_ns) const override {
    const smoothing::MotionState motion =
        log_.smoothed.motion.at(s_from_ns(log_.begin_ns() - log_.epoch_ns + t_ns));
    AircraftState state;
    state.t_ns = t_ns;
    state.T_world_body = T_world_log_ * log_.pose(motion);
    state.v_body_world_m_s = T_world_log_.rotation * motion.v_world_m_s;
    // The horizon turns with the earth's curvature by 0.0002 deg/s at 25 m/s: neglected.
    state.omega_body_rad_s = motion.omega_body_rad_s;
    state.airspeed_m_s = motion.v_world_m_s.norm();  // the log's wind is not known
    return state;
  }

  SmoothedLog log_;
  Pose T_world_log_;
};

/// T_world_log of a log at its own place: both are rigid frames of the same earth.
Pose own_place(const LocalFrame& log, const LocalFrame& world) {
  return {world.R_world_enu_at(log.origin()), world.world_from_geodetic(log.origin())};
}

/// @param path_log  positions of the flight in the log's frame, not empty
Pose moved_place(const Rebase& rebase,
                 const std::vector<Eigen::Vector3d>& path_log,
                 const LocalFrame& world,
                 const HeightQuery& ground) {
  Eigen::Vector2d reference = path_log.front().head<2>();
  if (rebase.point == Rebase::Point::kCentre) {
    Eigen::AlignedBox2d box;
    for (const Eigen::Vector3d& p : path_log) box.extend(p.head<2>().eval());
    reference = box.center();
  }
  Eigen::Vector2d anchor;
  if (const auto* place = std::get_if<PlaceInWorld>(&rebase.at)) {
    anchor = {place->east_m, place->north_m};
  } else {
    const auto& point = std::get<PlaceOnEarth>(rebase.at);
    anchor =
        world.world_from_geodetic({point.lat_rad, point.lon_rad, world.origin().alt_ellipsoid_m})
            .head<2>();
  }
  Pose T_world_log;
  T_world_log.rotation = Eigen::AngleAxisd(-rebase.turn_rad, Eigen::Vector3d::UnitZ());
  const Eigen::Vector3d turned =
      T_world_log.rotation * Eigen::Vector3d(reference.x(), reference.y(), 0.0);
  T_world_log.translation = {anchor.x() - turned.x(), anchor.y() - turned.y(), 0.0};
  double lowest_m = std::numeric_limits<double>::infinity();
  for (const Eigen::Vector3d& p_log : path_log) {
    const Eigen::Vector3d p = T_world_log * p_log;
    lowest_m = std::min(lowest_m, p.z() - ground.ground_up_m(p.x(), p.y()));
  }
  T_world_log.translation.z() = rebase.lowest_agl_m - lowest_m;
  return T_world_log;
}

Pose place_of(const LogFlightOptions& options,
              const std::vector<Eigen::Vector3d>& path_log,
              const LocalFrame& log,
              const LocalFrame& world,
              const HeightQuery& ground) {
  return options.rebase ? moved_place(*options.rebase, path_log, world, ground)
                        : own_place(log, world);
}

std::vector<std::string> jump_warnings(const SmoothedLog& log) {
  std::vector<std::string> warnings;
  for (const smoothing::Jump& jump : log.smoothed.jumps) {
    if (warnings.size() == kMaxListedJumps) {
      warnings.push_back(std::to_string(log.smoothed.jumps.size() - kMaxListedJumps) +
                         " more jumps: see `overfly log smooth`");
      break;
    }
    warnings.push_back(jump_text(log, jump));
  }
  return warnings;
}

/// The poses T_log_body of a log in a frame on the earth.
struct PlacedPoses {
  LocalFrame frame;
  std::vector<Pose> poses;
  std::vector<StampedRotation> rotations;  ///< R_log_body at the times of the logged attitudes
};

/// The logged attitudes, each relative to the horizon where the aircraft is then.
/// @pre placed.poses are those of the log
std::vector<StampedRotation> place_attitudes(const logs::LogTrajectory& log,
                                             const PlacedPoses& placed) {
  std::vector<StampedRotation> rotations;
  rotations.reserve(log.attitudes.size());
  std::size_t next = 0;
  for (const logs::LogAttitude& attitude : log.attitudes) {
    while (next < log.poses.size() && log.poses[next].t_ns < attitude.t_ns) ++next;
    const std::size_t after = std::min(next, log.poses.size() - 1);
    const std::size_t before = after > 0 ? after - 1 : 0;
    const std::int64_t from_ns = log.poses[before].t_ns;
    const std::int64_t to_ns = log.poses[after].t_ns;
    const double alpha =
        to_ns > from_ns ? s_from_ns(attitude.t_ns - from_ns) / s_from_ns(to_ns - from_ns) : 0.0;
    const Eigen::Vector3d p_log = placed.poses[before].translation +
                                  std::clamp(alpha, 0.0, 1.0) * (placed.poses[after].translation -
                                                                 placed.poses[before].translation);
    const Geodetic point = placed.frame.geodetic_from_world(p_log);
    const Eigen::Quaterniond R_ned_body = attitude.R_ned_body.cast<double>().normalized();
    rotations.push_back(
        {attitude.t_ns, placed.frame.R_world_enu_at(point) * logs::R_enu_ned() * R_ned_body});
  }
  return rotations;
}

Result<PlacedPoses> place_poses(const logs::LogTrajectory& log, const LogFlightOptions& options) {
  if (options.local_origin) {
    PlacedPoses placed{LocalFrame(*options.local_origin), {}, {}};
    for (const logs::LogPose& pose : log.poses) {
      placed.poses.push_back(
          {logs::R_enu_ned() * pose.R_ned_body, logs::R_enu_ned() * pose.position});
    }
    for (const logs::LogAttitude& attitude : log.attitudes) {
      placed.rotations.push_back(
          {attitude.t_ns, logs::R_enu_ned() * attitude.R_ned_body.cast<double>().normalized()});
    }
    return placed;
  }
  const Result<double> separation = logs::separation_of(
      log.height, log.position_source, options.geoid_separation_m.value_or(0.0));
  if (!separation) return separation.error();
  const auto geodetic = [&](const logs::LogPose& pose) {
    return geodetic_from_deg(pose.position.x(), pose.position.y(), pose.position.z() + *separation);
  };
  PlacedPoses placed{LocalFrame(geodetic(log.poses.front())), {}, {}};
  for (const logs::LogPose& pose : log.poses) {
    const Geodetic point = geodetic(pose);
    placed.poses.push_back(
        {placed.frame.R_world_enu_at(point) * logs::R_enu_ned() * pose.R_ned_body,
         placed.frame.world_from_geodetic(point)});
  }
  placed.rotations = place_attitudes(log, placed);
  return placed;
}

/// The median of each coordinate. @pre not empty
Eigen::Vector3d middle_of(const std::vector<Eigen::Vector3d>& path) {
  Eigen::Vector3d middle;
  std::vector<double> values(path.size());
  const auto median = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  for (int axis = 0; axis < 3; ++axis) {
    for (std::size_t i = 0; i < path.size(); ++i) values[i] = path[i][axis];
    std::nth_element(values.begin(), median, values.end());
    middle[axis] = *median;
  }
  return middle;
}

/// @param path  positions of the log's poses [m]
Status check_extent(const logs::LogTrajectory& log, const std::vector<Eigen::Vector3d>& path) {
  const Eigen::Vector3d middle = middle_of(path);
  for (std::size_t i = 0; i < path.size(); ++i) {
    const double distance_m = (path[i] - middle).norm();
    if (distance_m <= kFarthestFromMiddleM) continue;
    return Error{ErrorCode::kUnreadable,
                 log.position_source + ": the position at " + seconds_text(log.poses[i].t_ns) +
                     " s of the vehicle's clock is " +
                     std::to_string(static_cast<std::int64_t>(distance_m / 1000.0)) +
                     " km away from the middle of the flight: it must be damaged. `smooth` leaves "
                     "such out, as do `from_s` and `to_s`"};
  }
  return {};
}

/// Heights above sea level that are flown as heights above the ellipsoid are wrong by the geoid's.
void warn_of_sea_level(const LogFlightOptions& options,
                       logs::HeightDatum height,
                       const std::string& source,
                       const LocalFrame& log,
                       std::vector<std::string>& warnings) {
  if (height != logs::HeightDatum::kMeanSeaLevel || options.geoid_separation_m || options.rebase ||
      !options.sea_level_m) {
    return;
  }
  const double wrong_by_m = std::abs(options.sea_level_m(log.origin()));
  warnings.push_back("the heights of " + source +
                     " are above mean sea level and, without geoid_separation_m, are flown as "
                     "heights above the ellipsoid: they may be wrong by about " +
                     std::to_string(std::lround(wrong_by_m)) + " m here");
}

SensorRequest sensor_request(const LogFlightOptions& options,
                             const std::string& source,
                             std::uint32_t boot,
                             std::int64_t begin_ns,
                             std::int64_t end_ns) {
  return {source,
          boot,
          begin_ns,
          end_ns,
          options.geoid_separation_m.value_or(0.0),
          options.rebase.has_value()};
}

Result<std::unique_ptr<TruthSource>> fly_smoothed(const logs::OpenedLog& opened,
                                                  const logs::TrajectoryRequest& request,
                                                  const LogFlightOptions& options,
                                                  const LocalFrame& frame,
                                                  const HeightQuery& ground,
                                                  const std::atomic<bool>* cancel) {
  Result<SmoothedLog> log = smooth_log(
      opened, request, *options.smooth, options.geoid_separation_m.value_or(0.0), cancel);
  if (!log) return log.error();
  std::vector<Eigen::Vector3d> path;
  const smoothing::SmoothMotion& motion = log->smoothed.motion;
  for (double t_s = motion.begin_s; t_s <= motion.end_s; t_s += kPlacementStepS) {
    path.push_back(motion.position.position_m(t_s));
  }
  path.push_back(motion.position.position_m(motion.end_s));
  const Pose T_world_log = place_of(options, path, log->frame, frame, ground);
  std::vector<std::string> warnings = opened.warnings;
  warnings.insert(warnings.end(), log->warnings.begin(), log->warnings.end());
  for (std::string& text : jump_warnings(*log)) warnings.push_back(std::move(text));
  warn_of_sea_level(options, log->height, log->position_source, log->frame, warnings);
  std::string description = "log: " + opened.file.filename().string() + ", " +
                            log->position_source + " with the attitude of " + log->attitude_source +
                            ", smoothed" + (options.rebase ? ", moved" : "");
  std::vector<FlightEvent> events =
      events_of(opened, log->position_source, log->boot, log->begin_ns(), log->end_ns());
  auto sensors = read_logged_sensors(
      opened,
      sensor_request(options, log->position_source, log->boot, log->begin_ns(), log->end_ns()),
      cancel);
  if (!sensors) return sensors.error();
  return with_records(
      std::make_unique<SmoothedFlight>(
          std::move(*log), T_world_log, std::move(warnings), std::move(description)),
      std::move(events),
      std::move(*sensors));
}

}  // namespace

bool is_flight_log(const std::filesystem::path& file) { return logs::detect_format(file).ok(); }

Result<std::unique_ptr<TruthSource>> fly_flight_log(const std::filesystem::path& file,
                                                    const LogFlightOptions& options,
                                                    const LocalFrame& frame,
                                                    const HeightQuery& ground,
                                                    const SourcePolicy& sources,
                                                    const std::atomic<bool>* cancel) {
  logs::LogSlice slice;
  if (options.from_s) slice.from_ns = ns_from_s(*options.from_s);
  if (options.to_s) slice.to_ns = ns_from_s(*options.to_s);
  const Result<logs::OpenedLog> opened =
      logs::open_log(file, cancel, {.sources = sources, .slice = slice});
  if (!opened) return opened.error();
  logs::TrajectoryRequest request{options.source, slice.from_ns, slice.to_ns};
  if (options.smooth) return fly_smoothed(*opened, request, options, frame, ground, cancel);

  request.attitude_offset_ns = ns_from_s(options.time_offset_s);
  request.keep_attitudes = true;
  Result<logs::LogTrajectory> log = logs::read_log_trajectory(*opened, request, cancel);
  if (!log) return log.error();
  if (log->georeferenced && options.local_origin) {
    return Error{ErrorCode::kInvalidArgument,
                 file.string() + ": an origin was given, but the positions of " +
                     log->position_source + " have their place on the earth"};
  }
  if (!log->georeferenced && !options.local_origin) {
    return Error{ErrorCode::kUnsupported,
                 file.string() + ": the positions of " + log->position_source +
                     " count from an origin that the log does not state: they cannot be flown"};
  }
  if (log->poses.size() < 2) {
    return Error{ErrorCode::kUnreadable, file.string() + ": 1 pose: a flight needs at least 2"};
  }
  Result<PlacedPoses> placed = place_poses(*log, options);
  if (!placed) return placed.error().in(file.string());
  const std::vector<Pose>& poses = placed->poses;
  const LocalFrame& log_frame = placed->frame;
  std::vector<Eigen::Vector3d> path;
  path.reserve(poses.size());
  for (const Pose& pose : poses) path.push_back(pose.translation);
  if (!options.far_poses) {
    if (Status status = check_extent(*log, path); !status) return status.error().in(file.string());
  }
  const Pose T_world_log = place_of(options, path, log_frame, frame, ground);
  Trajectory trajectory;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (Status status = trajectory.append({log->poses[i].t_ns, T_world_log * poses[i]}); !status) {
      return status.error().in(file.string());
    }
  }
  std::vector<std::string> warnings = opened->warnings;
  warnings.insert(warnings.end(), log->warnings.begin(), log->warnings.end());
  if (log->georeferenced) {
    warn_of_sea_level(options, log->height, log->position_source, log_frame, warnings);
  }
  for (StampedRotation& rotation : placed->rotations) {
    rotation.R_world_body = (T_world_log.rotation * rotation.R_world_body).normalized();
  }
  auto flown = fly_poses(std::move(trajectory),
                         std::move(placed->rotations),
                         std::move(warnings),
                         "log: " + file.filename().string() + ", " + log->position_source +
                             " with the attitude of " + log->attitude_source +
                             (options.rebase ? ", moved" : ""));
  const std::int64_t begin_ns = log->poses.front().t_ns;
  const std::int64_t end_ns = log->poses.back().t_ns;
  auto sensors = read_logged_sensors(
      *opened, sensor_request(options, log->position_source, log->boot, begin_ns, end_ns), cancel);
  if (!sensors) return sensors.error();
  return with_records(std::move(flown),
                      events_of(*opened, log->position_source, log->boot, begin_ns, end_ns),
                      std::move(*sensors));
}

}  // namespace overfly::flight
