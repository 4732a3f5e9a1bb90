// Inside terrain only: synthesises the finer texels of one tile.
#pragma once

#include <array>

#include "terrain/decoration/detail_model.hpp"
#include "terrain/tile_source.hpp"

namespace overfly::terrain {

class DetailSynthesis {
 public:
  DetailSynthesis(const DetailOptions& options, const DetailStatistics& statistics);

  /// The tile `finer` octaves below level 0 of the imagery.
  /// @param parent  the imagery's tile of level 0 that contains it
  /// @param col,  row  of the finer tile, in tiles of its own size from the grid's corner
  [[nodiscard]] Tile tile(const Tile& parent, int finer, int col, int row) const;

 private:
  /// Texels [x, x + width) x [y, y + height), counted from the finer tile's corner in texels of
  /// one octave.
  struct Region {
    int x = 0;
    int y = 0;
    ImageBuffer<float> rgb;       ///< three channels
    ImageBuffer<float> contrast;  ///< of the imagery there
    Image valid;                  ///< 0 if there is no imagery
    bool all_valid = true;

    Region(int left, int top, int width, int height)
        : x(left),
          y(top),
          rgb(width, height, 3),
          contrast(width, height, 1),
          valid(width, height, 1) {}
  };
  struct Random {
    float across, down, diagonal;
  };

  /// The inner part of the parent with its local contrast.
  [[nodiscard]] static Region base_region(const Tile& parent, int finer, int col, int row);
  /// One octave finer, with the same centre. @param origin  of the finer tile, in coarse texels
  [[nodiscard]] Region refined(const Region& coarse,
                               int octave,
                               const std::array<int, 2>& origin,
                               const std::array<int, 4>& wanted) const;
  [[nodiscard]] Random draw(int x, int y, int octave) const;
  void refine_texel(const Region& coarse, int x, int y, const Random& random, Region& fine) const;

  std::array<float, 1024> laplace_{};  ///< mean absolute value 1, at equally spaced probabilities
  std::array<float, 3> amplitude_{};   ///< relative to the local contrast: across, down, diagonal
  float decay_ = 0.5F;
  std::uint32_t seed_ = 0;
};

}  // namespace overfly::terrain
