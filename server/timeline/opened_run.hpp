// A run folder that was read once, for those who need its timeline and its records.
#pragma once

#include <filesystem>
#include <memory>

#include "core/result.hpp"
#include "server/record/run_manifest.hpp"
#include "server/record/run_records.hpp"
#include "server/timeline/run_timeline.hpp"

namespace overfly::server {

struct OpenedRun {
  std::shared_ptr<RunTimeline> timeline;
  RunManifest manifest;
  RunRecords records;
};

/// Errors: as RunTimeline::open.
[[nodiscard]] Result<OpenedRun> open_run(const std::filesystem::path& folder);

}  // namespace overfly::server
