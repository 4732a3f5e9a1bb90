// Inside download only: one request's answer as a georeferenced raster.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "terrain/download.hpp"
#include "terrain/download/polite_fetcher.hpp"
#include "terrain/raster/gdal_dataset.hpp"

namespace overfly::terrain::download {

enum class Payload {
  kGeoTiff,  ///< contains its georeference, which is checked
  kPicture,  ///< PNG, JPEG and the like; located by the request
};

/// Values below or above these are not heights [m].
inline constexpr double kLowestHeightM = -12000.0;
inline constexpr double kHighestHeightM = 12000.0;
inline constexpr float kNoHeight = -999999.0F;

/// A part of a layer: pixels [column, column + width) x [row, row + height) of it.
struct Chunk {
  std::string url;
  std::filesystem::path file;
  int column_px = 0;
  int row_px = 0;
  int width_px = 0;
  int height_px = 0;
  Payload payload = Payload::kGeoTiff;
  /// Accept that the service has no data there (404, 204): tiles of a template.
  bool may_be_absent = false;
};

/// The raster that the chunks compose.
struct ChunkLayer {
  std::string what;
  std::string source;
  std::string attribution;
  std::string crs;    ///< "EPSG:26916"
  double left = 0.0;  ///< CRS coordinates of the north-west corner
  double top = 0.0;
  double pixel = 1.0;
  int width_px = 0;
  int height_px = 0;
  bool heights = false;  ///< one band of 32-bit float, else three bands of 8 bit
  std::vector<Chunk> chunks;
  double transfer_bytes_per_px = 3.0;
  /// Why the service's limits are not known, if others were assumed.
  std::optional<Error> without_limits{};
};

/// Writes a file to a temporary name and renames it; nothing is left of one that cannot be written.
/// Errors: kIo.
[[nodiscard]] Status write_renamed(const std::filesystem::path& file, std::string_view bytes);

/// Checks an answer without writing it: HTML or JSON instead of an image, a damaged or truncated
/// raster (every block is read), wrong size, type or place.
[[nodiscard]] Verdict judge_chunk(const ChunkLayer& layer,
                                  const Chunk& chunk,
                                  const HttpReply& reply);

/// Writes a checked answer as write_renamed().
[[nodiscard]] Status write_chunk(const Chunk& chunk, const HttpReply& reply);

/// True if an earlier download left this chunk complete; a damaged one is removed.
[[nodiscard]] bool chunk_is_there(const ChunkLayer& layer, const Chunk& chunk);

/// The text of a service's error answer: the message of an ArcGIS error, the title of a page, or
/// the first words.
[[nodiscard]] std::string words_of(const HttpReply& reply);

}  // namespace overfly::terrain::download
