// Run folders: manifest, rows, timings and metrics, as the list of runs, playback and
// `overfly evaluate --run` read them.
//
// The input is a run folder.
#include <cmath>

#include "server/record/rows/rows.hpp"
#include "server/record/run_folder.hpp"
#include "server/record/run_info_file.hpp"
#include "server/scoring/metrics.hpp"
#include "server/timeline/row_alignment.hpp"
#include "server/timeline/run_timeline.hpp"
#include "tests/fuzz/input_folder.hpp"

namespace {

using namespace overfly;
using namespace overfly::server;

/// What the server asks of a run that somebody looks at.
void look_at(const RunTimeline& timeline) {
  (void)timeline.cameras();
  (void)timeline.statuses();
  (void)timeline.frame_at(1'000'000'000);
  for (std::size_t i = 0; i < timeline.estimators().size(); ++i) {
    const auto alignment = RowAlignment::of(timeline, i, "sim3");
    if (!alignment) continue;
    for (const EstimateRow& row : timeline.estimates(i, 0, 100)) (void)alignment->T_world_body(row);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto& folder =
      fuzz::InputFolder::of_process().fill(fuzz::files_in(fuzz::text_of(data, size)));
  (void)read_run_info(folder);
  if (const auto timeline = RunTimeline::open(folder)) look_at(**timeline);
  if (const auto records = read_run_records(folder)) (void)write_derived(folder, *records);
  return 0;
}
