// Draws frames: casts rays, finds tiles, paints pixels.
#pragma once

#include <list>
#include <memory>
#include <set>
#include <vector>

#include "core/camera/image.hpp"
#include "renderer/raycast/block_builder.hpp"
#include "renderer/raycast/paint/painter.hpp"
#include "renderer/raycast/paint/texel_tiles.hpp"
#include "renderer/raycast/raycast_options.hpp"
#include "renderer/worker_pool.hpp"

namespace overfly::renderer::raycast {

class FrameCaster {
 public:
  FrameCaster(std::shared_ptr<const terrain::TileSource> tiles, const RaycastOptions& options);

  /// Errors: kIo if a tile cannot be read.
  [[nodiscard]] Result<CameraFrame> draw(const CameraRequest& request);
  [[nodiscard]] DepthImage depth(const CameraRequest& request);
  [[nodiscard]] int threads() const { return pool_.threads(); }
  [[nodiscard]] const SampleKernel& kernel() const { return kernel_; }

 private:
  /// Data shared by the steps of drawing one frame.
  struct Frame {
    const CameraRequest& request;
    const RayGrid& rays;
    GroundCaster caster;
    std::map<terrain::TileId, FoundTile> found;
    std::set<terrain::TileId> late;
  };
  const RayGrid& rays_of(const CameraModel& camera);
  Frame begin(const CameraRequest& request);
  /// Computes the blocks of one instant of the exposure, into bands_.
  void cast(const Frame& frame, const ShutterPoses& poses, bool depth_only);
  /// Reads the tiles of the bands that are not in memory.
  void load_tiles(const Frame& frame);
  /// Finds the tiles that the bands need. Errors: kIo.
  Status find_tiles(Frame& frame);
  void paint(const Painter& painter, const Canvas& canvas);
  Status draw_instants(Frame& frame, CameraFrame& drawn);
  void measure(const Frame& frame, CameraFrame& drawn);
  void look_ahead(const Frame& frame);

  std::shared_ptr<const terrain::TileSource> tiles_;
  WorkerPool pool_;
  const SampleKernel& kernel_;
  HeightField field_;
  TexelTiles texels_;
  std::list<RayGrid> rays_;                         // of recently drawn cameras, most recent first
  std::vector<NodeRow> nodes_;                      // by row of nodes
  std::vector<Band> bands_;                         // by row of cells
  std::vector<std::vector<FoundTile>> band_tiles_;  // the tiles found for each band
};

}  // namespace overfly::renderer::raycast
