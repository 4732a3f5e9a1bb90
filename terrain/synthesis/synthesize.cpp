#include "terrain/synthesize.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <string>
#include <thread>

#include "core/motion/pose.hpp"
#include "terrain/place/map_plane.hpp"
#include "terrain/synthesis/site.hpp"
#include "terrain/synthesis/world_files.hpp"
#include "terrain/world.hpp"

namespace overfly::terrain {
namespace fs = std::filesystem;
namespace {

/// Increase whenever the landscape changes, so that earlier cached worlds are not used.
constexpr int kLandscapeVersion = 5;
/// Texels per side are a multiple of this, so that all overviews are exact.
constexpr int kSideStepPx = 32;

Status check(const SynthesisOptions& options) {
  const auto outside = [](const char* name, double value, const std::string& limit) {
    return Error{ErrorCode::kInvalidArgument,
                 std::string(name) + " = " + std::to_string(value) + ": must be in " + limit};
  };
  if (!(options.size_m >= 500.0 && options.size_m <= 10000.0)) {
    return outside("size_m", options.size_m, "[500, 10000]");
  }
  if (!(options.texel_m >= 0.1 && options.texel_m <= 5.0)) {
    return outside("texel_m", options.texel_m, "[0.1, 5]");
  }
  if (!(options.relief_m >= 0.0 && options.relief_m <= 400.0)) {
    return outside("relief_m", options.relief_m, "[0, 400]");
  }
  const double lat_deg = deg_from_rad(options.center_lat_rad);
  const double lon_deg = deg_from_rad(options.center_lon_rad);
  if (!(std::abs(lat_deg) <= 80.0)) {
    return outside("center_lat_deg", lat_deg, "[-80, 80], where UTM reaches");
  }
  if (!(std::abs(lon_deg) <= 180.0)) return outside("center_lon_deg", lon_deg, "[-180, 180]");
  return {};
}

Result<WorldSpec::Runway> runway_of(const synthesis::Landscape& land, const synthesis::Site& site) {
  const synthesis::Point threshold = land.airfield.to_xy(-land.airfield.half_length_m(), 0.0F);
  const synthesis::Point ahead = land.airfield.to_xy(land.airfield.half_length_m(), 0.0F);
  OGRSpatialReference crs;
  crs.importFromEPSG(site.epsg);
  crs.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  auto transform = CrsTransform::create(crs, wgs84_crs(), "built-in world");
  if (!transform) return transform.error();
  Eigen::Matrix2Xd points(2, 2);
  points << site.middle_x_m + threshold.x, site.middle_x_m + ahead.x, site.middle_y_m + threshold.y,
      site.middle_y_m + ahead.y;
  if (!(*transform)->apply(points))
    return Error{ErrorCode::kInternal, "runway: cannot be transformed to WGS84"};
  points *= rad_from_deg(1.0);
  // Grid north is not true north: the heading is the direction of the far end as seen from the
  // threshold.
  const LocalFrame frame(Geodetic{points(1, 0), points(0, 0), site.base_height_m});
  const Eigen::Vector3d far =
      frame.world_from_geodetic({points(1, 1), points(0, 1), site.base_height_m});
  double heading_rad = std::atan2(far.x(), far.y());
  if (heading_rad < 0.0) heading_rad += 2.0 * kPi;
  return WorldSpec::Runway{points(1, 0), points(0, 0), heading_rad};
}

Status write_world(const fs::path& folder,
                   const SynthesisOptions& options,
                   const Progress& progress) {
  const bool somewhere = options.center_lat_rad != 0.0 || options.center_lon_rad != 0.0;
  auto site = somewhere ? synthesis::choose_site(deg_from_rad(options.center_lat_rad),
                                                 deg_from_rad(options.center_lon_rad))
                        : synthesis::choose_site();
  if (!site) return site.error();
  const int steps =
      static_cast<int>(std::ceil(options.size_m / options.texel_m / kSideStepPx - 1e-9));
  const int side_px = steps * kSideStepPx;
  synthesis::LandscapeOptions plan;
  plan.seed = static_cast<std::uint32_t>(options.seed ^ (options.seed >> 32U));
  plan.half_m = static_cast<float>(0.5 * side_px * options.texel_m);
  plan.relief_m = static_cast<float>(options.relief_m);
  if (progress && !progress(0.0)) return Error{ErrorCode::kCancelled, "synthesis was cancelled"};
  const synthesis::Landscape land = synthesis::Landscape::plan(plan);
  Status heights = synthesis::write_heights(folder / "elevation.tif", land, *site);
  if (!heights) return heights;
  Status imagery = synthesis::write_imagery(
      folder / "imagery.tif", land, *site, options.texel_m, side_px, progress);
  if (!imagery) return imagery;
  auto runway = runway_of(land, *site);
  if (!runway) return runway.error();

  WorldSpec spec;
  const std::string credit = "Overfly built-in world, synthesised";
  spec.name = "Built-in airfield, seed " + std::to_string(options.seed);
  spec.imagery.push_back({folder / "imagery.tif", credit, {}});
  ElevationLayer elevation;
  elevation.file = folder / "elevation.tif";
  elevation.datum = VerticalDatum::kEllipsoid;
  elevation.attribution = credit;
  spec.elevation.push_back(elevation);
  spec.runway = *runway;
  return write_world_manifest(folder / "world.json", spec);
}

fs::path cache_folder() {
  const auto variable = [](const char* name) {
    const char* value = std::getenv(name);
    return value != nullptr && *value != '\0' ? fs::path(value) : fs::path();
  };
  if (fs::path own = variable("OVERFLY_CACHE"); !own.empty()) return own;
  if (const fs::path xdg = variable("XDG_CACHE_HOME"); !xdg.empty()) return xdg / "overfly";
  if (const fs::path home = variable("HOME"); !home.empty()) return home / ".cache" / "overfly";
  std::error_code none;
  const fs::path temporary = fs::temp_directory_path(none);
  return (none ? fs::path("/tmp") : temporary) / "overfly-cache";
}

/// A lock between processes, held while the object lives.
class FileLock {
 public:
  explicit FileLock(const fs::path& file)
      : descriptor_(open(file.c_str(), O_CREAT | O_RDWR | O_CLOEXEC, 0644)) {}
  ~FileLock() {
    if (descriptor_ >= 0) close(descriptor_);
  }
  FileLock(const FileLock&) = delete;
  FileLock& operator=(const FileLock&) = delete;
  [[nodiscard]] bool usable() const { return descriptor_ >= 0; }
  /// Locks if no other process does. True too where the file system knows no locks.
  [[nodiscard]] bool try_lock() const {
    return flock(descriptor_, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK;
  }

 private:
  int descriptor_;
};

}  // namespace

Status synthesize_world(const fs::path& folder,
                        const SynthesisOptions& options,
                        const Progress& progress) {
  Status sane = check(options);
  if (!sane) return sane;
  return synthesis::make_folder_whole(
      folder, [&](const fs::path& part) { return write_world(part, options, progress); }, progress);
}

Status ensure_world(const fs::path& folder,
                    const SynthesisOptions& options,
                    const Progress& progress) {
  std::error_code failed;
  if (fs::exists(folder / "world.json", failed)) return {};
  const fs::path parent = fs::absolute(folder).lexically_normal().parent_path();
  fs::create_directories(parent, failed);
  std::string lock_name = folder.filename().string();
  lock_name.insert(0, 1, '.').append(".lock");
  const FileLock lock(parent / lock_name);
  if (!lock.usable()) {
    return Error{ErrorCode::kIo, parent.string() + ": cannot be written to"};
  }
  while (!lock.try_lock()) {
    // Another process is making it; its folder appears when it is complete.
    if (progress && !progress(0.0)) return Error{ErrorCode::kCancelled, "synthesis was cancelled"};
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
  if (fs::exists(folder / "world.json", failed)) return {};
  Status made = synthesize_world(folder, options, progress);
  // Without locks, another process may have been faster.
  if (!made && made.error().code != ErrorCode::kCancelled &&
      fs::exists(folder / "world.json", failed)) {
    return {};
  }
  return made;
}

fs::path builtin_world_folder(std::uint64_t seed) {
  return cache_folder() / "worlds" /
         ("airfield-v" + std::to_string(kLandscapeVersion) + "-seed" + std::to_string(seed));
}

Result<fs::path> builtin_world(std::uint64_t seed, const Progress& progress) {
  const fs::path folder = builtin_world_folder(seed);
  SynthesisOptions options;
  options.seed = seed;
  const Status there = ensure_world(folder, options, progress);
  if (!there) return there.error();
  return folder;
}

}  // namespace overfly::terrain
