// overfly render: one image.
#include <CLI/CLI.hpp>
#include <cmath>
#include <iostream>
#include <memory>
#include <string>

#include "core/text/percent.hpp"
#include "renderer/renderer.hpp"
#include "server/app/commands/commands.hpp"
#include "server/app/commands/render_request.hpp"
#include "server/app/commands/world/world_argument.hpp"
#include "server/app/exit_code.hpp"
#include "server/app/output_files.hpp"
#include "terrain/raster/image_file.hpp"

namespace overfly::app {
namespace {

renderer::CameraBackend backend_from(const std::string& text) {
  if (text == "egl") return renderer::CameraBackend::kEgl;
  return text == "raycast" ? renderer::CameraBackend::kRaycast : renderer::CameraBackend::kAuto;
}

int render(const RenderArguments& arguments) {
  const Result<terrain::World> world = open_world_argument(arguments.world);
  if (!world) return report(world.error());
  for (const std::string& warning : world->warnings) std::cerr << "warning: " << warning << "\n";
  const Result<PinholeCamera> camera = PinholeCamera::from_fov(arguments.width_px,
                                                               arguments.height_px,
                                                               rad_from_deg(arguments.fov_deg),
                                                               FovAxis::kHorizontal);
  if (!camera) return report(camera.error());
  renderer::RendererOptions options;
  options.camera_backend = backend_from(arguments.renderer);
  const auto renderer = renderer::create_renderer(world->tiles, options);
  if (!renderer) return report(renderer.error());
  const Pose mount{R_body_camera_nadir(), Eigen::Vector3d::Zero()};
  const Pose T_world_camera = body_pose(arguments, *world->tiles) * mount;
  const auto format = arguments.grey ? renderer::PixelFormat::kGrey8 : renderer::PixelFormat::kRgb8;
  const auto frame = (*renderer)->render_camera(*camera, T_world_camera, 0, format);
  if (!frame) return report(frame.error());
  if (Status status = terrain::write_png(arguments.out, frame->image); !status) {
    return report(status.error());
  }
  if (!arguments.depth.empty()) {
    const auto depth = (*renderer)->render_depth(*camera, T_world_camera);
    if (!depth) return report(depth.error());
    if (Status status = terrain::write_geotiff_depth(arguments.depth, *depth); !status) {
      return report(status.error());
    }
  }
  std::cout << arguments.out << ": " << arguments.width_px << " x " << arguments.height_px
            << " px, texels per pixel " << frame->texels_per_pixel_median << " (median), "
            << percent_text(frame->void_fraction) << " without imagery\n";
  return kExitOk;
}

/// Reports missing or conflicting options.
Status check(const RenderArguments& arguments) {
  const bool place = arguments.lat_deg && arguments.lon_deg && arguments.height_agl_m;
  if (arguments.has_place() && !place) {
    return Error{ErrorCode::kInvalidArgument,
                 "--lat, --lon and --height-agl: must be given together"};
  }
  if (arguments.world.empty() == arguments.scenario.empty()) {
    return Error{ErrorCode::kInvalidArgument, "one of --world and --scenario must be given"};
  }
  if (!arguments.world.empty() && !place) {
    return Error{ErrorCode::kInvalidArgument,
                 "--lat, --lon and --height-agl: must be given with --world"};
  }
  return check_outputs({{"--out", arguments.out}, {"--depth", arguments.depth}},
                       {{"--scenario", arguments.scenario}, {"--world", arguments.world}});
}

void add_picture_options(CLI::App& command, RenderArguments& arguments) {
  command.add_option("--width", arguments.width_px, "Image width [px], with --world")
      ->check(CLI::Range(1, 8192))
      ->capture_default_str();
  command.add_option("--height", arguments.height_px, "Image height [px], with --world")
      ->check(CLI::Range(1, 8192))
      ->capture_default_str();
  command.add_option("--fov", arguments.fov_deg, "Horizontal field of view [deg], with --world")
      ->capture_default_str();
  command.add_option("--renderer", arguments.renderer, "Renderer of the image")
      ->check(CLI::IsMember({"auto", "egl", "raycast"}))
      ->capture_default_str();
  command.add_option("--out", arguments.out, "PNG file to write")->required();
  command.add_option("--depth", arguments.depth, "TIFF file for the depths [m]");
  command.add_flag("--grey", arguments.grey, "Grey instead of colour, with --world");
}

int render_checked(const RenderArguments& arguments) {
  if (Status status = check(arguments); !status) return report(status.error());
  return arguments.scenario.empty() ? render(arguments) : render_scenario(arguments);
}

}  // namespace

Pose body_pose(const RenderArguments& arguments, const terrain::TileSource& tiles) {
  const LocalFrame& frame = tiles.frame();
  // The ground's height is a function of east and north, which depend slightly on the height; after
  // a second pass the error is in micrometres.
  Geodetic place =
      geodetic_from_deg(*arguments.lat_deg, *arguments.lon_deg, frame.origin().alt_ellipsoid_m);
  Eigen::Vector3d p_world = frame.world_from_geodetic(place);
  for (int pass = 0; pass < 2; ++pass) {
    const double up_m = tiles.ground_up_m(p_world.x(), p_world.y());
    const Geodetic ground = frame.geodetic_from_world({p_world.x(), p_world.y(), up_m});
    place.alt_ellipsoid_m = ground.alt_ellipsoid_m + *arguments.height_agl_m;
    p_world = frame.world_from_geodetic(place);
  }
  const Eigen::Quaterniond R_enu_body = R_world_body_from({rad_from_deg(arguments.roll_deg),
                                                           rad_from_deg(arguments.pitch_deg),
                                                           rad_from_deg(arguments.yaw_deg)});
  const Eigen::Quaterniond R_world_body = frame.R_world_enu_at(place) * R_enu_body;
  return {R_world_body, p_world};
}

void add_render_command(CLI::App& app, int& exit_code) {
  const auto arguments = std::make_shared<RenderArguments>();
  CLI::App* command = app.add_subcommand(
      "render", "Draw one image: of a nadir camera over a world, or of a scenario's camera");
  command->add_option("--world", arguments->world, kWorldHelp);
  command->add_option("--scenario", arguments->scenario, "Scenario file: its world and cameras");
  command->add_option("--set", arguments->sets, "Override a field of the scenario: path=value")
      ->allow_extra_args(false);
  command->add_option("--camera", arguments->camera, "Camera of the scenario; default: its first");
  command->add_option("--frame", arguments->frame, "Frame of the scenario's flight")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  command->add_option("--lat", arguments->lat_deg, "Latitude [deg]")
      ->check(CLI::Range(-90.0, 90.0));
  command->add_option("--lon", arguments->lon_deg, "Longitude [deg]")
      ->check(CLI::Range(-180.0, 180.0));
  command->add_option("--height-agl", arguments->height_agl_m, "Height above the ground [m]")
      ->check(CLI::Range(0.1, 100000.0));
  command->add_option("--roll", arguments->roll_deg, "Roll [deg], right wing down > 0");
  command->add_option("--pitch", arguments->pitch_deg, "Pitch [deg], nose up > 0");
  command->add_option("--yaw", arguments->yaw_deg, "Yaw [deg], clockwise from north");
  add_picture_options(*command, *arguments);
  command->callback([arguments, &exit_code] { exit_code = render_checked(*arguments); });
}

}  // namespace overfly::app
