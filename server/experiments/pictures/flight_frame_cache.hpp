// The frame cache of a series of flights that fly as processes.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace overfly::server::experiments {

/// Name of the cache's folder in the folder of a series.
inline constexpr const char* kFrameCacheFolder = "frame_cache";

struct FlightFrameCache {
  std::filesystem::path folder;
  double budget_gib = 0.0;  ///< 0 = no cache
  /// Beginning of the series: pictures that it has used are not removed for others [Unix time].
  std::int64_t since_ns = 0;
};

/// The options of `overfly run` for one flight.
/// @param adds  other flights probably need its pictures; else the cache is only read
[[nodiscard]] std::vector<std::string> frame_cache_options(const FlightFrameCache& cache,
                                                           bool adds);

/// What the flights of a series took from the cache and gave to it.
struct PictureCount {
  std::uint64_t read = 0;
  std::uint64_t rendered = 0;
  std::string problem;  ///< of the last flight that had one
};

/// Adds what a flight that has ended recorded; nothing if it recorded none.
void count_pictures(const std::filesystem::path& run, PictureCount& count);

}  // namespace overfly::server::experiments
