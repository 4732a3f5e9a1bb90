// FlightRun: everything before the first frame.
#include <string>
#include <utility>
#include <vector>

#include "server/camera/calibrated_camera.hpp"
#include "server/record/run_folder.hpp"
#include "server/run/flight_run.hpp"
#include "server/scenario/document/scenario_light.hpp"
#include "server/worlds/scenario_world.hpp"

namespace overfly::server {
namespace {

/// t = 0 of lockstep runs, so that equal runs have equal manifests: 2026-01-01T00:00:00Z.
constexpr std::int64_t kLockstepEpochUtcNs = 1'767'225'600 * kNsPerS;

}  // namespace

Status FlightRun::calibrate_cameras() {
  calibrated_.resize(scenario_.cameras.size());
  for (std::size_t i = 0; i < calibrated_.size(); ++i) {
    const CameraSpec& camera = scenario_.cameras[i];
    if (!camera.calibrated) continue;
    auto made = stages_.measure("calibrate_cameras", [&] {
      return calibrate_camera(camera, scenario_.seed, {options_.notice, options_.cancel});
    });
    if (!made) return made.error();
    calibrated_[i] = *made;
    Status logged = recorder_.log(0,
                                  "info",
                                  "camera " + camera.name + ", as calibrated: " +
                                      calibrated_words(*calibrated_[i], camera.model));
    if (!logged) return logged;
  }
  return {};
}

const CameraModel& FlightRun::given_model(std::size_t camera) const {
  const std::optional<CalibratedIntrinsics>& calibrated = calibrated_[camera];
  return calibrated ? calibrated->model : scenario_.cameras[camera].model;
}

Status FlightRun::open_maker() {
  FrameMakerOptions options;
  options.renderer_factory = options_.renderer_factory;
  options.worlds = options_.worlds;
  options.cancel = options_.cancel;
  options.notice = options_.notice;
  options.stages = &stages_;
  options.truth_samples = &recorder_.truth_samples();
  options.sensing_from_utc_ns = epoch_utc_ns();
  options.vehicle_log = vehicle_log_file(options_.folder);
  options.wait_for_tiles = scenario_.pacing == Pacing::kLockstep;
  if (options_.frame_cache && options.wait_for_tiles && !scenario_.is_live()) {
    frame_cache_ = std::make_unique<FrameCache>(*options_.frame_cache, options_.warn);
    options.frame_cache = frame_cache_.get();
  }
  Result<std::unique_ptr<FrameMaker>> maker = FrameMaker::open(scenario_, options);
  if (!maker) return maker.error();
  maker_ = std::move(*maker);
  if (options_.world_opened) options_.world_opened(maker_->opened_world());

  const std::optional<std::int64_t> duration_ns = maker_->duration_ns();
  recorder_.set_length(duration_ns.value_or(0), duration_ns ? maker_->frames_total() : 0);
  if (Status status = recorder_.set_cameras(calibrated_); !status) return status;
  std::vector<std::string> doubts;
  for (const std::string& warning : maker_->image_warnings()) {
    doubts.push_back("images: " + warning);
  }
  const std::vector<std::string> of_flight = maker_->flight_warnings();
  doubts.insert(doubts.end(), of_flight.begin(), of_flight.end());
  recorder_.manifest().flight =
      RunManifest::Flight{maker_->flight_description(), doubts, maker_->log_start_ns()};
  for (const std::string& warning : doubts) {
    if (Status status = recorder_.log(0, "warning", warning); !status) return status;
  }
  if (Status status = describe_world(); !status) return status;
  const renderer::RendererInfo info = maker_->renderer().info();
  recorder_.manifest().renderer = RunManifest::Renderer{info.backend,
                                                        info.device,
                                                        info.gl_version,
                                                        info.software,
                                                        info.device_note,
                                                        info.camera_note};
  std::string line = "rendered by " + info.backend + ": " + info.device;
  if (!info.camera_note.empty()) line += " (" + info.camera_note + ")";
  return recorder_.log(0, "info", line);
}

Status FlightRun::describe_world() {
  const terrain::World& world = maker_->world();
  const Geodetic& origin = world.tiles->frame().origin();
  RunManifest::World& described = recorder_.manifest().world.emplace();
  described.name = world.spec.name;
  described.attribution = world.tiles->attribution();
  described.warnings = world.warnings;
  described.origin = origin;
  for (const auto& [file, digest] : world.data_hashes) {
    described.data_hashes.push_back({file, digest});
  }
  if (const auto& manifest = maker_->opened_world()->manifest) {
    described.manifest = RunManifest::WorldFile{manifest->file, manifest->digest};
  }
  const Result<WorldDress> dress = world_dress(scenario_, origin);
  if (!dress) return dress.error();
  for (const auto& [field, text] : *dress) {
    (field == "light" ? described.light : described.detail) = text;
    if (Status status = recorder_.log(0, "info", field + ": " + text); !status) return status;
  }
  for (const std::string& warning : world.warnings) {
    if (Status status = recorder_.log(0, "warning", warning); !status) return status;
  }
  return {};
}

std::int64_t FlightRun::epoch_utc_ns() const {
  const bool wall = scenario_.pacing == Pacing::kRealTime;
  return scenario_.epoch_utc_ns.value_or(wall ? utc_now_ns() : kLockstepEpochUtcNs);
}

Status FlightRun::describe() {
  recorder_.manifest().epoch_utc_ns = epoch_utc_ns();
  return recorder_.write_manifest();
}

}  // namespace overfly::server
