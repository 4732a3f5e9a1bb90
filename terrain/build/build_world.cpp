#include "terrain/build_world.hpp"

#include <algorithm>
#include <chrono>

#include "core/measure/sha256.hpp"
#include "terrain/build/cache_builder.hpp"
#include "terrain/cache/chunk_file.hpp"
#include "terrain/cache/world_disk_cache.hpp"
#include "terrain/files/file_digest.hpp"
#include "terrain/world/raster_world.hpp"

namespace overfly::terrain {
namespace fs = std::filesystem;
namespace {

/// Writes the masks of the opened world.
Status write_validity(const RasterWorld& world, const fs::path& folder, CacheHeader& header) {
  for (std::size_t i = 0; i < world.imagery().size(); ++i) {
    const ValidityGrid* validity = world.imagery()[i].validity();
    header.masked.push_back(validity != nullptr);
    if (validity == nullptr) continue;
    const fs::path file = validity_path(folder, static_cast<int>(i));
    Status written = write_chunk(file, {pack_bytes(validity->to_bytes())});
    if (!written) return written;
  }
  return {};
}

Result<std::vector<CacheSource>> digested_sources(const WorldSpec& spec,
                                                  const BuildProgress& progress) {
  auto sources = cache_sources(spec);
  if (!sources) return sources;
  for (CacheSource& source : *sources) {
    if (progress && !progress(0.0, "reading " + source.file)) {
      return Error{ErrorCode::kCancelled, "the build was cancelled"};
    }
    auto digest = file_digest(source_path(spec, source));
    if (!digest) return digest.error();
    source.digest = *digest;
  }
  return sources;
}

constexpr std::size_t kKeyDigits = 16;

/// A name that depends on the fields and on the contents of the files; if these are only sampled,
/// on the times as well.
std::string key_of(const CacheHeader& header) {
  std::string text = header.fields + header.layout;
  for (const CacheSource& source : header.sources) {
    text += source.file + source.digest;
    if (digest_is_sampled(source.digest)) text += std::to_string(source.modified_ns);
  }
  const auto* bytes = reinterpret_cast<const std::uint8_t*>(text.data());
  return sha256_hex({bytes, text.size()}).substr(0, kKeyDigits);
}

/// Calls `take` for each accessible entry at any depth.
template <typename Take>
void for_each_below(const fs::path& folder, const Take& take) {
  std::error_code failed;
  constexpr auto kOptions = fs::directory_options::skip_permission_denied;
  for (fs::recursive_directory_iterator entry(folder, kOptions, failed), end;
       !failed && entry != end;
       entry.increment(failed)) {
    take(*entry);
  }
}

std::uint64_t size_of(const fs::path& folder) {
  std::uint64_t bytes = 0;
  for_each_below(folder, [&](const fs::directory_entry& entry) {
    std::error_code failed;
    if (!entry.is_regular_file(failed)) return;
    const std::uintmax_t size = entry.file_size(failed);
    if (!failed) bytes += size;
  });
  return bytes;
}

/// Removes files that a killed build left incomplete. Recent ones are kept, since another build may
/// be writing them.
void remove_leftovers(const fs::path& folder) {
  const auto now = fs::file_time_type::clock::now();
  std::vector<fs::path> leftovers;
  for_each_below(folder, [&](const fs::directory_entry& entry) {
    if (!entry.path().extension().string().starts_with(".part")) return;
    std::error_code failed;
    const auto written = entry.last_write_time(failed);
    if (!failed && now - written > std::chrono::minutes(10)) leftovers.push_back(entry.path());
  });
  std::error_code failed;
  for (const fs::path& leftover : leftovers) fs::remove(leftover, failed);
}

/// Removes the caches of other states of the files, and nothing else in the folder.
void remove_others(const fs::path& cache, const fs::path& kept) {
  std::error_code failed;
  std::vector<fs::path> others;
  for (fs::directory_iterator entry(cache, failed), end; !failed && entry != end;
       entry.increment(failed)) {
    const std::string name = entry->path().filename().string();
    std::error_code none;
    const bool ours = name.size() == kKeyDigits &&
                      name.find_first_not_of("0123456789abcdef") == std::string::npos &&
                      fs::is_directory(entry->path() / "tiles", none);
    if (ours && name != kept.filename()) others.push_back(entry->path());
  }
  for (const fs::path& other : others) fs::remove_all(other, failed);
}

/// Reports on a valid and complete cache; empty if something must be built.
Result<std::optional<BuildReport>> check_fresh(const WorldSpec& spec,
                                               const World& world,
                                               const BuildProgress& progress) {
  const WorldDiskCache::Found found = WorldDiskCache::find(spec);
  if (!found.cache) return std::optional<BuildReport>();
  const auto& tiles = dynamic_cast<const RasterWorld&>(*world.tiles);
  CacheBuilder builder(tiles, found.cache->folder());
  const auto damaged = builder.count_damaged(found.cache->header().chunks, progress);
  if (!damaged) return damaged.error();
  if (*damaged > 0) return std::optional<BuildReport>();
  BuildReport report;
  report.was_fresh = true;
  report.warnings = world.warnings;
  report.folder = found.cache->folder();
  report.bytes = found.cache->header().bytes;
  return std::optional<BuildReport>(std::move(report));
}

/// The header of an opened world's cache.
Result<CacheHeader> new_header(const WorldSpec& spec,
                               const RasterWorld& tiles,
                               const BuildProgress& progress) {
  CacheHeader header;
  header.fields = cache_fields(spec);
  header.layout = world_fingerprint(tiles.grid(), tiles.imagery(), tiles.elevation());
  auto sources = digested_sources(spec, progress);
  if (!sources) return sources.error();
  header.sources = std::move(*sources);
  header.survey = tiles.elevation().survey_result();
  if (const ElevationModel* far = tiles.elevation().far()) header.far_survey = far->survey_result();
  header.levels = tiles.grid().levels;
  return header;
}

/// Writes all parts, and the header last.
Status fill_cache(const WorldSpec& spec,
                  CacheBuilder& builder,
                  const RasterWorld& tiles,
                  CacheHeader& header,
                  const fs::path& folder,
                  const BuildProgress& progress) {
  Status done = builder.make(progress);
  if (done) done = write_validity(tiles, folder, header);
  if (!done) return done;
  header.chunks = builder.tile_chunks();
  remove_leftovers(folder);
  header.bytes = size_of(folder);
  // The digests must not be used for files that changed while they were read.
  const auto now = cache_sources(spec);
  if (!now) return now.error();
  if (const std::string changes = source_changes(spec, header.sources, *now); !changes.empty()) {
    return Error{ErrorCode::kConflict,
                 changes + " while the world was being built; build it again"};
  }
  return write_header(folder, header);
}

}  // namespace

bool same_layers(const WorldSpec& a, const WorldSpec& b) {
  WorldSpec there = b;
  there.cache_folder = a.cache_folder;
  return cache_fields(a) == cache_fields(there);
}

Result<BuildReport> build_world(const WorldSpec& spec, const BuildProgress& progress) {
  if (spec.cache_folder.empty()) {
    return Error{ErrorCode::kInvalidArgument,
                 "this world has no manifest, next to which its cache would be"};
  }
  if (progress && !progress(0.0, "opening the files")) {
    return Error{ErrorCode::kCancelled, "the build was cancelled"};
  }
  WorldSpec direct = spec;
  direct.cache_folder.clear();
  auto world = open_world(spec);
  if (world && world->cache.starts_with("in use")) {
    auto fresh = check_fresh(spec, *world, progress);
    if (!fresh) return fresh.error();
    if (*fresh) return std::move(**fresh);
  }
  // A damaged or stale cache is not used to build the new one.
  if (!world || world->cache != "none") world = open_world(direct);
  if (!world) return world.error();
  const auto& tiles = dynamic_cast<const RasterWorld&>(*world->tiles);

  auto header = new_header(spec, tiles, progress);
  if (!header) return header.error();
  BuildReport report;
  report.warnings = world->warnings;
  report.folder = spec.cache_folder / key_of(*header);
  CacheBuilder builder(tiles, report.folder);
  const Status filled = fill_cache(spec, builder, tiles, *header, report.folder, progress);
  if (!filled) return filled.error();
  remove_others(spec.cache_folder, report.folder);
  report.bytes = header->bytes;
  report.chunks_made = builder.made();
  report.chunks_kept = builder.kept();
  return report;
}

}  // namespace overfly::terrain
