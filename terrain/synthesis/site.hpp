// Inside synthesis only: location of a synthesised world, and creation of its folder.
#pragma once

#include <filesystem>
#include <functional>

#include "core/result.hpp"

namespace overfly::terrain::synthesis {

inline constexpr double kDefaultLatDeg = 39.35;
inline constexpr double kDefaultLonDeg = -86.03;

/// Where the landscape lies on the earth.
struct Site {
  int epsg = 32616;       ///< a UTM zone on WGS84
  double middle_x_m = 0;  ///< of the landscape, in that CRS
  double middle_y_m = 0;
  double base_height_m = 200.0;  ///< ellipsoidal height of the landscape's zero
};

/// The UTM zone of a place, and the landscape's middle in it. Errors: kInternal.
[[nodiscard]] Result<Site> choose_site(double lat_deg = kDefaultLatDeg,
                                       double lon_deg = kDefaultLonDeg);

/// Fills a new folder: `write` gets a temporary folder, which is renamed if it succeeds and removed
/// otherwise.
/// Errors: kConflict if `folder` exists and is not an empty folder; kIo; those of `write`.
[[nodiscard]] Status make_folder_whole(
    const std::filesystem::path& folder,
    const std::function<Status(const std::filesystem::path& part)>& write,
    const std::function<bool(double)>& progress);

}  // namespace overfly::terrain::synthesis
