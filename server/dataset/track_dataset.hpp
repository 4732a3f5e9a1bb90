// An estimator over a recorded data set, frame by frame, each answered before the next.
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/estimate.hpp"
#include "core/result.hpp"
#include "server/dataset/dataset.hpp"
#include "server/dataset/map_cloud.hpp"
#include "server/record/run_rows.hpp"
#include "server/timing/stage_timer.hpp"
#include "vo_bridges/vo_port.hpp"

namespace overfly::engine {

struct TrackOptions {
  std::filesystem::path debug_folder;  ///< exists; gets NNNNNN.jpg of each frame; empty = none
  bool map_points = false;             ///< gather the sparse map
  const std::atomic<bool>* cancel = nullptr;  ///< stops after the frame at hand
  /// After each frame: how many of how many, and what the estimator said of it.
  std::function<void(std::size_t, std::size_t, TrackingState)> progress;
  std::function<void(const std::string&)> log;  ///< a line that the estimator said
};

struct TrackedDataset {
  std::vector<EstimateRecord> records;  ///< one for each frame that the estimator was given
  MapCloud map;
  DurationList reading;                           ///< of image files, decoding and checksum
  DurationList tracking;                          ///< from giving the frame to having the answer
  std::map<std::string, DurationList> stages;     ///< as the estimator times itself
  std::map<std::string, std::string> parameters;  ///< in force
  std::string type;
  ResourceUse resources;  ///< of the estimator's process; of one in ours: CPU while it tracked
  bool own_process = false;
  std::int64_t unanswered = 0;       ///< frames that a door got no answer to in time
  std::int64_t hash_mismatches = 0;  ///< images that arrived changed
  bool cancelled = false;
};

/// Gives every frame to the estimator. A crash (its record says why) ends the run, and is a result.
/// Errors: as read_frame; kInvalidArgument where the estimator refuses camera or images; kIo.
[[nodiscard]] Result<TrackedDataset> track_dataset(const Dataset& dataset,
                                                   VoPort& port,
                                                   const TrackOptions& options);

/// Why the estimator was gone before it answered a single frame; empty where it ran.
[[nodiscard]] std::string never_ran(const TrackedDataset& tracked);

/// The answers as they are scored.
[[nodiscard]] EstimateTrack track_of(const TrackedDataset& tracked);

/// The map that is scored: that of the most tracked frames, the first of equals; empty where none
/// was tracked.
[[nodiscard]] std::optional<int> scored_map(const TrackedDataset& tracked);

/// Writes the poses of the scored map as TUM, with its first scene depth (`init_scene_depth`).
/// Errors: kIo.
[[nodiscard]] Status write_track(const std::filesystem::path& file, const TrackedDataset& tracked);

/// Writes one line of JSON for each frame, as a run folder's estimates/NAME.jsonl. Errors: kIo.
[[nodiscard]] Status write_statuses(const std::filesystem::path& file,
                                    const TrackedDataset& tracked);

}  // namespace overfly::engine
