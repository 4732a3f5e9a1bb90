// Source of an export: the scenario of a run, or a scenario that was never flown.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "server/camera/frame_maker.hpp"
#include "server/record/run_rows.hpp"
#include "server/scenario/scenario.hpp"

namespace overfly::engine {

/// The record of a run, against which rendered frames are checked.
struct RecordedRun {
  std::filesystem::path folder;
  std::vector<FrameRecord> frames;
  std::vector<std::pair<std::string, std::string>> world_digests;  ///< file, digest
};

struct ExportSource {
  Scenario scenario;
  std::optional<RecordedRun> run;
  std::int64_t epoch_utc_ns = 0;  ///< Unix time of t = 0
};

/// Opens a run folder (one with a manifest.json) or a scenario file.
/// @param overrides  for a scenario file; not allowed for a run
/// Errors: kNotFound; as read_run_records and load_scenario; kInvalidArgument for overrides of a
/// run.
[[nodiscard]] Result<ExportSource> open_export_source(const std::filesystem::path& path,
                                                      const std::vector<Override>& overrides = {});

/// Checks that the world is the one used by the run.
/// Errors: kConflict naming the file whose content differs.
[[nodiscard]] Status check_world(const ExportSource& source, const terrain::World& world);
/// Checks that a frame was rendered from the recorded pose of the camera.
/// Errors: kConflict naming frame and distance.
[[nodiscard]] Status check_frame(const FrameRecord& recorded, const MadeFrame& made);

}  // namespace overfly::engine
