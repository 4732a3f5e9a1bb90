// Reads ahead the ground that a moving camera is about to see, or that a viewer may look at.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "renderer/ground/ground_patch.hpp"
#include "renderer/ground/view.hpp"
#include "renderer/renderer.hpp"
#include "renderer/tiles/tile_store.hpp"

namespace overfly::renderer {

inline constexpr double kAheadS = 3.0;         ///< flight time ahead whose ground is read
inline constexpr double kAheadEveryS = 0.375;  ///< flight time between two read-aheads

/// A thread that selects the ground of the views of the next kAheadS along the camera's velocity,
/// each a third wider than the camera's, samples its patches and requests its tiles from the store,
/// at the levels that the views need and one coarser. It affects when data is in memory, never its
/// values.
class ViewAhead {
 public:
  ViewAhead(std::shared_ptr<TileStore> tiles, std::shared_ptr<GroundPatchStore> patches);
  ~ViewAhead();
  ViewAhead(const ViewAhead&) = delete;
  ViewAhead& operator=(const ViewAhead&) = delete;

  /// Notifies the thread of an image being drawn; returns at once. Cameras of the same time are all
  /// followed.
  void expect(const CameraRequest& request);
  /// Samples the ground of these views too, when nothing else is to be read ahead, until the
  /// patches fill most of their store. Replaces the views of the last call.
  void expect_later(std::vector<View> views);
  /// Waits until the thread has processed all notifications and views.
  void wait_until_idle();
  /// CPU time of the thread so far.
  [[nodiscard]] double cpu_s() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace overfly::renderer
