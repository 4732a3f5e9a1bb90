// Downloads public terrain: imagery and elevation of a square, as GeoTIFFs with a manifest.
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
  double elevation_m = 5.0;  ///< spacing of the posts, in [0.5, 500]
  /// Margin of elevation beyond the imagery, in [0, 50000], because banked cameras look far.
  double elevation_margin_m = 1000.0;

  /// `usgs`, or a template of addresses: tiles of Web Mercator with {z} {x} {y} ({-y} counts from
  /// the south; WMTS: {TileMatrix} {TileCol} {TileRow}), or WMS with {bbox} {width} {height}.
  std::string imagery_source = kUsgsSource;
  std::string imagery_attribution;  ///< of a template; required there
  int tile_px = 256;                ///< of a tile template, in [64, 1024]
  int finest_zoom = 19;             ///< of a tile template, in [0, 24]
  /// `usgs` or `none`.
  std::string elevation_source = kUsgsSource;
  std::optional<double> ground_height_m;  ///< ellipsoidal, used without elevation

  /// Image services of The National Map.
  std::string imagery_service =
      "https://imagery.nationalmap.gov/arcgis/rest/services/USGSNAIPImagery/ImageServer";
  std::string elevation_service =
      "https://elevation.nationalmap.gov/arcgis/rest/services/3DEPElevation/ImageServer";

  int chunk_px = 2048;  ///< side of one request, in [64, 8192]; smaller if the service requires it
  int parallel = 2;     ///< simultaneous requests, in [1, 8]
  int attempts = 6;     ///< of one request, in [1, 20]
  double first_wait_s = 1.0;  ///< before the second attempt; doubles, with jitter, up to 60 s
  /// Longest wait requested by a service; beyond it the download gives up.
  double longest_wait_s = 300.0;
  double stall_s = 60.0;      ///< without data before a request counts as failed, >= 1
  int most_requests = 20000;  ///< a larger plan is rejected to protect the service
  bool keep_chunks = false;   ///< keep the chunks next to the result

  /// Errors: kInvalidArgument naming field, value and limit.
  [[nodiscard]] Status validate() const;
};

/// One request that a download makes.
struct DownloadRequest {
  std::string url;
  std::filesystem::path file;  ///< file for its answer, relative to the folder
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
    std::uint64_t disk_bytes = 0;      ///< estimate, for chunks and result together
  };
  std::vector<Layer> layers;
  std::vector<std::string> warnings;
};

/// Asks the services for their limits and lists every request; downloads nothing else. If a service
/// does not answer, its documented limits are used, with a warning.
/// Errors: kInvalidArgument as `validate`, or if a template or a place is not usable.
[[nodiscard]] Result<DownloadPlan> plan_download(const DownloadOptions& options);

/// Called on the caller's thread with the share done in [0, 1]; returning false cancels.
using DownloadProgress = std::function<bool(double share, const std::string& doing)>;

struct DownloadReport {
  std::filesystem::path manifest;
  int fetched = 0;   ///< requests answered now
  int reused = 0;    ///< chunks left by an earlier, interrupted download
  int absent = 0;    ///< tiles that the service does not have
  int repeated = 0;  ///< attempts after the first one
  std::vector<std::string> warnings;
};

/// Downloads the square into `folder`: imagery.tif, elevation.tif, world.json and download.json
/// (the request and its sources). Chunks are verified (size, type, place, every block read) and
/// kept until all are complete, so that an interrupted download resumes where it stopped.
/// Errors: as plan_download; kConflict if the folder holds a download with other options, or
/// another world; kIo for a full disk or an invalid answer of a service, naming the request;
/// kCancelled.
[[nodiscard]] Result<DownloadReport> download_world(const DownloadOptions& options,
                                                    const DownloadProgress& progress = {});

}  // namespace overfly::terrain
