// Inside terrain only: an imagery file on the map plane, used texel for texel if its grid is the
// map's, resampled if not.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "terrain/cancelled.hpp"
#include "terrain/imagery/imagery_raster.hpp"
#include "terrain/imagery/validity_grid.hpp"
#include "terrain/place/map_plane.hpp"
#include "terrain/place/raster_turns.hpp"
#include "terrain/place/smooth_map.hpp"

namespace overfly::terrain {

class MappedImagery {
 public:
  /// The layer whose grid is used for the tiles: grid texel (0, 0) is file texel (-pad_x, -pad_y),
  /// with pads that are multiples of 2^(levels - 1).
  static MappedImagery aligned(std::shared_ptr<const ImageryRaster> raster,
                               const TileGrid& grid,
                               int pad_x,
                               int pad_y);
  /// A layer that is resampled.
  /// @param turn  the one of `turns_over_grid` to which its columns refer
  /// Errors: kInvalidArgument if the grid cannot be transformed to its CRS.
  static Result<MappedImagery> warped(std::shared_ptr<const ImageryRaster> raster,
                                      const MapPlane& plane,
                                      const TileGrid& grid,
                                      const std::optional<Turn>& turn);
  /// The turns of the earth on which a file meets the grid; each needs a separate layer.
  static Result<std::vector<std::optional<Turn>>> turns_over_grid(const ImageryRaster& raster,
                                                                  const MapPlane& plane,
                                                                  const TileGrid& grid);

  /// Finds where the raster has texels; call it once, before tiles are read.
  /// @param known  the result, if it was read before
  /// Errors: kIo, kCancelled.
  Status find_validity(std::optional<ValidityGrid> known, const Cancelled& cancelled);
  /// How the map relates to the file's pixels, as text: equal for equal relations.
  [[nodiscard]] std::string fingerprint() const;

  /// The tile's texels that this layer covers. Errors: kIo.
  [[nodiscard]] Result<Patch> read(const TileId& id, const Cancelled& cancelled = {}) const;
  /// Coverage of a tile that is known without reading it.
  [[nodiscard]] TileCoverage coverage(const TileId& id) const;
  [[nodiscard]] bool has_imagery(double x_map_m, double y_map_m) const;
  [[nodiscard]] bool resampled() const { return pixel_from_map_.has_value(); }
  [[nodiscard]] const ImageryRaster& raster() const { return *raster_; }
  /// Null if every texel of the file is valid.
  [[nodiscard]] const ValidityGrid* validity() const { return validity_ ? &*validity_ : nullptr; }
  /// Size of a file's texel on the map [m].
  [[nodiscard]] double file_texel_m() const { return grid_.texel_m / texel_px_.minCoeff(); }

 private:
  MappedImagery(std::shared_ptr<const ImageryRaster> raster, const TileGrid& grid)
      : raster_(std::move(raster)), grid_(grid) {}
  [[nodiscard]] Eigen::Vector2d pixel_from_map(double x_map_m, double y_map_m) const;
  [[nodiscard]] Result<Patch> read_warped(const TileId& id, const Cancelled& cancelled) const;

  std::shared_ptr<const ImageryRaster> raster_;
  TileGrid grid_;
  int pad_x_ = 0;
  int pad_y_ = 0;
  /// File pixel coordinates (corners at integers) of a map point; empty for the aligned layer.
  std::optional<SmoothMap<2>> pixel_from_map_;
  Eigen::Vector2d texel_px_{1.0, 1.0};    ///< size of a texel of level 0 in file pixels
  std::optional<ValidityGrid> validity_;  ///< empty if every texel is valid
};

}  // namespace overfly::terrain
