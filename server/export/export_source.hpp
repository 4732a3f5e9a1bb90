// Source of an export: the scenario of a run, or a scenario that was never flown.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "server/camera/frame_maker.hpp"
#include "server/export/dataset_writer.hpp"
#include "server/record/rows/run_rows.hpp"
#include "server/record/run_manifest.hpp"
#include "server/scenario/scenario.hpp"

namespace overfly::server {

/// The record of a run, against which rendered frames are checked.
struct RecordedRun {
  std::filesystem::path folder;
  std::vector<FrameRow> frames;
  std::vector<std::pair<std::string, std::string>> world_digests;  ///< file, digest
  RunManifest::Flight flight;                                      ///< as in the manifest
  std::vector<PlannedEstimate> estimates;                          ///< of all estimators
  /// Intrinsics that the estimators were given, by camera, where they are not the true ones.
  std::map<std::string, CameraModel> calibrated;
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

/// The flight of the source over its opened world: as recorded, or as the scenario describes it.
/// Errors: as open_flown_truth and create_truth.
[[nodiscard]] Result<std::unique_ptr<TruthSource>> open_truth(const ExportSource& source,
                                                              const terrain::World& world);

/// Checks that the world is the one used by the run.
/// Errors: kConflict naming the file whose content differs.
[[nodiscard]] Status check_world(const ExportSource& source, const terrain::World& world);

}  // namespace overfly::server
