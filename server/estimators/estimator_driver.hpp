// Drives one estimator frame by frame: prepares it, sends frames and checks its answers. Used where
// an estimator flies (estimator_worker.hpp) and where it tracks a recorded data set.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "server/record/rows/rows.hpp"
#include "vo_bridges/pose_intake.hpp"
#include "vo_bridges/vo_port.hpp"

namespace overfly::server {

/// Not thread-safe. An exception of the estimator becomes the error kInternal.
class EstimatorDriver {
 public:
  explicit EstimatorDriver(VoPort& port) : port_(port) {}

  /// Prepares the estimator for a camera. `track` reports a failure.
  /// @param first  as VoPort::prepare's
  void prepare(const VoFrame& first);
  /// Sends a frame. The answer has the frame's index and time, a usable pose or the state LOST, and
  /// only finite counters and timings.
  /// Errors: as VoPort::prepare, if that failed; as VoPort::track; kInternal after too many
  /// consecutive answers without a usable pose.
  [[nodiscard]] Result<VoEstimate> track(const VoFrame& frame, bool debug_wanted);
  /// Notes about invalid poses since the last call.
  [[nodiscard]] std::vector<std::string> take_notes() { return poses_.take_notes(); }
  /// Use since the estimator was ready. If it has ended, the last known use; empty if unknown.
  [[nodiscard]] std::optional<ResourceUse> use();

 private:
  VoPort& port_;
  PoseIntake poses_;
  std::optional<Error> failure_;  ///< of the preparation
  double cpu_to_get_ready_s_ = 0.0;
  std::optional<ResourceUse> last_known_;  ///< since it was ready
};

/// The record of an answered frame, without the image's checksum.
[[nodiscard]] EstimateRecord record_of(const VoEstimate& answer);
/// The record of a frame that got no answer: LOST.
[[nodiscard]] EstimateRecord lost_record(const VoFrame& frame);

}  // namespace overfly::server
