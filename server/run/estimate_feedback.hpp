// Takes an estimator's answers to the vehicle that flies, as soon as they are there.
#pragma once

#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "core/motion/estimate_receiver.hpp"
#include "core/motion/pose.hpp"
#include "server/record/rows/rows.hpp"
#include "server/timeline/live_alignment.hpp"

namespace overfly::server {

/// Places answers in the world by the alignment `init_scale` (LiveAlignment) and passes them on.
/// Thread-safe.
class EstimateFeedback {
 public:
  /// @param T_body_camera  mount of the estimator's camera
  EstimateFeedback(std::shared_ptr<EstimateReceiver> receiver, const Pose& T_body_camera)
      : receiver_(std::move(receiver)), alignment_(T_body_camera) {}

  /// Call it before the frame is given to the estimator.
  void add_frame(const FrameRow& row);
  /// Takes an answer; one of a frame that is not known any more counts as not placed.
  void take(const EstimateRecord& record);
  /// Ends the sending. @return what was sent, and why not more
  [[nodiscard]] std::string finish() {
    receiver_->finish();
    return receiver_->report();
  }

 private:
  const std::shared_ptr<EstimateReceiver> receiver_;
  std::mutex mutex_;
  LiveAlignment alignment_;
  std::vector<FrameRow> frames_;
};

}  // namespace overfly::server
