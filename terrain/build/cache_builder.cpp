#include "terrain/build/cache_builder.hpp"

#include <algorithm>
#include <chrono>
#include <system_error>
#include <thread>

#include "core/barrier.hpp"
#include "terrain/cache/chunk_file.hpp"
#include "terrain/floor_div.hpp"

namespace overfly::terrain {
namespace fs = std::filesystem;
namespace {

using Job = CacheBuilder::Job;

/// Tiles adjacent to the imagery contain some of it in their borders.
void add_tile_jobs(const TileGrid& grid, std::vector<Job>& jobs) {
  const auto chunk_of = [](int tile) { return floor_div(tile, kChunkTiles); };
  for (int level = 0; level < grid.levels; ++level) {
    const int last_column = (grid.cols - 1) >> level;
    const int last_row = (grid.rows - 1) >> level;
    for (int row = chunk_of(-1); row <= chunk_of(last_row + 1); ++row) {
      for (int column = chunk_of(-1); column <= chunk_of(last_column + 1); ++column) {
        jobs.push_back({std::nullopt, level, column, row});
      }
    }
  }
}

void add_height_jobs(const PagedHeights& heights, HeightReach reach, std::vector<Job>& jobs) {
  constexpr int kPosts = kBlockPosts * kChunkBlocks;
  for (int level = 0; level < heights.levels(); ++level) {
    for (int row = 0; row * kPosts < heights.rows(level); ++row) {
      for (int column = 0; column * kPosts < heights.columns(level); ++column) {
        jobs.push_back({reach, level, column, row});
      }
    }
  }
}

}  // namespace

CacheBuilder::CacheBuilder(const RasterWorld& world, fs::path folder)
    : world_(world),
      folder_(std::move(folder)),
      chunks_(static_cast<std::size_t>(world.grid().levels)) {
  add_tile_jobs(world.grid(), jobs_);
  for (const HeightReach reach : {HeightReach::kNear, HeightReach::kFar}) {
    const PagedHeights* heights = heights_of(reach);
    if (heights != nullptr) add_height_jobs(*heights, reach, jobs_);
  }
}

const PagedHeights* CacheBuilder::heights_of(HeightReach reach) const {
  if (reach == HeightReach::kNear) return world_.elevation().heights();
  const ElevationModel* far = world_.elevation().far();
  return far != nullptr ? far->heights() : nullptr;
}

fs::path CacheBuilder::path(const Job& job) const {
  return job.heights ? height_chunk_path(folder_, *job.heights, job.level, job.column, job.row)
                     : tile_chunk_path(folder_, job.level, job.column, job.row);
}

bool CacheBuilder::may_have_texels(const TileId& id) const {
  for (int row = id.row - 1; row <= id.row + 1; ++row) {
    for (int col = id.col - 1; col <= id.col + 1; ++col) {
      if (world_.coverage({id.level, col, row}) != TileCoverage::kNone) return true;
    }
  }
  return false;
}

Result<std::vector<Bytes>> CacheBuilder::tiles(const Job& job, bool& any) const {
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

Result<std::vector<Bytes>> CacheBuilder::heights(const Job& job) const {
  const PagedHeights& heights = *heights_of(*job.heights);
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

void CacheBuilder::note(const Job& job) {
  if (job.heights) return;
  const std::lock_guard lock(mutex_);
  chunks_[static_cast<std::size_t>(job.level)].insert({job.column, job.row});
}

Status CacheBuilder::make_one(const Job& job) {
  const fs::path file = path(job);
  if (check_chunk(file)) {
    ++kept_;
    note(job);
    return {};
  }
  bool any = job.heights.has_value();
  auto pieces = job.heights ? heights(job) : tiles(job, any);
  if (!pieces) return pieces.error();
  if (stop_ || !any) return {};
  Status written = write_chunk(file, *pieces);
  if (!written) return written;
  ++made_;
  note(job);
  return {};
}

Status CacheBuilder::make(const BuildProgress& progress) {
  return run([this](const Job& job) { return make_one(job); }, "", progress);
}

Result<int> CacheBuilder::count_damaged(const std::vector<CacheHeader::Chunks>& expected,
                                        const BuildProgress& progress) {
  std::atomic<int> damaged{0};
  const Work look = [&](const Job& job) -> Status {
    const auto level = static_cast<std::size_t>(job.level);
    const bool wanted =
        job.heights.has_value() ||
        (level < expected.size() && expected[level].contains({job.column, job.row}));
    if (wanted && !check_chunk(path(job))) ++damaged;
    return {};
  };
  const Status looked = run(look, "checking, ", progress);
  if (!looked) return looked.error();
  return damaged.load();
}

int CacheBuilder::start_threads(const Work& work, std::vector<std::thread>& threads) {
  const unsigned most = std::max(1U, std::thread::hardware_concurrency());
  threads.reserve(most);
  try {
    while (threads.size() < most) threads.emplace_back([&] { take_jobs(work); });
  } catch (const std::system_error&) {
    // No more threads are available: continue with those that started.
  }
  return static_cast<int>(threads.size());
}

void CacheBuilder::take_jobs(const Work& work) {
  for (std::size_t i = next_++; i < jobs_.size() && !stop_; i = next_++) {
    const Status done = guarded([&] { return work(jobs_[i]); });
    ++done_;
    if (done) continue;
    const std::lock_guard lock(mutex_);
    if (!error_) error_ = done.error();
    stop_ = true;
  }
  const std::lock_guard lock(mutex_);
  ++finished_;
  changed_.notify_all();
}

Status CacheBuilder::report_until_done(int threads,
                                       const std::string& doing,
                                       const BuildProgress& progress) {
  bool cancelled = false;
  std::unique_lock lock(mutex_);
  while (finished_ < threads) {
    changed_.wait_for(lock, std::chrono::milliseconds(100));
    if (!progress || cancelled) continue;
    lock.unlock();
    const std::string all = std::to_string(jobs_.size());
    const double share = static_cast<double>(done_) / static_cast<double>(jobs_.size());
    const bool go_on = progress(share, doing + std::to_string(done_) + " of " + all + " chunks");
    lock.lock();
    if (!go_on) cancelled = stop_ = true;
  }
  if (!cancelled) return {};
  return Error{ErrorCode::kCancelled, "the build was cancelled; the next one resumes it"};
}

Status CacheBuilder::run(const Work& work,
                         const std::string& doing,
                         const BuildProgress& progress) {
  const std::string all = std::to_string(jobs_.size());
  if (progress && !progress(0.0, doing + "0 of " + all + " chunks")) {
    return Error{ErrorCode::kCancelled, "the build was cancelled; the next one resumes it"};
  }
  next_ = 0;
  done_ = 0;
  stop_ = false;
  error_.reset();
  finished_ = 0;
  std::vector<std::thread> threads;
  const int started = start_threads(work, threads);
  if (started == 0) return Error{ErrorCode::kInternal, "no thread can be started"};
  Status reported = report_until_done(started, doing, progress);
  for (std::thread& thread : threads) thread.join();
  if (error_) return *error_;
  return reported;
}

}  // namespace overfly::terrain
