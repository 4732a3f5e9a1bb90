// overfly render: one image of the nadir camera.
#include <CLI/CLI.hpp>
#include <cmath>
#include <iostream>
#include <memory>
#include <string>

#include "renderer/renderer.hpp"
#include "server/app/commands.hpp"
#include "server/app/exit_code.hpp"
#include "server/app/world_argument.hpp"
#include "terrain/image_file.hpp"

namespace overfly::app {
namespace {

struct RenderArguments {
  std::string world;
  double lat_deg = 0.0;
  double lon_deg = 0.0;
  double height_agl_m = 0.0;
  double roll_deg = 0.0;
  double pitch_deg = 0.0;
  double yaw_deg = 0.0;
  int width_px = 1280;
  int height_px = 960;
  double fov_deg = 84.872;
  std::string out;
  std::string depth;
  bool grey = false;
};

/// T_world_camera above a place, its attitude relative to the horizon there.
Pose camera_pose(const RenderArguments& arguments, const terrain::TileSource& tiles) {
  const LocalFrame& frame = tiles.frame();
  // The ground's height is known by east and north, and east and north depend a little on the
  // height: a second pass leaves micrometres.
  Geodetic place =
      geodetic_from_deg(arguments.lat_deg, arguments.lon_deg, frame.origin().alt_ellipsoid_m);
  Eigen::Vector3d p_world = frame.world_from_geodetic(place);
  for (int pass = 0; pass < 2; ++pass) {
    const double up_m = tiles.ground_up_m(p_world.x(), p_world.y());
    const Geodetic ground = frame.geodetic_from_world({p_world.x(), p_world.y(), up_m});
    place.alt_ellipsoid_m = ground.alt_ellipsoid_m + arguments.height_agl_m;
    p_world = frame.world_from_geodetic(place);
  }
  const Eigen::Quaterniond R_enu_body = R_world_body_from({rad_from_deg(arguments.roll_deg),
                                                           rad_from_deg(arguments.pitch_deg),
                                                           rad_from_deg(arguments.yaw_deg)});
  const Eigen::Quaterniond R_world_body = frame.R_world_enu_at(place) * R_enu_body;
  return {R_world_body * R_body_camera_nadir(), p_world};
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
  const auto renderer = renderer::create_egl_renderer(world->tiles);
  if (!renderer) return report(renderer.error());
  const Pose T_world_camera = camera_pose(arguments, *world->tiles);
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
            << 100.0 * frame->void_fraction << " % without imagery\n";
  return kExitOk;
}

}  // namespace

void add_render_command(CLI::App& app, int& exit_code) {
  const auto arguments = std::make_shared<RenderArguments>();
  CLI::App* command = app.add_subcommand("render", "Draw one image of the nadir camera");
  command->add_option("--world", arguments->world, kWorldHelp)->required();
  command->add_option("--lat", arguments->lat_deg, "Latitude [deg]")
      ->required()
      ->check(CLI::Range(-90.0, 90.0));
  command->add_option("--lon", arguments->lon_deg, "Longitude [deg]")
      ->required()
      ->check(CLI::Range(-180.0, 180.0));
  command->add_option("--height-agl", arguments->height_agl_m, "Height above the ground [m]")
      ->required()
      ->check(CLI::Range(0.1, 100000.0));
  command->add_option("--roll", arguments->roll_deg, "[deg], right wing down > 0");
  command->add_option("--pitch", arguments->pitch_deg, "[deg], nose up > 0");
  command->add_option("--yaw", arguments->yaw_deg, "[deg], clockwise from north");
  command->add_option("--width", arguments->width_px, "[px]")
      ->check(CLI::Range(1, 8192))
      ->capture_default_str();
  command->add_option("--height", arguments->height_px, "[px]")
      ->check(CLI::Range(1, 8192))
      ->capture_default_str();
  command->add_option("--fov", arguments->fov_deg, "Horizontal field of view [deg]")
      ->capture_default_str();
  command->add_option("--out", arguments->out, "PNG file to write")->required();
  command->add_option("--depth", arguments->depth, "TIFF file for the depths [m]");
  command->add_flag("--grey", arguments->grey, "Grey instead of colour");
  command->callback([arguments, &exit_code] { exit_code = render(*arguments); });
}

}  // namespace overfly::app
