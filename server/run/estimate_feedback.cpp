#include "server/run/estimate_feedback.hpp"

#include <algorithm>
#include <iterator>

namespace overfly::server {
namespace {

/// Frames that are kept: an estimator may be behind, and its stamps too.
constexpr std::size_t kMostFrames = 1024;

}  // namespace

void EstimateFeedback::add_frame(const FrameRow& row) {
  const std::lock_guard lock(mutex_);
  frames_.push_back(row);
  // Rarely, so that a frame is not moved with every later one.
  if (frames_.size() < 2 * kMostFrames) return;
  frames_.erase(frames_.begin(), frames_.end() - kMostFrames);
}

void EstimateFeedback::take(const EstimateRecord& record) {
  const EstimateSample& sample = record.sample;
  PlacedEstimate placed{sample.t_ns, sample.map_id, std::nullopt};
  {
    const std::lock_guard lock(mutex_);
    const auto after = std::upper_bound(
        frames_.begin(), frames_.end(), sample.frame, [](std::int64_t frame, const FrameRow& row) {
          return frame < row.frame;
        });
    if (after != frames_.begin() && std::prev(after)->frame == sample.frame) {
      placed.T_world_body = alignment_.add(sample, {frames_.begin(), after});
    }
  }
  receiver_->take(placed);
}

}  // namespace overfly::server
