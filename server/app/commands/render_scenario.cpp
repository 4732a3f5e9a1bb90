// overfly render --scenario: renders an image with a scenario's camera.
#include <iostream>
#include <utility>

#include "core/text/percent.hpp"
#include "server/app/commands/render_request.hpp"
#include "server/app/exit_code.hpp"
#include "server/camera/frame_maker.hpp"
#include "server/scenario/document/scenario_faults.hpp"
#include "server/scenario/document/scenario_file.hpp"
#include "server/scenario/document/scenario_override.hpp"
#include "terrain/raster/image_file.hpp"

namespace overfly::app {
namespace {

/// The scenario, with the renderer that was asked for.
Result<server::Scenario> load_to_render(const RenderArguments& arguments) {
  const auto overrides = server::parse_overrides(arguments.sets);
  if (!overrides) return overrides.error();
  Result<server::Scenario> scenario = server::load_scenario(arguments.scenario, *overrides);
  if (!scenario) return scenario.error();
  if (arguments.renderer != "auto") scenario->renderer.camera = arguments.renderer;
  return scenario;
}

Status write_shot(const RenderArguments& arguments,
                  const server::CameraShot& shot,
                  renderer::Renderer& renderer) {
  Status written = shot.image16.empty() ? terrain::write_png(arguments.out, shot.image)
                                        : terrain::write_png(arguments.out, shot.image16);
  if (!written || arguments.depth.empty()) return written;
  const Result<DepthImage> depth = renderer.render_depth(shot.request);
  if (!depth) return depth.error();
  return terrain::write_geotiff_depth(arguments.depth, *depth);
}

/// The camera at rest above a place, with its lens and sensor.
Result<server::CameraShot> shot_from_place(const RenderArguments& arguments,
                                           std::size_t camera,
                                           const server::Scenario& scenario,
                                           server::FrameMaker& maker) {
  auto unit = server::CameraUnit::create(scenario.cameras[camera], camera, scenario.seed);
  if (!unit) return unit.error();
  AircraftState state;
  state.T_world_body = body_pose(arguments, *maker.world().tiles);
  server::CameraShot shot;
  Result<renderer::CameraRequest> request = (*unit)->request({state}, 0);
  if (!request) return request.error();
  shot.request = std::move(*request);
  Result<renderer::CameraFrame> drawn = maker.renderer().render_camera(shot.request);
  if (!drawn) return drawn.error();
  if (Status status = (*unit)->develop(std::move(*drawn), {}, 0, shot); !status) {
    return status.error();
  }
  return shot;
}

Result<server::CameraShot> take_shot(const RenderArguments& arguments,
                                     std::size_t camera,
                                     const server::Scenario& scenario,
                                     server::FrameMaker& maker) {
  if (arguments.has_place()) return shot_from_place(arguments, camera, scenario, maker);
  if (arguments.frame >= maker.frames_total()) {
    return Error{ErrorCode::kInvalidArgument,
                 "--frame " + std::to_string(arguments.frame) + ": the flight has " +
                     std::to_string(maker.frames_total()) + " frames"};
  }
  auto made = maker.make(arguments.frame);
  if (!made) return made.error();
  if (!*made) {
    return Error{ErrorCode::kInvalidArgument,
                 "--frame " + std::to_string(arguments.frame) + ": the flight ends before it"};
  }
  return std::move((*made)->shots[camera]);
}

}  // namespace

int render_scenario(const RenderArguments& arguments) {
  const Result<server::Scenario> scenario = load_to_render(arguments);
  if (!scenario) return report(scenario.error());
  std::size_t camera = 0;
  if (!arguments.camera.empty()) {
    const auto index = server::camera_index(*scenario, arguments.camera, "--camera");
    if (!index) return report(index.error());
    camera = *index;
  }
  const auto maker = server::FrameMaker::open(*scenario);
  if (!maker) return report(maker.error());
  for (const std::string& warning : (*maker)->world().warnings) {
    std::cerr << "warning: " << warning << "\n";
  }
  const auto shot = take_shot(arguments, camera, *scenario, **maker);
  if (!shot) return report(shot.error());
  if (Status status = write_shot(arguments, *shot, (*maker)->renderer()); !status) {
    return report(status.error());
  }
  std::cout << arguments.out << ": " << shot->image.width_px << " x " << shot->image.height_px
            << " px, texels per pixel " << shot->drawn.texels_per_pixel_median << " (median), "
            << percent_text(shot->drawn.void_fraction) << " without imagery";
  if (shot->setting.exposure_ns > 0) {
    std::cout << ", exposure " << 1e-6 * static_cast<double>(shot->setting.exposure_ns)
              << " ms, gain " << shot->setting.gain << ", " << 100.0 * shot->saturated_fraction
              << " % saturated";
  }
  for (const std::string& fault : shot->faults) std::cout << ", " << fault;
  std::cout << "\n";
  return kExitOk;
}

}  // namespace overfly::app
