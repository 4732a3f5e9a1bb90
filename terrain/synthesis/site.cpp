#include "terrain/synthesis/site.hpp"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "terrain/place/map_plane.hpp"

namespace overfly::terrain::synthesis {
namespace fs = std::filesystem;

Result<Site> choose_site(double lat_deg, double lon_deg) {
  Site site;
  const int zone = std::min(60, static_cast<int>(std::floor((lon_deg + 180.0) / 6.0)) + 1);
  site.epsg = (lat_deg >= 0.0 ? 32600 : 32700) + zone;
  OGRSpatialReference crs;
  if (crs.importFromEPSG(site.epsg) != OGRERR_NONE) {
    return Error{ErrorCode::kInternal, "PROJ does not know EPSG:" + std::to_string(site.epsg)};
  }
  crs.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  auto transform = CrsTransform::create(wgs84_crs(), crs, "built-in world");
  if (!transform) return transform.error();
  Eigen::Matrix2Xd point(2, 1);
  point << lon_deg, lat_deg;
  if (!(*transform)->apply(point)) {
    return Error{ErrorCode::kInternal, "the world's centre cannot be transformed to its UTM zone"};
  }
  site.middle_x_m = std::round(point(0, 0));
  site.middle_y_m = std::round(point(1, 0));
  return site;
}

Status make_folder_whole(const fs::path& folder,
                         const std::function<Status(const fs::path& part)>& write,
                         const std::function<bool(double)>& progress) {
  std::error_code failed;
  if (fs::exists(folder, failed) &&
      !(fs::is_directory(folder, failed) && fs::is_empty(folder, failed))) {
    return Error{ErrorCode::kConflict,
                 folder.string() + ": exists already and is not an empty folder"};
  }
  const fs::path target = fs::absolute(folder).lexically_normal();
  const fs::path parent = (target.has_filename() ? target : target.parent_path()).parent_path();
  fs::create_directories(parent, failed);
  std::string part = (parent / ".overfly-world-XXXXXX").string();
  if (mkdtemp(part.data()) == nullptr) {
    return Error{ErrorCode::kIo, parent.string() + ": cannot be written to"};
  }
  fs::permissions(part,
                  fs::perms::owner_all | fs::perms::group_read | fs::perms::group_exec |
                      fs::perms::others_read | fs::perms::others_exec,
                  failed);
  Status written = write(part);
  if (written) {
    fs::rename(part, target, failed);
    if (failed) written = Error{ErrorCode::kIo, target.string() + ": " + failed.message()};
  }
  if (!written) fs::remove_all(part, failed);
  if (written && progress) progress(1.0);
  return written;
}

}  // namespace overfly::terrain::synthesis
