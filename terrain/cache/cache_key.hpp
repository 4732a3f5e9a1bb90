// Inside terrain only: the inputs on which a world's cache depends.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "terrain/world.hpp"

namespace overfly::terrain {

/// Increase whenever the same files would give different tiles or heights, or a cache of before
/// could not be recognised as up to date.
inline constexpr int kCacheVersion = 5;

struct CacheSource {
  std::string file;  ///< relative to the folder that holds the cache
  std::uint64_t size_bytes = 0;
  std::int64_t modified_ns = 0;
  std::string digest;
};

/// The manifest's fields that affect tiles and heights, as text; equal texts mean equal results.
[[nodiscard]] std::string cache_fields(const WorldSpec& spec);

/// All files from which the layers are read (including the sources of virtual rasters, and the
/// side-cars of both), with size and time but without digests. Errors: kNotFound, kUnreadable.
[[nodiscard]] Result<std::vector<CacheSource>> cache_sources(const WorldSpec& spec);

[[nodiscard]] std::filesystem::path source_path(const WorldSpec& spec, const CacheSource& source);

/// Empty if the files are unchanged (same size and time, or else same digest of the whole file);
/// otherwise which file differs, and how.
[[nodiscard]] std::string source_changes(const WorldSpec& spec,
                                         const std::vector<CacheSource>& before,
                                         const std::vector<CacheSource>& now);

}  // namespace overfly::terrain
