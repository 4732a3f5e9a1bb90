// Counts of an estimator's records: the same for a run in flight, its metrics and its replay.
#pragma once

#include <cstdint>
#include <optional>

#include "server/record/estimator_status.hpp"
#include "server/record/run_records.hpp"
#include "server/record/run_rows.hpp"

namespace overfly::engine {

/// Adds one record, in the order of the frames.
/// @param frame_crc32  of the image as it was sent; empty where it is not known
void tally(const EstimateRecord& record,
           std::optional<std::uint32_t> frame_crc32,
           EstimatorStatus& status);

/// All records of one estimator of a run.
[[nodiscard]] EstimatorStatus tally_of(const RunRecords& records,
                                       const EstimatorRecords& estimator);

}  // namespace overfly::engine
