#include "server/report/figures/map_picture.hpp"

#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "core/cancel.hpp"
#include "server/files/jpeg.hpp"
#include "server/report/plot/markup.hpp"
#include "server/scenario/document/scenario_file.hpp"
#include "server/worlds/scenario_world.hpp"
#include "server/worlds/world_change.hpp"

namespace overfly::server::report {
namespace {

constexpr int kJpegQuality = 80;
/// Half of the earth's circumference.
constexpr double kFarthestM = 2e7;

bool is_on_earth(const GroundExtent& extent) {
  return extent.east_low_m >= -kFarthestM && extent.east_high_m <= kFarthestM &&
         extent.north_low_m >= -kFarthestM && extent.north_high_m <= kFarthestM;
}

Result<std::shared_ptr<const OpenedWorld>> open_world_of(const ReportRun& run,
                                                         const MapOptions& options) {
  if (options.open_world) return options.open_world(run.folder);
  if (run.scenario.is_null()) {
    return Error{ErrorCode::kUnreadable, "the run's scenario cannot be read"};
  }
  const Result<Scenario> scenario = resolve_scenario(run.scenario, {}, run.folder);
  if (!scenario) return scenario.error();
  if (world_must_be_made(*scenario)) {
    return Error{ErrorCode::kNotFound, "the built-in world is not on this machine"};
  }
  Result<OpenedWorld> opened =
      open_scenario_world(*scenario, [&](double) { return !is_cancelled(options.cancel); });
  if (!opened) return opened.error();
  return std::make_shared<const OpenedWorld>(std::move(*opened));
}

Result<std::string> picture_uri(const OpenedWorld& opened,
                                const GroundExtent& extent,
                                int width_px,
                                int height_px,
                                const std::atomic<bool>* cancel) {
  const Result<Image> picture = ground_picture(
      *opened.world.tiles, extent, width_px, height_px, [&] { return is_cancelled(cancel); });
  if (!picture) return picture.error();
  const Result<std::vector<std::uint8_t>> jpeg = encode_jpeg(*picture, kJpegQuality);
  if (!jpeg) return jpeg.error();
  return "data:image/jpeg;base64," + plot::base64(*jpeg);
}

}  // namespace

Result<MapPicture> map_picture(const ReportRun& run,
                               const GroundExtent& extent,
                               int width_px,
                               int height_px,
                               const MapOptions& options) {
  MapPicture map;
  const auto without = [&](const Error& error) -> Result<MapPicture> {
    if (is_cancelled(options.cancel))
      return Error{ErrorCode::kCancelled, "the report was cancelled"};
    map.note = "Without a picture of the ground: " + error.message + ".";
    return map;
  };
  if (!is_on_earth(extent)) {
    return without({ErrorCode::kInvalidArgument, "the tracks span more than the earth"});
  }
  const auto opened = open_world_of(run, options);
  if (!opened) return without(opened.error());
  const OpenedWorld& world = **opened;
  Result<std::string> uri = picture_uri(world, extent, width_px, height_px, options.cancel);
  if (!uri) return without(uri.error());
  map.data_uri = std::move(*uri);
  map.attribution = world.world.tiles->attribution();
  const std::string change = world_change(run.folder, world);
  if (!change.empty()) map.note = change + ".";
  return map;
}

}  // namespace overfly::server::report
