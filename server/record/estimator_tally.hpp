// Counts over an estimator's records: the same for a live run, its metrics and its replay.
#pragma once

#include <cstdint>
#include <optional>

#include "server/record/estimator_status.hpp"
#include "server/record/rows/run_rows.hpp"
#include "server/record/run_records.hpp"

namespace overfly::server {

/// Adds one record; records come in frame order.
/// @param frame_crc32  of the image as sent; empty if not known
void tally(const EstimateRecord& record,
           std::optional<std::uint32_t> frame_crc32,
           EstimatorStatus& status);

/// Counts all records of one estimator of a run.
[[nodiscard]] EstimatorStatus tally_of(const RunRecords& records,
                                       const EstimatorRecords& estimator);

}  // namespace overfly::server
