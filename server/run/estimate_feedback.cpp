#include "server/run/estimate_feedback.hpp"

#include <algorithm>

namespace overfly::server {
namespace {

/// Frames that an estimator may be behind.
constexpr std::size_t kMostFrames = 1024;

}  // namespace

void EstimateFeedback::add_frame(const FrameRow& row) {
  const std::lock_guard lock(mutex_);
  frames_.push_back({row.frame, row.T_world_camera, row.axis_depth_m});
  if (frames_.size() > kMostFrames) frames_.pop_front();
}

void EstimateFeedback::take(const EstimateRecord& record) {
  const EstimateSample& sample = record.sample;
  PlacedEstimate placed{sample.t_ns, sample.map_id, std::nullopt};
  {
    const std::lock_guard lock(mutex_);
    while (!frames_.empty() && frames_.front().index < sample.frame) frames_.pop_front();
    if (!frames_.empty() && frames_.front().index == sample.frame) {
      placed.T_world_body =
          alignment_.add(sample, frames_.front().T_world_camera, frames_.front().axis_depth_m);
    }
  }
  receiver_->take(placed);
}

}  // namespace overfly::server
