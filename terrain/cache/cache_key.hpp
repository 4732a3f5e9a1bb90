// Inside terrain only: what a world's cache depends on.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "terrain/world.hpp"

namespace overfly::terrain {

/// Raised whenever tiles or heights of the same files would come out differently.
inline constexpr int kCacheVersion = 3;

struct CacheSource {
  std::string file;  ///< relative to the folder that holds the cache
  std::uint64_t size_bytes = 0;
  std::int64_t modified_ns = 0;
  std::string digest;
};

/// The manifest's fields that decide tiles and heights, as text: equal texts, equal meaning.
[[nodiscard]] std::string cache_fields(const WorldSpec& spec);

/// All files the layers are read from (side-cars and the sources of virtual rasters included),
/// with size and time but without digests. Errors: kNotFound, kUnreadable.
[[nodiscard]] Result<std::vector<CacheSource>> cache_sources(const WorldSpec& spec);

[[nodiscard]] std::filesystem::path source_path(const WorldSpec& spec, const CacheSource& source);

/// Empty if the files are those of before (same size and time, else same digest), else what is
/// different about which file.
[[nodiscard]] std::string source_changes(const WorldSpec& spec,
                                         const std::vector<CacheSource>& before,
                                         const std::vector<CacheSource>& now);

}  // namespace overfly::terrain
