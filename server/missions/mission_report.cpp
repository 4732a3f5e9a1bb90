#include "server/missions/mission_report.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/cancel.hpp"
#include "core/motion/pose.hpp"
#include "server/camera/airframe_flight.hpp"
#include "server/missions/camera_view.hpp"
#include "terrain/height_errors.hpp"

namespace overfly::server {
namespace {

using autopilot::FlightPhase;
using autopilot::MissionCommand;
using autopilot::PreviewState;

/// Straight and level: at most so much bank and climb.
constexpr double kLevelBankDeg = 5.0;
constexpr double kLevelClimbMS = 1.5;

/// States between those of a preview.
class PreviewPath {
 public:
  explicit PreviewPath(const std::vector<PreviewState>& states) : states_(states) {}

  [[nodiscard]] double end_s() const { return states_.back().t_s; }
  /// Clamped to the flight.
  [[nodiscard]] Pose T_world_body_at(double t_s) const {
    const double at = std::clamp(t_s, 0.0, end_s()) / autopilot::kPreviewStepS;
    const auto before = std::min(static_cast<std::size_t>(at), states_.size() - 1);
    const auto after = std::min(before + 1, states_.size() - 1);
    return interpolate(
        pose_of(states_[before]), pose_of(states_[after]), at - static_cast<double>(before));
  }

 private:
  static Pose pose_of(const PreviewState& state) {
    return {R_world_body_from(state.attitude), state.position_world_m};
  }
  const std::vector<PreviewState>& states_;
};

Result<const CameraSpec*> named_camera(const Scenario& scenario, const std::string& name) {
  if (name.empty()) return &scenario.main_camera();
  for (const CameraSpec& camera : scenario.cameras) {
    if (camera.name == name) return &camera;
  }
  return Error{ErrorCode::kInvalidArgument,
               "camera = " + name.substr(0, 100) + ": must be a camera of the scenario"};
}

class Reporter {
 public:
  Reporter(const Scenario& scenario,
           const terrain::World& world,
           const MissionRequest& request,
           const CameraSpec& camera,
           const autopilot::Mission& mission,
           const std::vector<PreviewState>& states)
      : tiles_(*world.tiles),
        request_(request),
        camera_(camera),
        frame_s_(1.0 / scenario.rate.hz()),
        items_(mission.items),
        states_(states),
        path_(states) {}

  Status run(const std::atomic<bool>* cancel, MissionReport& report) {
    if (Status status = measure_ground(cancel); !status) return status;
    for (const std::size_t index : chosen()) {
      if (is_cancelled(cancel)) return Error{ErrorCode::kCancelled, "the mission was cancelled"};
      report.samples.push_back(sample_at(index));
    }
    add_footprints(report);
    report.start = start_leg();
    report.duration_s = path_.end_s();
    report.distance_m = distances_m_.back();
    return {};
  }

  /// The instant at which a mission's item ended; empty if it did not.
  [[nodiscard]] std::optional<double> end_of_item(std::size_t item) const {
    const auto after = std::find_if(states_.begin(), states_.end(), [&](const PreviewState& state) {
      return state.item > item;
    });
    return after == states_.end() ? std::nullopt : std::optional(after->t_s);
  }

 private:
  Status measure_ground(const std::atomic<bool>* cancel) {
    constexpr std::size_t kLookEvery = 1024;
    grounds_m_.reserve(states_.size());
    distances_m_.reserve(states_.size());
    for (std::size_t i = 0; i < states_.size(); ++i) {
      if (i % kLookEvery == 0 && is_cancelled(cancel)) {
        return Error{ErrorCode::kCancelled, "the mission was cancelled"};
      }
      const Eigen::Vector3d& at = states_[i].position_world_m;
      grounds_m_.push_back(tiles_.ground_up_m(at.x(), at.y()));
      const double way = i == 0 ? 0.0 : (at - states_[i - 1].position_world_m).head<2>().norm();
      distances_m_.push_back(i == 0 ? 0.0 : distances_m_.back() + way);
    }
    return {};
  }

  [[nodiscard]] double clearance_m(std::size_t index) const {
    return states_[index].position_world_m.z() - grounds_m_[index];
  }

  /// Indices of equal times, and that of the least clearance en route.
  [[nodiscard]] std::vector<std::size_t> chosen() const {
    const std::size_t count = std::min(request_.samples, states_.size());
    std::vector<std::size_t> indices;
    for (std::size_t i = 0; i < count; ++i) {
      indices.push_back(count == 1 ? 0 : i * (states_.size() - 1) / (count - 1));
    }
    std::optional<std::size_t> lowest;
    for (std::size_t i = 0; i < states_.size(); ++i) {
      const FlightPhase phase = states_[i].phase;
      if (phase != FlightPhase::kEnRoute && phase != FlightPhase::kLoiter) continue;
      if (!lowest || clearance_m(i) < clearance_m(*lowest)) lowest = i;
    }
    if (lowest) indices.push_back(*lowest);
    std::sort(indices.begin(), indices.end());
    indices.erase(std::unique(indices.begin(), indices.end()), indices.end());
    return indices;
  }

  [[nodiscard]] MissionSample sample_at(std::size_t index) const {
    MissionSample sample;
    sample.state = states_[index];
    if (sample.state.item < items_.size()) sample.item = items_[sample.state.item].number;
    sample.distance_m = distances_m_[index];
    sample.ground_up_m = grounds_m_[index];
    sample.clearance_m = clearance_m(index);
    sample.place = tiles_.frame().geodetic_from_world(sample.state.position_world_m);
    const double t_s = sample.state.t_s;
    const CameraView view = view_of(camera_.model, camera_pose(t_s), tiles_);
    sample.texels_px = texels_per_pixel(camera_.model, view, tiles_.real_texel_m());
    sample.imagery = imagery_share(view, tiles_);
    const double later_s = t_s + request_.overlap_interval_s;
    if (later_s <= path_.end_s()) {
      const auto now = footprint_of(camera_.model, view.T_world_camera, tiles_);
      const auto later = footprint_of(camera_.model, camera_pose(later_s), tiles_);
      if (now && later) sample.overlap = overlap_of(*now, *later);
    }
    const PixelMotion motion = motion_of(camera_.model, view, camera_pose(t_s + frame_s_));
    sample.rotation_px = motion.rotation_px;
    sample.translation_px = motion.translation_px;
    return sample;
  }
  [[nodiscard]] Pose camera_pose(double t_s) const {
    return path_.T_world_body_at(t_s) * camera_.T_body_camera;
  }

  void add_footprints(MissionReport& report) const {
    const std::size_t step = std::max<std::size_t>(1, report.samples.size() / kMaxFootprints + 1);
    for (std::size_t i = 0; i < report.samples.size(); i += step) {
      const double t_s = report.samples[i].state.t_s;
      const auto corners = footprint_of(camera_.model, camera_pose(t_s), tiles_);
      if (!corners) continue;
      Footprint footprint;
      footprint.t_s = t_s;
      std::transform(
          corners->begin(), corners->end(), footprint.corners.begin(), [&](const auto& at) {
            return tiles_.frame().geodetic_from_world(at);
          });
      report.footprints.push_back(footprint);
    }
  }

  [[nodiscard]] StartLeg leg_between(std::size_t first, std::size_t last) const {
    StartLeg leg;
    leg.from_s = states_[first].t_s;
    leg.to_s = states_[last].t_s;
    leg.length_m = distances_m_[last] - distances_m_[first];
    leg.height_agl_m = clearance_m(first);
    leg.enough = leg.to_s - leg.from_s >= request_.limits.min_start_s &&
                 leg.baseline() >= request_.limits.min_start_baseline;
    return leg;
  }
  [[nodiscard]] std::optional<StartLeg> start_leg() const {
    std::optional<StartLeg> best;
    std::size_t first = 0;
    bool inside = false;
    for (std::size_t i = 0; i < states_.size(); ++i) {
      const PreviewState& state = states_[i];
      const bool level =
          std::abs(deg_from_rad(state.attitude.roll_rad)) <= kLevelBankDeg &&
          std::abs(state.v_world_m_s.z()) <= kLevelClimbMS &&
          (state.phase == FlightPhase::kEnRoute || state.phase == FlightPhase::kLoiter);
      if (level && !inside) first = i;
      inside = inside || level;
      if (inside && (!level || i + 1 == states_.size())) {
        const StartLeg leg = leg_between(first, level ? i : i - 1);
        if (leg.enough) return leg;
        if (!best || leg.to_s - leg.from_s > best->to_s - best->from_s) best = leg;
        inside = false;
      }
    }
    return best;
  }

  const terrain::TileSource& tiles_;
  const MissionRequest& request_;
  const CameraSpec& camera_;
  double frame_s_;
  const std::vector<autopilot::MissionItem>& items_;
  const std::vector<PreviewState>& states_;
  PreviewPath path_;
  std::vector<double> grounds_m_;
  std::vector<double> distances_m_;
};

/// Radius of the turn at a waypoint, as MissionPilot begins it; empty without a turn.
std::optional<double> turn_radius_m(const autopilot::MissionSetup& setup,
                                    const Eigen::Vector2d& in_m,
                                    const autopilot::MissionItem& item,
                                    const Eigen::Vector2d& out_m,
                                    double speed_m_s) {
  constexpr double kLeastTurnDeg = 3.0;
  if (in_m.norm() < 1.0 || out_m.norm() < 1.0) return std::nullopt;
  const double cosine = in_m.normalized().dot(out_m.normalized());
  const double change = std::acos(std::clamp(cosine, -1.0, 1.0));
  if (deg_from_rad(change) < kLeastTurnDeg) return std::nullopt;
  const double half = std::tan(0.5 * std::min(change, rad_from_deg(120.0)));
  const double tightest =
      speed_m_s * speed_m_s /
      (setup.environment.gravity_m_s2 * std::tan(rad_from_deg(setup.parameters.roll_limit_deg)));
  const double lead = item.accept_radius_m > 0.0
                          ? item.accept_radius_m
                          : std::min(tightest * half, 0.5 * std::min(in_m.norm(), out_m.norm()));
  return std::max(lead, 0.2 * setup.parameters.wp_radius) / half;
}

double bank_deg(double speed_m_s, double radius_m, double gravity_m_s2) {
  return deg_from_rad(std::atan(speed_m_s * speed_m_s / (gravity_m_s2 * radius_m)));
}

/// The mission's positions with their turns.
void add_places(const autopilot::MissionSetup& setup,
                const terrain::TileSource& tiles,
                const Reporter& reporter,
                MissionReport& report) {
  const std::vector<autopilot::MissionItem>& items = setup.mission.items;
  const Eigen::Vector2d home = setup.mission.home_world_m.head<2>();
  const auto place_of = [&](const autopilot::MissionItem& item) -> Eigen::Vector2d {
    return item.command == MissionCommand::kReturn ? home : item.position_m;
  };
  const double wind = setup.wind_world_m_s.head<2>().norm();
  double speed = setup.parameters.airspeed_cruise;
  Eigen::Vector2d before = setup.start_world_m ? setup.start_world_m->head<2>().eval() : home;
  for (std::size_t i = 0; i < items.size(); ++i) {
    const autopilot::MissionItem& item = items[i];
    if (item.command == MissionCommand::kSetSpeed) {
      speed = item.airspeed_m_s;
      continue;
    }
    const Eigen::Vector2d at = place_of(item);
    const double ground = tiles.ground_up_m(at.x(), at.y());
    double up = item.above_ground ? ground + item.height_m : item.height_m;
    if (item.command == MissionCommand::kReturn) {
      up = setup.mission.home_world_m.z() + setup.parameters.rtl_altitude;
    }
    MissionPlace place;
    place.number = item.number;
    place.place = tiles.frame().geodetic_from_world({at.x(), at.y(), up});
    place.ground_ellipsoid_m =
        tiles.frame().geodetic_from_world({at.x(), at.y(), ground}).alt_ellipsoid_m;
    place.height_agl_m = up - ground;
    place.height_above_home_m = up - setup.mission.home_world_m.z();
    place.reached_s = reporter.end_of_item(i);
    if (item.command == MissionCommand::kLoiter || item.command == MissionCommand::kReturn) {
      place.turn_radius_m =
          std::abs(item.radius_m != 0.0 ? item.radius_m : setup.parameters.wp_loiter_rad);
    } else if (item.command == MissionCommand::kWaypoint) {
      const auto next = std::find_if(
          items.begin() + static_cast<std::ptrdiff_t>(i) + 1, items.end(), [](const auto& other) {
            return other.command != MissionCommand::kSetSpeed;
          });
      if (next != items.end()) {
        place.turn_radius_m =
            turn_radius_m(setup, at - before, item, place_of(*next) - at, speed + wind);
      }
    }
    if (place.turn_radius_m) {
      place.turn_bank_deg =
          bank_deg(speed + wind, *place.turn_radius_m, setup.environment.gravity_m_s2);
    }
    report.places.push_back(place);
    before = at;
  }
}

}  // namespace

Result<MissionReport> report_mission(const Scenario& scenario,
                                     const terrain::World& world,
                                     const MissionRequest& request,
                                     const std::atomic<bool>* cancel) {
  const auto* mission = std::get_if<ScenarioMission>(&scenario.flight);
  if (mission == nullptr) {
    return Error{ErrorCode::kInvalidArgument, "flight = another kind: must be a mission"};
  }
  const Result<const CameraSpec*> camera = named_camera(scenario, request.camera);
  if (!camera) return camera.error();
  Result<autopilot::MissionSetup> setup = mission_setup(*mission, world);
  if (!setup) return setup.error().in("flight.mission");
  if (scenario.duration_s) {
    setup->duration_max_s = std::min(*scenario.duration_s, autopilot::kFlightMaxS);
  }
  const terrain::HeightErrors errors;
  const auto preview = autopilot::preview_mission(*setup, world.tiles, cancel);
  if (!preview) return preview.error().in("flight.mission");
  MissionReport report;
  report.end = preview->end;
  report.camera = (*camera)->name;
  report.roll_limit_deg = setup->parameters.roll_limit_deg;
  Reporter reporter(scenario, world, request, **camera, setup->mission, preview->states);
  if (Status status = reporter.run(cancel, report); !status) return status.error();
  add_places(*setup, *world.tiles, reporter, report);
  if (Status read = errors.status(); !read) return read.error();
  add_warnings(request, *setup, report);
  return report;
}

}  // namespace overfly::server
