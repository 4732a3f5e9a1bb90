#include "terrain/decoration/detail.hpp"

#include <cstdio>

#include "terrain/decoration/detail_synthesis.hpp"
#include "terrain/decoration/tile_decorator.hpp"

namespace overfly::terrain {
namespace {

Error bad_detail(const char* field, double value, const char* limits) {
  char text[160];
  std::snprintf(text, sizeof(text), "detail.%s = %g: must be in %s", field, value, limits);
  return {ErrorCode::kInvalidArgument, text};
}

class DetailedTiles final : public TileDecorator {
 public:
  DetailedTiles(std::shared_ptr<const TileSource> base,
                const DetailOptions& options,
                const DetailStatistics& statistics)
      : TileDecorator(std::move(base)),
        octaves_(options.octaves),
        grid_(finer(TileDecorator::grid(), octaves_)),
        synthesis_(options, statistics) {}

  [[nodiscard]] const TileGrid& grid() const override { return grid_; }

  [[nodiscard]] TileCoverage coverage(const TileId& id) const override {
    if (id.level >= octaves_) return base().coverage({id.level - octaves_, id.col, id.row});
    const double side_m = grid_.tile_m(id.level);
    const bool beyond = id.col < 0 || id.row < 0 || id.col * side_m >= grid_.width_m ||
                        id.row * side_m >= grid_.height_m;
    return beyond ? TileCoverage::kNone : base().coverage(parent_of(id));
  }

 private:
  [[nodiscard]] Result<Tile> read_tile(const TileId& id,
                                       const Cancelled& cancelled) const override {
    if (id.level < 0) return base().tile(id, cancelled);  // reports the error
    if (id.level >= octaves_) return base().tile({id.level - octaves_, id.col, id.row}, cancelled);
    auto parent = base().tile(parent_of(id), cancelled);
    if (!parent) return parent;
    return synthesis_.tile(*parent, octaves_ - id.level, id.col, id.row);
  }

  static TileGrid finer(TileGrid grid, int octaves) {
    const int share = 1 << octaves;
    grid.texel_m /= share;
    grid.levels += octaves;
    grid.cols *= share;
    grid.rows *= share;
    return grid;
  }

  [[nodiscard]] TileId parent_of(const TileId& id) const {
    const int up = octaves_ - id.level;
    return {0, id.col >> up, id.row >> up};
  }

  int octaves_;
  TileGrid grid_;
  DetailSynthesis synthesis_;
};

}  // namespace

Status DetailOptions::validate() const {
  if (octaves < 1 || octaves > 4) return bad_detail("octaves", octaves, "[1, 4]");
  if (!(strength >= 0.0 && strength <= 2.0)) return bad_detail("strength", strength, "[0, 2]");
  return {};
}

Result<std::shared_ptr<const TileSource>> with_detail(std::shared_ptr<const TileSource> tiles,
                                                      const DetailOptions& options) {
  const Status valid = options.validate();
  if (!valid) return valid.error();
  auto statistics = measure_detail(*tiles);
  if (!statistics) return statistics.error();
  return std::shared_ptr<const TileSource>(
      std::make_shared<DetailedTiles>(std::move(tiles), options, *statistics));
}

std::string describe(const DetailOptions& options) {
  char text[160];
  std::snprintf(text,
                sizeof(text),
                "%d octaves of synthetic detail, strength %g, seed %llu",
                options.octaves,
                options.strength,
                static_cast<unsigned long long>(options.seed));
  return text;
}

}  // namespace overfly::terrain
