#include "terrain/build_world.hpp"

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>

#include "terrain/cache/chunk_file.hpp"
#include "terrain/cache/world_cache.hpp"
#include "terrain/file_digest.hpp"
#include "terrain/raster_world.hpp"

namespace overfly::terrain {
namespace fs = std::filesystem;
namespace {

/// One chunk to make.
struct Job {
  bool heights = false;
  int level = 0;
  int column = 0;
  int row = 0;
};

/// Tiles one beyond the imagery have some of it in their borders.
std::vector<Job> tile_jobs(const TileGrid& grid) {
  std::vector<Job> jobs;
  const auto chunk_of = [](int tile) {
    return tile >= 0 ? tile / kChunkTiles : -((-tile + kChunkTiles - 1) / kChunkTiles);
  };
  for (int level = 0; level < grid.levels; ++level) {
    const int last_column = (grid.cols - 1) >> level;
    const int last_row = (grid.rows - 1) >> level;
    for (int row = chunk_of(-1); row <= chunk_of(last_row + 1); ++row) {
      for (int column = chunk_of(-1); column <= chunk_of(last_column + 1); ++column) {
        jobs.push_back({false, level, column, row});
      }
    }
  }
  return jobs;
}

void add_height_jobs(const PagedHeights& heights, std::vector<Job>& jobs) {
  constexpr int kPosts = kBlockPosts * kChunkBlocks;
  for (int level = 0; level < heights.levels(); ++level) {
    for (int row = 0; row * kPosts < heights.rows(level); ++row) {
      for (int column = 0; column * kPosts < heights.columns(level); ++column) {
        jobs.push_back({true, level, column, row});
      }
    }
  }
}

class Builder {
 public:
  Builder(const RasterWorld& world, fs::path folder) : world_(world), folder_(std::move(folder)) {
    jobs_ = tile_jobs(world.grid());
    if (world.elevation().heights() != nullptr) {
      add_height_jobs(*world.elevation().heights(), jobs_);
    }
  }

  /// Does all jobs on all processors. Errors: kIo, kCancelled, those of reading.
  Status run(const BuildProgress& progress);

  [[nodiscard]] int made() const { return made_; }
  [[nodiscard]] int kept() const { return static_cast<int>(jobs_.size()) - made_ - absent_; }
  [[nodiscard]] fs::path path(const Job& job) const {
    return job.heights ? height_chunk_path(folder_, job.level, job.column, job.row)
                       : tile_chunk_path(folder_, job.level, job.column, job.row);
  }
  [[nodiscard]] const std::vector<Job>& jobs() const { return jobs_; }

 private:
  void work();
  Status make(const Job& job);
  Result<std::vector<Bytes>> tiles(const Job& job, bool& any) const;
  Result<std::vector<Bytes>> heights(const Job& job) const;
  [[nodiscard]] bool may_have_texels(const TileId& id) const;

  const RasterWorld& world_;
  fs::path folder_;
  std::vector<Job> jobs_;
  std::atomic<std::size_t> next_{0};
  std::atomic<std::size_t> done_{0};
  std::atomic<int> made_{0};
  std::atomic<int> absent_{0};
  std::atomic<bool> stop_{false};
  std::mutex mutex_;
  std::condition_variable changed_;
  int working_ = 0;
  std::optional<Error> error_;
};

bool Builder::may_have_texels(const TileId& id) const {
  for (int row = id.row - 1; row <= id.row + 1; ++row) {
    for (int col = id.col - 1; col <= id.col + 1; ++col) {
      if (world_.coverage({id.level, col, row}) != TileCoverage::kNone) return true;
    }
  }
  return false;
}

Result<std::vector<Bytes>> Builder::tiles(const Job& job, bool& any) const {
  std::vector<Bytes> pieces(std::size_t{kChunkTiles} * kChunkTiles);
  for (int v = 0; v < kChunkTiles; ++v) {
    for (int u = 0; u < kChunkTiles; ++u) {
      const TileId id{job.level, job.column * kChunkTiles + u, job.row * kChunkTiles + v};
      if (stop_ || !may_have_texels(id)) continue;
      any = true;
      auto tile = world_.tile(id);
      if (!tile) return tile.error();
      pieces[static_cast<std::size_t>(v) * kChunkTiles + u] = pack_tile(*tile);
    }
  }
  return pieces;
}

Result<std::vector<Bytes>> Builder::heights(const Job& job) const {
  const PagedHeights& heights = *world_.elevation().heights();
  std::vector<Bytes> pieces(std::size_t{kChunkBlocks} * kChunkBlocks);
  for (int v = 0; v < kChunkBlocks; ++v) {
    for (int u = 0; u < kChunkBlocks; ++u) {
      const int column = job.column * kChunkBlocks + u;
      const int row = job.row * kChunkBlocks + v;
      if (column * kBlockPosts >= heights.columns(job.level) ||
          row * kBlockPosts >= heights.rows(job.level)) {
        continue;
      }
      auto block = heights.block(job.level, column, row);
      if (!block) return block.error();
      pieces[static_cast<std::size_t>(v) * kChunkBlocks + u] = pack_heights(**block);
    }
  }
  return pieces;
}

Status Builder::make(const Job& job) {
  const fs::path file = path(job);
  std::error_code ignored;
  if (fs::exists(file, ignored)) return {};
  bool any = job.heights;
  auto pieces = job.heights ? heights(job) : tiles(job, any);
  if (!pieces) return pieces.error();
  if (stop_) return {};
  if (!any) {
    ++absent_;
    return {};
  }
  ++made_;
  return write_chunk(file, *pieces);
}

void Builder::work() {
  for (std::size_t i = next_++; i < jobs_.size() && !stop_; i = next_++) {
    const Status made = make(jobs_[i]);
    ++done_;
    if (made) continue;
    const std::lock_guard lock(mutex_);
    if (!error_) error_ = made.error();
    stop_ = true;
  }
  const std::lock_guard lock(mutex_);
  --working_;
  changed_.notify_all();
}

Status Builder::run(const BuildProgress& progress) {
  std::vector<std::thread> threads;
  working_ = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  for (int i = working_; i > 0; --i) threads.emplace_back([this] { work(); });
  bool cancelled = false;
  {
    std::unique_lock lock(mutex_);
    while (working_ > 0) {
      changed_.wait_for(lock, std::chrono::milliseconds(100));
      if (!progress || cancelled) continue;
      lock.unlock();
      const double share = static_cast<double>(done_) / static_cast<double>(jobs_.size());
      const bool go_on = progress(
          share, std::to_string(done_) + " of " + std::to_string(jobs_.size()) + " chunks");
      lock.lock();
      if (!go_on) cancelled = stop_ = true;
    }
  }
  for (std::thread& thread : threads) thread.join();
  if (error_) return *error_;
  if (cancelled) {
    return Error{ErrorCode::kCancelled, "the build was stopped; the next one goes on from there"};
  }
  return {};
}

/// Masks as the opened world knows them.
Status write_validity(const RasterWorld& world, const fs::path& folder, CacheHeader& header) {
  for (std::size_t i = 0; i < world.imagery().size(); ++i) {
    const ValidityGrid* validity = world.imagery()[i].validity();
    header.masked.push_back(validity != nullptr);
    if (validity == nullptr) continue;
    const fs::path file = validity_path(folder, static_cast<int>(i));
    const Status written = write_chunk(file, {pack_bytes(validity->to_bytes())});
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
      return Error{ErrorCode::kCancelled, "the build was stopped"};
    }
    auto digest = file_digest(source_path(spec, source));
    if (!digest) return digest.error();
    source.digest = *digest;
  }
  return sources;
}

/// A name that fields and contents of the files decide.
std::string key_of(const CacheHeader& header) {
  std::string text = header.fields + header.layout;
  for (const CacheSource& source : header.sources) text += source.file + source.digest;
  const auto* bytes = reinterpret_cast<const std::uint8_t*>(text.data());
  return sha256_hex({bytes, text.size()}).substr(0, 16);
}

std::uint64_t size_of(const fs::path& folder) {
  std::uint64_t bytes = 0;
  std::error_code failed;
  for (const auto& entry : fs::recursive_directory_iterator(folder, failed)) {
    if (entry.is_regular_file(failed)) bytes += entry.file_size(failed);
  }
  return bytes;
}

void remove_others(const fs::path& cache, const fs::path& kept) {
  std::error_code failed;
  std::vector<fs::path> others;
  for (const auto& entry : fs::directory_iterator(cache, failed)) {
    if (entry.path().filename() != kept.filename()) others.push_back(entry.path());
  }
  for (const fs::path& other : others) fs::remove_all(other, failed);
}

}  // namespace

bool same_layers(const WorldSpec& a, const WorldSpec& b) {
  WorldSpec there = b;
  there.cache_folder = a.cache_folder;
  return cache_fields(a) == cache_fields(there);
}

Result<BuildReport> build_world(const WorldSpec& spec, const BuildProgress& progress) {
  if (spec.cache_folder.empty()) {
    return Error{ErrorCode::kInvalidArgument, "this world has no manifest to keep a cache beside"};
  }
  BuildReport report;
  WorldSpec direct = spec;
  direct.cache_folder.clear();
  auto kept = open_world(spec);
  if (!kept) return kept.error();
  if (kept->cache.starts_with("in use")) {
    const WorldCache::Found found = WorldCache::find(spec);
    report.was_fresh = true;
    report.warnings = kept->warnings;
    if (found.cache) report.folder = found.cache->folder();
    if (found.cache) report.bytes = found.cache->header().bytes;
    return report;
  }
  const auto world = kept->cache == "none" ? std::move(kept) : open_world(direct);
  if (!world) return world.error();
  const auto& tiles = dynamic_cast<const RasterWorld&>(*world->tiles);
  report.warnings = world->warnings;

  CacheHeader header;
  header.fields = cache_fields(spec);
  header.layout = world_fingerprint(tiles.grid(), tiles.elevation());
  auto sources = digested_sources(spec, progress);
  if (!sources) return sources.error();
  header.sources = std::move(*sources);
  header.survey = tiles.elevation().survey_result();
  report.folder = spec.cache_folder / key_of(header);

  Builder builder(tiles, report.folder);
  Status done = builder.run(progress);
  if (done) done = write_validity(tiles, report.folder, header);
  if (!done) return done.error();
  header.levels = tiles.grid().levels;
  header.chunks.resize(static_cast<std::size_t>(header.levels));
  std::error_code failed;
  for (const Job& job : builder.jobs()) {
    if (job.heights || !fs::exists(builder.path(job), failed)) continue;
    header.chunks[static_cast<std::size_t>(job.level)].insert({job.column, job.row});
  }
  header.bytes = size_of(report.folder);
  // Files that changed while they were read must not be taken for those of the digests.
  const auto now = cache_sources(spec);
  if (!now) return now.error();
  if (const std::string changes = source_changes(spec, header.sources, *now); !changes.empty()) {
    return Error{ErrorCode::kConflict, changes + " while the world was built; build it again"};
  }
  done = write_header(report.folder, header);
  if (!done) return done.error();
  remove_others(spec.cache_folder, report.folder);
  report.bytes = header.bytes;
  report.chunks_made = builder.made();
  report.chunks_kept = builder.kept();
  return report;
}

}  // namespace overfly::terrain
