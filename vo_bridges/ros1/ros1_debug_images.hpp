// The debug images of an estimator, matched to frames.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <mutex>

#include "vo_bridges/ros1/ros1_types.hpp"

namespace overfly::ros1 {

/// Keeps the newest. One that bears its frame's stamp is waited for a little while it is known to
/// come; an estimator that stamps otherwise has its newest image taken. May be used from any
/// thread.
class DebugImages {
 public:
  void deliver(const ImageMessage::ConstPtr& image);
  /// The image of the frame of that stamp, else the newest that was not taken yet, else null.
  [[nodiscard]] ImageMessage::ConstPtr take(std::int64_t stamp_ns);
  /// Forgets what came for earlier frames.
  void forget();

 private:
  [[nodiscard]] bool has(std::int64_t stamp_ns) const;

  std::mutex mutex_;
  std::condition_variable came_;
  ImageMessage::ConstPtr newest_;
  bool comes_in_time_ = true;  ///< the first one is given a chance
};

}  // namespace overfly::ros1
