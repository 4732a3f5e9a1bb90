// Public terrain from the web: imagery and elevation of a square, as GeoTIFFs with a manifest.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/result.hpp"

namespace overfly::terrain {

inline constexpr const char* kUsgsSource = "usgs";
inline constexpr const char* kNoSource = "none";

struct DownloadOptions {
  double center_lat_rad = 0.0;
  double center_lon_rad = 0.0;
  double size_m = 4000.0;  ///< side of the square, in [100, 100000]
  std::filesystem::path folder;
  double imagery_m = 0.6;    ///< texel, in [0.05, 100]
  double elevation_m = 5.0;  ///< distance of posts, in [0.5, 500]
  /// Elevation reaches this far beyond the imagery, in [0, 50000]: banked cameras look far.
  double elevation_margin_m = 1000.0;

  /// `usgs`, or a template of addresses: tiles of Web Mercator with {z} {x} {y} ({-y} counts from
  /// the south; WMTS: {TileMatrix} {TileCol} {TileRow}), or WMS with {bbox} {width} {height}.
  std::string imagery_source = kUsgsSource;
  std::string imagery_attribution;  ///< of a template; required there
  int tile_px = 256;                ///< of a tile template, in [64, 1024]
  int finest_zoom = 19;             ///< of a tile template, in [0, 24]
  /// `usgs` or `none`.
  std::string elevation_source = kUsgsSource;
  std::optional<double> ground_height_m;  ///< ellipsoidal, where there is no elevation

  /// Image services of The National Map.
  std::string imagery_service =
      "https://imagery.nationalmap.gov/arcgis/rest/services/USGSNAIPImagery/ImageServer";
  std::string elevation_service =
      "https://elevation.nationalmap.gov/arcgis/rest/services/3DEPElevation/ImageServer";

  int chunk_px = 2048;        ///< side of one request, in [64, 8192]; less if the service says so
  int parallel = 2;           ///< requests at a time, in [1, 8]
  int attempts = 6;           ///< of one request, in [1, 20]
  double first_wait_s = 1.0;  ///< before the second attempt; doubles, with jitter, up to 60 s
  double longest_wait_s = 300.0;  ///< that a service may ask for before the download gives up
  double stall_s = 60.0;          ///< without data before a request counts as failed, >= 1
  int most_requests = 20000;      ///< a plan with more is refused: mind the service
  bool keep_chunks = false;       ///< leave the chunks beside the result

  /// Errors: kInvalidArgument naming field, value and limit.
  [[nodiscard]] Status validate() const;
};

/// One request that a download makes.
struct DownloadRequest {
  std::string url;
  std::filesystem::path file;  ///< where its answer goes, below the folder
  int width_px = 0;
  int height_px = 0;
};

struct DownloadPlan {
  struct Layer {
    std::string what;  ///< "imagery" or "elevation"
    std::string source;
    std::string attribution;
    std::string crs;
    double pixel_m = 0.0;  ///< in the units of the CRS
    int width_px = 0;
    int height_px = 0;
    std::vector<DownloadRequest> requests;
    std::uint64_t transfer_bytes = 0;  ///< estimate
    std::uint64_t disk_bytes = 0;      ///< estimate, chunks and result together
  };
  std::vector<Layer> layers;
  std::vector<std::string> warnings;
};

/// Asks the services for their limits and lists every request; downloads nothing else.
/// A service that cannot be asked is taken at its documented limits, with a warning.
/// Errors: kInvalidArgument as `validate`, or when a template or a place is not usable.
[[nodiscard]] Result<DownloadPlan> plan_download(const DownloadOptions& options);

/// Called on the caller's thread with the done share in [0, 1]; returning false cancels.
using DownloadProgress = std::function<bool(double share, const std::string& doing)>;

struct DownloadReport {
  std::filesystem::path manifest;
  int fetched = 0;   ///< requests answered now
  int reused = 0;    ///< chunks that an earlier, interrupted download had left
  int absent = 0;    ///< tiles that the service does not have
  int repeated = 0;  ///< attempts beyond each first one
  std::vector<std::string> warnings;
};

/// Downloads the square into `folder`: imagery.tif, elevation.tif, world.json and download.json
/// (what was asked, and where). Chunks are verified (size, type, place, every block read) and kept
/// until all are there, so that a download that was cut short goes on where it stopped.
/// Errors: as plan_download; kConflict if the folder holds a download with other options, or
/// another world; kIo for a full disk or a service that does not answer as it should, naming the
/// request; kCancelled.
[[nodiscard]] Result<DownloadReport> download_world(const DownloadOptions& options,
                                                    const DownloadProgress& progress = {});

}  // namespace overfly::terrain
