// Inside terrain only: heights of vertical datums above the ellipsoid.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "terrain/world.hpp"

namespace overfly::terrain {

/// A geoid model, chosen once for a layer.
struct GeoidModel {
  /// The installed PROJ grid in use ("egm96_15.gtx"), which may differ from the requested one;
  /// empty if a constant or the built-in table is used.
  std::string grid;
  std::optional<double> constant_m;
  bool built_in = false;  ///< the coarse table of EGM96 inside the program
};

/// Chooses the model for a datum: its own PROJ grid, else the given constant, else EGM96's grid,
/// else the built-in table. A substitute for the datum's own model is reported in `warnings` with
/// its possible error. Empty for ellipsoidal and unknown heights (the latter with a warning).
/// @param lat_rad,  lon_rad  the layer's centre, for the size of the error
/// @param named  the file's name of an unknown datum; empty if it names none
[[nodiscard]] std::optional<GeoidModel> choose_geoid(VerticalDatum datum,
                                                     std::optional<double> constant_m,
                                                     double lat_rad,
                                                     double lon_rad,
                                                     const std::string& file,
                                                     std::vector<std::string>& warnings,
                                                     const std::string& named = {});

/// Height of the datum's zero above the ellipsoid [m] at points (longitude, latitude) [rad].
[[nodiscard]] Eigen::VectorXd geoid_separation_m(const GeoidModel& model,
                                                 const Eigen::Matrix2Xd& lon_lat_rad);

/// "ellipsoid", "egm96", "egm2008", "navd88", "unknown".
[[nodiscard]] const char* to_string(VerticalDatum datum);

}  // namespace overfly::terrain
