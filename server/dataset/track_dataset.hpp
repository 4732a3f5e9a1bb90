// Runs an estimator over a recorded data set; each frame is answered before the next is sent.
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/motion/estimate.hpp"
#include "core/result.hpp"
#include "server/dataset/dataset.hpp"
#include "server/dataset/map_cloud.hpp"
#include "server/record/rows/run_rows.hpp"
#include "server/timing/stage_timer.hpp"
#include "vo_bridges/vo_port.hpp"

namespace overfly::server {

struct TrackOptions {
  std::filesystem::path debug_folder;  ///< must exist; gets NNNNNN.jpg of each frame; empty = none
  bool map_points = false;             ///< collect the sparse map
  const std::atomic<bool>* cancel = nullptr;  ///< stops after the current frame
  /// Called after each frame: frames done, frames in total, and the estimator's state.
  std::function<void(std::size_t, std::size_t, TrackingState)> progress;
  std::function<void(const std::string&)> log;  ///< called with each log line of the estimator
};

struct TrackedDataset {
  std::vector<EstimateRecord> records;  ///< one for each frame that the estimator got
  MapCloud map;
  DurationList reading;                           ///< reading image files: decoding and checksum
  DurationList tracking;                          ///< from sending a frame to its answer
  std::map<std::string, DurationList> stages;     ///< as reported by the estimator
  std::map<std::string, std::string> parameters;  ///< effective values
  std::string type;
  /// Of the estimator's process; for one in this process: CPU time while it tracked.
  ResourceUse resources;
  bool own_process = false;
  std::int64_t unanswered = 0;       ///< frames that got no answer before the timeout
  std::int64_t hash_mismatches = 0;  ///< images that arrived corrupted
  bool cancelled = false;
};

/// Sends every frame to the estimator. A crash ends the run and is a result; the last record gives
/// the reason.
/// Errors: as read_frame; kInvalidArgument if the estimator rejects camera or images; kIo.
[[nodiscard]] Result<TrackedDataset> track_dataset(const Dataset& dataset,
                                                   VoPort& port,
                                                   const TrackOptions& options);

/// The reason why the estimator ended before it answered a single frame; empty if it ran.
[[nodiscard]] std::string never_ran(const TrackedDataset& tracked);

/// The answers in the form used for scoring.
[[nodiscard]] EstimateTrack track_of(const TrackedDataset& tracked);

/// The map that is scored: the one with the most tracked frames, on a tie the first; empty if no
/// frame was tracked.
[[nodiscard]] std::optional<int> scored_map(const TrackedDataset& tracked);

/// Writes the poses of the scored map as TUM, with its first scene depth (`init_scene_depth`).
/// Errors: kIo.
[[nodiscard]] Status write_track(const std::filesystem::path& file, const TrackedDataset& tracked);

/// Writes one JSON line for each frame, in the format of a run folder's estimates/NAME.jsonl.
/// Errors: kIo.
[[nodiscard]] Status write_statuses(const std::filesystem::path& file,
                                    const TrackedDataset& tracked);

}  // namespace overfly::server
