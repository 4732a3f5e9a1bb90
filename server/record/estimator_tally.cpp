#include "server/record/estimator_tally.hpp"

namespace overfly::server {

void tally(const EstimateRecord& record,
           std::optional<std::uint32_t> frame_crc32,
           EstimatorStatus& status) {
  // An estimator that has ended answers no frame and drops none.
  if (!status.crash.empty()) return;
  if (record.dropped) {
    ++status.dropped;
    return;
  }
  status.crash = record.crash;
  if (!record.crash.empty()) return;
  status.state = record.sample.state;
  const auto unanswered = record.counters.find("unanswered");
  if (unanswered != record.counters.end() && unanswered->second > 0.0) {
    ++status.unanswered;
  } else {
    ++status.answered;
  }
  if (!record.image_crc32 || !frame_crc32) return;
  ++status.hashes_compared;
  status.hash_mismatches += *record.image_crc32 != *frame_crc32 ? 1 : 0;
}

EstimatorStatus tally_of(const RunRecords& records, const EstimatorRecords& estimator) {
  EstimatorStatus status;
  for (const EstimateRecord& record : estimator.records) {
    const FrameRow* frame = frame_row(records.camera_of(estimator), record.sample.frame);
    tally(record, frame != nullptr ? frame->image_crc32 : std::nullopt, status);
  }
  return status;
}

}  // namespace overfly::server
