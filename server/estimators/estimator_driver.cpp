#include "server/estimators/estimator_driver.hpp"

#include <algorithm>
#include <cmath>

#include "core/barrier.hpp"

namespace overfly::server {
namespace {

/// Removes values that a run folder cannot hold: numbers that JSON cannot represent, data of
/// another frame.
void tidy(const VoFrame& frame, VoEstimate& estimate) {
  estimate.sample.frame = frame.index;
  estimate.sample.t_ns = frame.t_ns;
  const auto is_odd = [](const auto& entry) { return !std::isfinite(entry.second); };
  std::erase_if(estimate.counters, is_odd);
  std::erase_if(estimate.timing_ms, is_odd);
}

}  // namespace

void EstimatorDriver::prepare(const VoFrame& first) {
  Status prepared = guarded([&] { return port_.prepare(first); });
  const Status measured = guarded([&]() -> Status {
    if (const auto use = port_.resource_use()) cpu_to_get_ready_s_ = use->cpu_s;
    return {};
  });
  if (prepared && !measured) prepared = measured;
  if (!prepared) failure_ = prepared.error();
}

Result<VoEstimate> EstimatorDriver::track(const VoFrame& frame, bool debug_wanted) {
  Result<VoEstimate> estimate = guarded([&]() -> Result<VoEstimate> {
    if (failure_) return *failure_;
    port_.set_debug(debug_wanted);
    return port_.track(frame);
  });
  if (!estimate) return estimate;
  tidy(frame, *estimate);
  if (Status usable = poses_.take(*estimate); !usable) return usable.error();
  return estimate;
}

std::optional<ResourceUse> EstimatorDriver::use() {
  (void)contained(
      [&] {
        std::optional<ResourceUse> now = port_.resource_use();
        if (!now) return;
        now->cpu_s = std::max(0.0, now->cpu_s - cpu_to_get_ready_s_);
        last_known_ = now;
      },
      [](const char*) {});
  return last_known_;
}

EstimateRecord record_of(const VoEstimate& answer) {
  EstimateRecord record;
  record.sample = answer.sample;
  record.counters = answer.counters;
  return record;
}

EstimateRecord lost_record(const VoFrame& frame) {
  EstimateRecord record;
  record.sample.frame = frame.index;
  record.sample.t_ns = frame.t_ns;
  record.sample.state = TrackingState::kLost;
  return record;
}

}  // namespace overfly::server
