// Arguments of `overfly render`.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/motion/pose.hpp"
#include "core/result.hpp"
#include "terrain/tile_source.hpp"

namespace overfly::app {

struct RenderArguments {
  std::string world;
  std::string scenario;
  std::vector<std::string> sets;
  std::string camera;      ///< of the scenario; empty = the first
  std::int64_t frame = 0;  ///< of the scenario's flight
  std::optional<double> lat_deg;
  std::optional<double> lon_deg;
  std::optional<double> height_agl_m;
  double roll_deg = 0.0;
  double pitch_deg = 0.0;
  double yaw_deg = 0.0;
  int width_px = 1280;
  int height_px = 960;
  double fov_deg = 84.872;
  std::string renderer = "auto";
  std::string out;
  std::string depth;
  bool grey = false;

  /// True if a place is given instead of a frame of the flight.
  [[nodiscard]] bool has_place() const { return lat_deg || lon_deg || height_agl_m; }
};

/// T_world_body above the place; its attitude is relative to the local horizon.
/// @pre latitude, longitude and height are given
[[nodiscard]] Pose body_pose(const RenderArguments& arguments, const terrain::TileSource& tiles);

/// Draws an image with a camera of the scenario, at a frame of its flight or at the place.
/// @return exit code
[[nodiscard]] int render_scenario(const RenderArguments& arguments);

}  // namespace overfly::app
