// FlightRun: everything before the first frame.
#include <string>
#include <utility>
#include <vector>

#include "server/run/flight_run.hpp"
#include "server/scenario/document/scenario_light.hpp"
#include "server/worlds/scenario_world.hpp"

namespace overfly::engine {
namespace {

using Json = nlohmann::json;

/// t = 0 of lockstep runs, so that equal runs have equal manifests: 2026-01-01T00:00:00Z.
constexpr std::int64_t kLockstepEpochUtcNs = 1'767'225'600 * kNsPerS;

}  // namespace

Status FlightRun::open_maker() {
  FrameMakerOptions options;
  options.renderer_factory = options_.renderer_factory;
  options.worlds = options_.worlds;
  options.cancel = options_.cancel;
  options.notice = options_.notice;
  options.stages = &stages_;
  options.wait_for_tiles = scenario_.pacing == Pacing::kLockstep;
  Result<std::unique_ptr<FrameMaker>> maker = FrameMaker::open(scenario_, options);
  if (!maker) return maker.error();
  maker_ = std::move(*maker);
  if (options_.world_opened) options_.world_opened(maker_->opened_world());

  const std::optional<std::int64_t> duration_ns = maker_->duration_ns();
  recorder_.set_length(duration_ns.value_or(0), duration_ns ? maker_->frames_total() : 0);
  if (Status status = recorder_.set_cameras(); !status) return status;
  const std::vector<std::string> doubts = maker_->flight_warnings();
  recorder_.manifest()["flight"] = {{"description", maker_->flight_description()},
                                    {"warnings", doubts}};
  for (const std::string& warning : doubts) {
    if (Status status = recorder_.log(0, "warning", warning); !status) return status;
  }
  if (Status status = describe_world(); !status) return status;
  const renderer::RendererInfo info = maker_->renderer().info();
  recorder_.manifest()["renderer"] = {{"backend", info.backend},
                                      {"device", info.device},
                                      {"gl_version", info.gl_version},
                                      {"software", info.software}};
  Json& renderer = recorder_.manifest()["renderer"];
  if (!info.device_note.empty()) renderer["device_note"] = info.device_note;
  if (!info.camera_note.empty()) renderer["camera_note"] = info.camera_note;
  std::string line = "rendered by " + info.backend + ": " + info.device;
  if (!info.camera_note.empty()) line += " (" + info.camera_note + ")";
  return recorder_.log(0, "info", line);
}

Status FlightRun::describe_world() {
  const terrain::World& world = maker_->world();
  recorder_.set_attribution(world.tiles->attribution());
  Json hashes = Json::array();
  for (const auto& [file, digest] : world.data_hashes) {
    hashes.push_back({{"file", file}, {"digest", digest}});
  }
  const Geodetic& origin = world.tiles->frame().origin();
  recorder_.manifest()["world"] = {{"name", world.spec.name},
                                   {"attribution", world.tiles->attribution()},
                                   {"warnings", world.warnings},
                                   {"data_hashes", std::move(hashes)},
                                   {"origin",
                                    {{"lat_deg", deg_from_rad(origin.lat_rad)},
                                     {"lon_deg", deg_from_rad(origin.lon_rad)},
                                     {"alt_ellipsoid_m", origin.alt_ellipsoid_m}}}};
  if (const auto& manifest = maker_->opened_world()->manifest) {
    recorder_.manifest()["world"]["manifest"] = {{"file", manifest->file},
                                                 {"digest", manifest->digest}};
  }
  const Result<WorldDress> dress = world_dress(scenario_, origin);
  if (!dress) return dress.error();
  for (const auto& [field, text] : *dress) {
    recorder_.manifest()["world"][field] = text;
    if (Status status = recorder_.log(0, "info", field + ": " + text); !status) return status;
  }
  for (const std::string& warning : world.warnings) {
    if (Status status = recorder_.log(0, "warning", warning); !status) return status;
  }
  return {};
}

Status FlightRun::describe() {
  const bool wall = scenario_.pacing == Pacing::kRealTime;
  recorder_.manifest()["epoch_utc_ns"] =
      scenario_.epoch_utc_ns.value_or(wall ? utc_now_ns() : kLockstepEpochUtcNs);
  return recorder_.write_manifest();
}

}  // namespace overfly::engine
