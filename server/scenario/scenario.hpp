// A scenario: what to fly, over which world, with which cameras, estimators and scoring. JSON on
// disk (scenarios/scenario.schema.json), plain values here.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/outside/source_policy.hpp"
#include "core/result.hpp"
#include "core/time.hpp"
#include "flight/dynamics/turbulence.hpp"
#include "flight/flight.hpp"
#include "flight/live/fly_live.hpp"
#include "flight/replay/logged_flight.hpp"
#include "flight/ros/ros_flight.hpp"
#include "flight/sensors/sensor_models.hpp"
#include "server/scenario/camera_spec.hpp"
#include "server/scenario/estimator_spec.hpp"
#include "server/scenario/fault_spec.hpp"
#include "terrain/decoration/detail.hpp"
#include "terrain/decoration/light.hpp"
#include "terrain/world.hpp"

namespace overfly::server {

enum class Pacing {
  kLockstep,  ///< each frame waits for every estimator: nothing dropped, byte-identical results
  /// Frames come at their rate; a busy estimator gets the latest one, drops are counted.
  kRealTime,
};

/// Light on the ground; the sun is given by its direction, or computed for a time.
struct LightSpec {
  terrain::LightOptions options;
  std::optional<std::int64_t> time_unix_ns;
};

struct RendererChoice {
  std::string camera = "auto";  ///< "auto", "egl", "raycast"
  std::string device;           ///< as renderer::RendererOptions::device
  int threads = 0;              ///< of the ray-caster; 0 = automatic

  [[nodiscard]] bool operator==(const RendererChoice&) const = default;
};

struct BuiltinWorld {
  std::uint64_t seed = 1;
};

/// An airframe and the air that it flies in.
struct AirframeChoice {
  std::string name;            ///< one of builtin_airframes(), or empty: the file
  std::filesystem::path file;  ///< an airframe file
  double wind_from_rad = 0.0;  ///< clockwise from north
  double wind_m_s = 0.0;
  std::optional<dynamics::TurbulenceLevel> turbulence;
  std::map<std::string, double> autopilot;  ///< parameters by their names
};

/// Who flies the course, instead of coordinated turns.
struct CourseDynamics {
  AirframeChoice airframe;
  bool terrain_following = true;
};

/// A mission, flown by an airframe.
struct ScenarioMission {
  std::filesystem::path file;  ///< a mission file, or empty: the plan
  std::string plan;            ///< text of a plan of QGroundControl, from the scenario itself
  AirframeChoice airframe;
  double airspeed_m_s = 25.0;
  bool home_at_runway = false;
  /// Where the mission's home lies in the world frame (east, north); else as the file says.
  std::optional<Eigen::Vector2d> home_m;
};

/// The truth that another run recorded.
struct RunFlight {
  std::filesystem::path folder;  ///< of that run
};

/// A pose file or a flight log, which the file's content decides.
struct LoggedFlight {
  std::filesystem::path file;
  bool camera_poses = false;  ///< pose files only
  flight::LogFlightOptions log;
  /// The fields of `log` that were given, for messages: they do not apply to pose files.
  std::vector<std::string> log_fields;
  /// The anchor of log.rebase is the centre of the world's imagery.
  bool rebase_to_imagery = false;
};

[[nodiscard]] const char* to_string(Pacing pacing);  ///< "lockstep", "real_time"

/// A scenario with defaults filled in and angles in radians.
struct Scenario {
  std::string name;
  std::string title;
  std::string description;
  std::uint64_t seed = 1;
  /// Unix time of t = 0; chosen by the run if not given.
  std::optional<std::int64_t> epoch_utc_ns;

  /// The built-in world with a seed, a world manifest, or layers listed in the scenario itself.
  using BuiltinWorld = server::BuiltinWorld;
  std::variant<BuiltinWorld, std::filesystem::path, terrain::WorldSpec> world;

  /// The course, a pose file or flight log, a live vehicle by MAVLink or ROS, a mission, or another
  /// run.
  using LoggedFlight = server::LoggedFlight;
  std::variant<flight::CourseParameters,
               LoggedFlight,
               flight::live::LiveFlight,
               flight::ros_live::RosFlight,
               ScenarioMission,
               RunFlight>
      flight;
  /// Nobody can fly it again.
  [[nodiscard]] bool is_live() const {
    return std::holds_alternative<flight::live::LiveFlight>(flight) ||
           std::holds_alternative<flight::ros_live::RosFlight>(flight);
  }
  /// Index of the estimator whose answers are sent to the live vehicle.
  std::optional<std::size_t> feedback_estimator;
  /// Empty: coordinated turns.
  std::optional<CourseDynamics> course_dynamics;
  /// The course starts at the world's runway, which is known only when the world is open.
  bool start_at_runway = true;
  /// Of the course's first leg; if not given, that of the runway, or else south.
  std::optional<double> course_heading_rad;
  /// The run starts this long after the beginning of the flight.
  std::int64_t start_ns = 0;
  /// Stops the flight early [s], from the start of the run.
  std::optional<double> duration_s;

  /// At least one; the first is the main one.
  std::vector<CameraSpec> cameras{CameraSpec{}};
  [[nodiscard]] const CameraSpec& main_camera() const { return cameras.front(); }
  /// The camera with recorded images; null if there is none.
  [[nodiscard]] const CameraSpec* recorded_camera() const;
  /// Of all cameras: they share their time stamps. With recorded images these are the stamps of
  /// the images, and the rate is nominal.
  FrameRate rate;
  flight::SensorModels sensors;  ///< in addition to the cameras
  /// Frames come with samples of sensors: simulated ones, or those of a vehicle.
  [[nodiscard]] bool has_sensors() const {
    return !sensors.none() || std::holds_alternative<flight::live::LiveFlight>(flight);
  }
  std::vector<FaultSpec> faults;
  std::vector<EstimatorSpec> estimators;
  RendererChoice renderer;
  std::optional<LightSpec> light;  ///< empty = as in the imagery
  /// Synthetic detail finer than the imagery; empty = none.
  std::optional<terrain::DetailOptions> detail;
  Pacing pacing = Pacing::kLockstep;

  bool record_frames = false;    ///< record camera images as frames/NNNNNN.jpg
  double record_debug_hz = 5.0;  ///< record debug images as debug/NAME/NNNNNN.jpg; 0 = none

  /// Files that the scenario may name, directly or through the files it names.
  SourcePolicy sources;

  nlohmann::json resolved;  ///< the document with defaults, overrides and `data` applied
};

/// One override of a scenario document: `--set a.b.0.c=VALUE`.
struct Override {
  std::string path;
  nlohmann::json value;
};

}  // namespace overfly::server
