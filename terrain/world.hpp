// Opens a world: a manifest that lists imagery and elevation files, or those files directly.
#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/outside/source_policy.hpp"
#include "terrain/tile_source.hpp"

namespace overfly::terrain {

enum class VerticalDatum { kEllipsoid, kEgm96, kEgm2008, kNavd88, kUnknown };

struct ImageryLayer {
  std::filesystem::path file;
  std::string attribution;
  /// Coordinate reference system if the file names none, as "EPSG:2994".
  std::optional<std::string> crs{};
  /// Texels whose colour bands all have this value are void, regardless of the file.
  std::optional<double> nodata{};
  /// Values shown as 0 and 255, of samples that are not 8 bit; by default from samples of all files
  /// of the same type.
  std::optional<std::array<double, 2>> range{};
};

struct ElevationLayer {
  std::filesystem::path file;
  VerticalDatum datum = VerticalDatum::kUnknown;
  /// Geoid height above the ellipsoid [m], for a datum whose PROJ grid is not installed.
  std::optional<double> geoid_separation_m;
  /// Metres per unit of the raster; by default from the file, else 1.
  std::optional<double> unit_m;
  std::string attribution;
  /// Coordinate reference system if the file names none, as "EPSG:2994".
  std::optional<std::string> crs{};
  /// Value of posts without data; replaces the one declared by the file.
  std::optional<double> nodata{};
};

/// The contents of a world; layers in priority order, the first one wins.
struct WorldSpec {
  std::string name;
  std::vector<ImageryLayer> imagery;
  std::vector<ElevationLayer> elevation;
  /// Ellipsoidal height of flat ground if there is no elevation layer [m].
  std::optional<double> ground_height_m;
  /// Origin of the world frame; by default the imagery's centre on the ground.
  std::optional<Geodetic> origin;
  /// A named place for courses to start: the threshold of the runway's north end, and the
  /// direction of the take-off run, clockwise from north [rad].
  struct Runway {
    double lat_rad = 0.0;
    double lon_rad = 0.0;
    double heading_rad = 0.0;
  };
  std::optional<Runway> runway;
  /// The cache folder of `overfly world build`; empty = none. For a manifest that was read: the
  /// folder next to it, e.g. world.cache for world.json.
  std::filesystem::path cache_folder{};
  /// Files that may be named, here and by the files themselves.
  SourcePolicy sources{};
};

/// Reads a world manifest (JSON, format in docs/WORLDS.md). Relative files are relative to it.
/// @param sources  policy for the manifest and the files that it names; kept in the spec
/// Errors: kNotFound, kUnreadable, kInvalidArgument naming file, field, value and limit; as
/// SourcePolicy::check.
[[nodiscard]] Result<WorldSpec> read_world_manifest(const std::filesystem::path& manifest,
                                                    const SourcePolicy& sources = {});
[[nodiscard]] Status write_world_manifest(const std::filesystem::path& manifest,
                                          const WorldSpec& spec);

/// The folder of a manifest's cache: next to it, with the extension "cache".
[[nodiscard]] std::filesystem::path cache_folder_of(const std::filesystem::path& manifest);

/// An opened world, with warnings about its files.
struct World {
  std::shared_ptr<const TileSource> tiles;
  WorldSpec spec;  ///< with the origin resolved
  /// Each names the file, the assumption and the possible error.
  std::vector<std::string> warnings;
  /// SHA-256 or size-and-time digests of the files, for the run's manifest: (file, digest).
  std::vector<std::pair<std::string, std::string>> data_hashes;
  /// State of its cache, for people: "none", "in use: FOLDER, 120 MB", "stale: REASON".
  std::string cache;
};

/// Checks, before anything is opened, whether a world may consist of these files and coordinate
/// reference systems: their places and kinds, and the form of texts.
/// @param prefix  of the fields in messages, as "world."
/// Errors: as SourcePolicy::check and check_crs_text, each error on its own line; kNotFound if
/// files are absent and nothing else is wrong.
[[nodiscard]] Status check_world_sources(const WorldSpec& spec, const std::string& prefix);

/// Opens the files, or the cache from `build_world` if it is up to date.
/// @param cancelled  polled between parts of the work; true cancels it. May be empty
/// Errors: as check_world_sources; kCancelled; kUnreadable or kInvalidArgument naming the file: no
/// or broken georeference, missing CRS, imagery and elevation that do not overlap, a file that GDAL
/// cannot read.
[[nodiscard]] Result<World> open_world(const WorldSpec& spec,
                                       const std::function<bool()>& cancelled = {});

/// Human-readable summary (extent, resolution, layers, warnings, attribution), one fact a line.
[[nodiscard]] std::string describe(const World& world);

}  // namespace overfly::terrain
