// Inside terrain only: builds the chunks of a world's cache, using all processors.
#pragma once

#include <atomic>
#include <condition_variable>
#include <filesystem>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include "terrain/build_progress.hpp"
#include "terrain/cache/block_codec.hpp"
#include "terrain/world/raster_world.hpp"

namespace overfly::terrain {

class CacheBuilder {
 public:
  /// One chunk of tiles or of heights.
  struct Job {
    std::optional<HeightReach> heights;  ///< empty for tiles
    int level = 0;
    int column = 0;
    int row = 0;
  };

  /// @param world   must outlive the builder
  /// @param folder  of the cache; need not exist
  CacheBuilder(const RasterWorld& world, std::filesystem::path folder);

  /// Makes the chunks that are missing or damaged in the folder. Errors: kIo, kCancelled, those of
  /// reading.
  Status make(const BuildProgress& progress);
  /// Only counts the chunks that are missing or damaged; `expected` are the chunks of tiles per
  /// level.
  Result<int> count_damaged(const std::vector<CacheHeader::Chunks>& expected,
                            const BuildProgress& progress);

  [[nodiscard]] int made() const { return made_; }
  [[nodiscard]] int kept() const { return kept_; }
  /// Chunks of tiles that were made or kept, per level.
  [[nodiscard]] const std::vector<CacheHeader::Chunks>& tile_chunks() const { return chunks_; }

 private:
  using Work = std::function<Status(const Job&)>;
  /// Runs all jobs on all processors; the first error stops it.
  Status run(const Work& work, const std::string& doing, const BuildProgress& progress);
  /// @return how many were started
  int start_threads(const Work& work, std::vector<std::thread>& threads);
  Status report_until_done(int threads, const std::string& doing, const BuildProgress& progress);
  void take_jobs(const Work& work);
  Status make_one(const Job& job);
  Result<std::vector<Bytes>> tiles(const Job& job, bool& any) const;
  Result<std::vector<Bytes>> heights(const Job& job) const;
  /// Null for flat ground, or if there is no coarser grid.
  [[nodiscard]] const PagedHeights* heights_of(HeightReach reach) const;
  [[nodiscard]] bool may_have_texels(const TileId& id) const;
  [[nodiscard]] std::filesystem::path path(const Job& job) const;
  void note(const Job& job);

  const RasterWorld& world_;
  std::filesystem::path folder_;
  std::vector<Job> jobs_;
  std::vector<CacheHeader::Chunks> chunks_;
  std::atomic<std::size_t> next_{0};
  std::atomic<std::size_t> done_{0};
  std::atomic<int> made_{0};
  std::atomic<int> kept_{0};
  std::atomic<bool> stop_{false};
  std::mutex mutex_;
  std::condition_variable changed_;
  int finished_ = 0;  ///< threads
  std::optional<Error> error_;
};

}  // namespace overfly::terrain
