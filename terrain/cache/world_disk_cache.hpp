// Inside terrain only: a world's precomputed tiles and heights, stored next to its manifest.
//
// CACHE/KEY/cache.json describes the sources and is written last; CACHE/KEY/tiles/LEVEL/,
// CACHE/KEY/heights/LEVEL/ and CACHE/KEY/far_heights/LEVEL/ hold chunks; CACHE/KEY/validity-N:
// where layer N has texels.
#pragma once

#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "terrain/cache/cache_key.hpp"
#include "terrain/elevation/elevation_model.hpp"
#include "terrain/imagery/validity_grid.hpp"
#include "terrain/tile_source.hpp"

namespace overfly::terrain {

inline constexpr int kChunkTiles = 8;    ///< tiles per side of a chunk
inline constexpr int kChunkBlocks = 16;  ///< blocks of heights per side of a chunk

/// Contents of cache.json.
struct CacheHeader {
  using Chunks = std::set<std::pair<int, int>>;  ///< (column, row)
  std::string fields;
  std::vector<CacheSource> sources;
  std::string layout;  ///< fingerprint of grid and heights
  int levels = 0;      ///< of tiles
  /// For each level, the chunks that contain tiles.
  std::vector<Chunks> chunks;
  HeightSurvey survey;
  std::optional<HeightSurvey> far_survey;  ///< of the coarser grid of heights, if there is one
  std::vector<bool> masked;                ///< per imagery layer: has a validity file
  std::uint64_t bytes = 0;
};

[[nodiscard]] std::filesystem::path tile_chunk_path(const std::filesystem::path& folder,
                                                    int level,
                                                    int column,
                                                    int row);
[[nodiscard]] std::filesystem::path height_chunk_path(
    const std::filesystem::path& folder, HeightReach reach, int level, int column, int row);
[[nodiscard]] std::filesystem::path validity_path(const std::filesystem::path& folder, int layer);

/// Writes cache.json, which makes the folder valid. Errors: kIo.
[[nodiscard]] Status write_header(const std::filesystem::path& folder, const CacheHeader& header);

class WorldDiskCache final : public HeightStore {
 public:
  /// The result of the search next to a manifest: a matching cache, or the reason why there is
  /// none.
  struct Found {
    std::shared_ptr<const WorldDiskCache> cache;
    std::string stale;  ///< what differs, if a cache does not match
  };
  [[nodiscard]] static Found find(const WorldSpec& spec);

  WorldDiskCache(std::filesystem::path folder, CacheHeader header)
      : folder_(std::move(folder)), header_(std::move(header)) {}

  /// A tile of a level that the cache contains. Errors: kIo naming the file.
  [[nodiscard]] Result<Tile> tile(const TileId& id) const;
  [[nodiscard]] bool holds(int level) const { return level >= 0 && level < header_.levels; }
  [[nodiscard]] const HeightSurvey* survey(HeightReach reach) const override;
  [[nodiscard]] Result<HeightGrid> block(HeightReach reach,
                                         int level,
                                         int column,
                                         int row) const override;
  /// Empty for a layer without mask. Errors: kIo, also if the mask is not of a raster of this size.
  [[nodiscard]] Result<std::optional<ValidityGrid>> validity(int layer,
                                                             int width_px,
                                                             int height_px) const;

  [[nodiscard]] const CacheHeader& header() const { return header_; }
  [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }

 private:
  std::filesystem::path folder_;
  CacheHeader header_;
};

}  // namespace overfly::terrain
