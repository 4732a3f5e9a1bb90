// Fills an image from blocks.
#pragma once

#include <cstdint>
#include <vector>

#include "renderer/raycast/paint/blocks.hpp"
#include "renderer/raycast/paint/colours.hpp"
#include "renderer/raycast/paint/sample.hpp"
#include "renderer/raycast/paint/texel_tiles.hpp"

namespace overfly::renderer::raycast {

/// Output of a frame: bytes, or floats to which values are added.
struct Canvas {
  int width_px = 0;
  int channels = 1;
  std::uint8_t* bytes = nullptr;  ///< digital numbers, rounded
  float* sums = nullptr;          ///< used if `bytes` is null
  float weight = 1.0F;            ///< of the added values
};

class Painter {
 public:
  Painter(const CameraRequest& request, const SampleKernel& kernel);

  /// Paints a row of cells. @param tiles  the tiles found for the band
  void paint(const Band& band, const std::vector<FoundTile>& tiles, const Canvas& canvas) const;

 private:
  /// Whether a block's samples are those of one plan.
  [[nodiscard]] bool planned(const Block& block) const;
  /// Values of a block's pixels, by plane, row and column. @param plan  of a planned() block
  void colour_of(const Block& block,
                 const std::vector<FoundTile>& tiles,
                 const SamplePlan& plan,
                 float* values) const;
  /// The mean of four samples for each pixel.
  void sample_four(const Block& block, const FoundTile& tile, float* values) const;
  void haze(const Block& block, float* values) const;

  const SampleKernel& kernel_;
  SceneColours colours_;
  int channels_;
  float unit_;  // of the kernel's values
  bool reference_;
  bool hazy_;
};

}  // namespace overfly::renderer::raycast
