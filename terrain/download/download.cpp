#include "terrain/download.hpp"

#include <algorithm>
#include <condition_variable>
#include <nlohmann/json.hpp>
#include <system_error>
#include <thread>

#include "core/barrier.hpp"
#include "core/motion/pose.hpp"
#include "core/outside/file_text.hpp"
#include "core/outside/outside_json.hpp"
#include "core/text/percent.hpp"
#include "terrain/download/layers.hpp"
#include "terrain/download/merge.hpp"
#include "terrain/world.hpp"

namespace overfly::terrain {
namespace fs = std::filesystem;
using namespace download;

namespace {

constexpr double kFetchShare = 0.8;  // of the progress; the rest is merging

Error cancelled() { return {ErrorCode::kCancelled, "the download was cancelled"}; }

/// Fetches chunks on threads while the caller's thread reports progress.
class Fetching {
 public:
  Fetching(const DownloadOptions& options,
           PoliteFetcher& fetcher,
           std::atomic<bool>& stop,
           const DownloadProgress& progress)
      : options_(options), fetcher_(fetcher), stop_(stop), progress_(progress) {}

  Status run(const std::vector<ChunkLayer>& layers, DownloadReport& report) {
    for (const ChunkLayer& layer : layers) {
      for (const Chunk& chunk : layer.chunks) jobs_.push_back({&layer, &chunk});
    }
    std::vector<std::thread> threads;
    threads.reserve(static_cast<std::size_t>(options_.parallel));
    try {
      for (int i = 0; i < options_.parallel; ++i) threads.emplace_back([this] { work(); });
    } catch (const std::system_error&) {
      // No more threads are available: continue with those that started.
    }
    if (threads.empty()) return Error{ErrorCode::kInternal, "no thread can be started"};
    watch(threads.size());
    for (std::thread& thread : threads) thread.join();
    report.fetched = fetched_;
    report.reused = reused_;
    report.absent = absent_;
    if (error_) return *error_;
    return {};
  }

 private:
  struct Job {
    const ChunkLayer* layer;
    const Chunk* chunk;
  };

  void work() {
    for (;;) {
      const std::size_t i = next_.fetch_add(1);
      if (i >= jobs_.size() || stop_.load()) break;
      const Status done = guarded([&] { return fetch(jobs_[i]); });
      const std::lock_guard lock(mutex_);
      ++finished_;
      if (!done) {
        if (!error_) error_ = done.error();
        stop_.store(true);
      }
      changed_.notify_one();
    }
    const std::lock_guard lock(mutex_);
    ++idle_threads_;
    changed_.notify_one();
  }

  Status fetch(const Job& job) {
    if (chunk_is_there(*job.layer, *job.chunk)) {
      ++reused_;
      return {};
    }
    const auto outcome = fetcher_.get(job.chunk->url, [&](const HttpReply& reply) {
      return judge_chunk(*job.layer, *job.chunk, reply);
    });
    if (!outcome) return outcome.error();
    if (outcome->verdict.kind == Verdict::Kind::kAbsent) {
      ++absent_;
      return {};
    }
    ++fetched_;
    return write_chunk(*job.chunk, outcome->reply);
  }

  /// Reports progress until all threads are done.
  void watch(std::size_t threads) {
    std::unique_lock lock(mutex_);
    constexpr auto kTell = std::chrono::milliseconds(200);
    while (idle_threads_ < threads) {
      changed_.wait_for(lock, kTell);
      if (!progress_) continue;
      const double share = jobs_.empty() ? 1.0 : static_cast<double>(finished_) / jobs_.size();
      const std::string doing =
          "request " + std::to_string(finished_) + " of " + std::to_string(jobs_.size());
      lock.unlock();
      const bool go_on = progress_(kFetchShare * share, doing);
      lock.lock();
      if (!go_on) {
        if (!error_) error_ = cancelled();
        stop_.store(true);
      }
    }
  }

  const DownloadOptions& options_;
  PoliteFetcher& fetcher_;
  std::atomic<bool>& stop_;
  const DownloadProgress& progress_;
  std::vector<Job> jobs_;
  std::atomic<std::size_t> next_{0};
  std::atomic<int> fetched_{0};
  std::atomic<int> reused_{0};
  std::atomic<int> absent_{0};
  std::mutex mutex_;
  std::condition_variable changed_;
  std::size_t finished_ = 0;
  std::size_t idle_threads_ = 0;
  std::optional<Error> error_;
};

/// The inputs that determine the bytes of a download.
nlohmann::json asked(const std::vector<ChunkLayer>& layers) {
  nlohmann::json all = nlohmann::json::array();
  for (const ChunkLayer& layer : layers) {
    all.push_back({{"what", layer.what},
                   {"source", layer.source},
                   {"crs", layer.crs},
                   {"left", layer.left},
                   {"top", layer.top},
                   {"pixel", layer.pixel},
                   {"width_px", layer.width_px},
                   {"height_px", layer.height_px},
                   {"requests", layer.chunks.size()},
                   {"first_request", layer.chunks.empty() ? "" : layer.chunks.front().url}});
  }
  return {{"format_version", 1}, {"layers", all}};
}

/// Why a folder's download is not the one that the layers make.
Error other_download(const fs::path& record, const std::vector<ChunkLayer>& layers) {
  // The requests of the download that is resumed may follow from limits that are not known now.
  for (const ChunkLayer& layer : layers) {
    if (!layer.without_limits) continue;
    return {layer.without_limits->code,
            "the service's limits, by which this download was begun, are not known now: try again "
            "later: " +
                layer.without_limits->message};
  }
  return {ErrorCode::kConflict,
          record.string() +
              ": contains a download with other options; choose another folder, or remove it"};
}

/// Creates the folder, or accepts one that contains an equal, interrupted download.
Status claim_folder(const fs::path& folder, const std::vector<ChunkLayer>& layers) {
  const nlohmann::json wanted = asked(layers);
  std::error_code failed;
  fs::create_directories(folder / "chunks", failed);
  if (failed) return Error{ErrorCode::kIo, folder.string() + ": " + failed.message()};
  const fs::path record = folder / "download.json";
  if (fs::exists(record, failed)) {
    constexpr std::uint64_t kMaxBytes = std::uint64_t{1} << 20U;
    const auto text = read_file_text(record, kMaxBytes);
    const auto found = text ? json_from_outside<nlohmann::json>(*text, record.string())
                            : Result<nlohmann::json>(text.error());
    if (!found) return found.error();
    if (*found == wanted) return {};
    return other_download(record, layers);
  }
  if (fs::exists(folder / "world.json", failed)) {
    return Error{ErrorCode::kConflict,
                 folder.string() + ": contains another world; choose another folder"};
  }
  return write_renamed(record, wanted.dump(2) + '\n');
}

Status check_space(const fs::path& folder, const std::vector<ChunkLayer>& layers) {
  double needed = 0.0;
  for (const ChunkLayer& layer : layers) {
    const double pixels = static_cast<double>(layer.width_px) * layer.height_px;
    needed += pixels * (layer.transfer_bytes_per_px + (layer.heights ? 4.0 : 3.0) * 4.0 / 3.0);
  }
  std::error_code failed;
  const fs::space_info space = fs::space(folder, failed);
  if (failed || static_cast<double>(space.available) >= needed) return {};
  const auto megabytes = [](double bytes) {
    return std::to_string(static_cast<long>(bytes / 1e6));
  };
  return Error{ErrorCode::kIo,
               folder.string() + ": has " + megabytes(static_cast<double>(space.available)) +
                   " MB free, the download needs up to " + megabytes(needed) + " MB"};
}

Status merge_all(const DownloadOptions& options,
                 const std::vector<ChunkLayer>& layers,
                 const DownloadProgress& progress,
                 DownloadReport& report) {
  for (std::size_t i = 0; i < layers.size(); ++i) {
    const ChunkLayer& layer = layers[i];
    const auto merged =
        merge_chunks(layer, options.folder / (layer.what + ".tif"), [&](double share) {
          const double all = (static_cast<double>(i) + share) / static_cast<double>(layers.size());
          return !progress ||
                 progress(kFetchShare + (1.0 - kFetchShare) * all, "merging " + layer.what);
        });
    if (!merged) return merged.error();
    if (merged->void_share >= 1.0) {
      return Error{ErrorCode::kIo, layer.source + ": has no " + layer.what + " in this square"};
    }
    if (merged->void_share > 0.0) {
      report.warnings.push_back(layer.what + ": " + percent_text(merged->void_share) +
                                " of the square has no data");
    }
    if (merged->uniform_chunks > 0) {
      report.warnings.push_back(layer.what + ": " + std::to_string(merged->uniform_chunks) +
                                " of " + std::to_string(layer.chunks.size()) +
                                " chunks are of one colour: the service may have no data there");
    }
  }
  return {};
}

Status write_manifest(const DownloadOptions& options,
                      const std::vector<ChunkLayer>& layers,
                      const fs::path& manifest) {
  WorldSpec spec;
  char name[96];
  std::snprintf(name,
                sizeof(name),
                "%.5f, %.5f, %.3g km",
                deg_from_rad(options.center_lat_rad),
                deg_from_rad(options.center_lon_rad),
                options.size_m / 1000.0);
  spec.name = name;
  spec.ground_height_m = options.ground_height_m;
  for (const ChunkLayer& layer : layers) {
    const fs::path file = options.folder / (layer.what + ".tif");
    if (!layer.heights) {
      ImageryLayer imagery;
      imagery.file = file;
      imagery.attribution = layer.attribution;
      spec.imagery.push_back(std::move(imagery));
      continue;
    }
    ElevationLayer elevation;
    elevation.file = file;
    elevation.datum = VerticalDatum::kNavd88;
    elevation.unit_m = 1.0;
    elevation.attribution = layer.attribution;
    spec.elevation.push_back(std::move(elevation));
  }
  return write_world_manifest(manifest, spec);
}

}  // namespace

Result<DownloadReport> download_world(const DownloadOptions& options,
                                      const DownloadProgress& progress) {
  std::atomic<bool> stop{false};
  PoliteFetcher fetcher(options, stop);
  DownloadReport report;
  if (progress && !progress(0.0, "querying the services")) return cancelled();
  DownloadOptions quick = options;  // limits that cannot be queried now are assumed, with a warning
  quick.attempts = std::min(options.attempts, 2);
  PoliteFetcher asker(quick, stop);
  const auto layers = lay_out_download(options, asker, report.warnings);
  if (!layers) return layers.error();
  const Status claimed = claim_folder(options.folder, *layers);
  if (!claimed) return claimed.error();
  report.manifest = options.folder / "world.json";
  std::error_code failed;
  if (fs::exists(report.manifest, failed)) return report;  // everything exists already

  const Status room = check_space(options.folder, *layers);
  if (!room) return room.error();
  const Status fetched = Fetching(options, fetcher, stop, progress).run(*layers, report);
  if (!fetched) return fetched.error();
  report.repeated = fetcher.repeated();
  const Status merged = merge_all(options, *layers, progress, report);
  if (!merged) return merged.error();
  const Status written = write_manifest(options, *layers, report.manifest);
  if (!written) return written.error();
  if (!options.keep_chunks) fs::remove_all(options.folder / "chunks", failed);
  return report;
}

}  // namespace overfly::terrain
