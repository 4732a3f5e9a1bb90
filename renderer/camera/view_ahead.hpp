// Fetches the ground that a moving camera is about to see.
#pragma once

#include <cstdint>
#include <memory>

#include "renderer/ground/ground_patch.hpp"
#include "renderer/renderer.hpp"
#include "renderer/tiles/tile_store.hpp"

namespace overfly::renderer {

inline constexpr double kAheadS = 3.0;         ///< of flight whose ground is fetched
inline constexpr double kAheadEveryS = 0.375;  ///< of flight between two looks ahead

/// A thread that selects the ground of the views of the next kAheadS along the camera's velocity,
/// each a third wider than the camera's, samples its patches and asks the store for its tiles, at
/// the levels that the views need and one coarser. It changes when things are in memory, never
/// what they are.
class ViewAhead {
 public:
  ViewAhead(std::shared_ptr<TileStore> tiles, std::shared_ptr<GroundPatchStore> patches);
  ~ViewAhead();
  ViewAhead(const ViewAhead&) = delete;
  ViewAhead& operator=(const ViewAhead&) = delete;

  /// Tells of an image that is drawn now; returns at once. Cameras of one time are all followed.
  void expect(const CameraRequest& request);
  /// Waits until the thread has looked ahead for all that it was told.
  void wait_until_idle();
  /// CPU time of the thread so far.
  [[nodiscard]] double cpu_s() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace overfly::renderer
