#include <algorithm>
#include <cmath>
#include <vector>

#include "core/motion/pose.hpp"
#include "terrain/download/layers.hpp"

namespace overfly::terrain::download {
namespace {

constexpr double kEarthRadiusM = 6378137.0;  // Web Mercator's sphere
constexpr double kHalfWorldM = kPi * kEarthRadiusM;
constexpr double kHighestLatRad = 85.05 * kPi / 180.0;

struct Mercator {
  double x = 0.0;
  double y = 0.0;
};

Mercator web_mercator(double lat_rad, double lon_rad) {
  return {kEarthRadiusM * lon_rad, kEarthRadiusM * std::asinh(std::tan(lat_rad))};
}

/// Address of the tile in column x and row y from the north-west.
std::string tile_url(std::string url, int zoom, int x, int y) {
  replace_field(url, "z", std::to_string(zoom));
  replace_field(url, "TileMatrix", std::to_string(zoom));
  replace_field(url, "x", std::to_string(x));
  replace_field(url, "TileCol", std::to_string(x));
  replace_field(url, "y", std::to_string(y));
  replace_field(url, "TileRow", std::to_string(y));
  replace_field(url, "-y", std::to_string((1 << zoom) - 1 - y));
  return url;
}

bool has(const std::string& text, const char* field) {
  return text.find(std::string("{") + field + "}") != std::string::npos;
}

Status check_template(const DownloadOptions& options) {
  const std::string& url = options.imagery_source;
  const auto wrong = [&](const std::string& why) {
    return Error{ErrorCode::kInvalidArgument, "source = \"" + url + "\": " + why};
  };
  if (url.rfind("http://", 0) != 0 && url.rfind("https://", 0) != 0) {
    return wrong("must be `usgs` or an address that begins with http:// or https://");
  }
  const bool wms = has(url, "bbox");
  const bool tiles = (has(url, "z") && has(url, "x") && (has(url, "y") || has(url, "-y"))) ||
                     (has(url, "TileMatrix") && has(url, "TileCol") && has(url, "TileRow"));
  if (!wms && !tiles) {
    return wrong(
        "must contain {z} {x} {y}, or {TileMatrix} {TileCol} {TileRow}, or {bbox} {width} "
        "{height}");
  }
  if (wms && (!has(url, "width") || !has(url, "height"))) {
    return wrong("a WMS template needs {width} and {height} in addition to {bbox}");
  }
  if (options.imagery_attribution.empty()) {
    return Error{ErrorCode::kInvalidArgument,
                 "attribution: is empty; a custom source needs its credit line"};
  }
  if (std::abs(options.center_lat_rad) > kHighestLatRad) {
    return Error{ErrorCode::kInvalidArgument,
                 "center: latitude beyond 85.05 deg, where Web Mercator ends"};
  }
  return {};
}

/// A grid of Web Mercator pixels over the square, in multiples of `step` pixels from the world's
/// north-west corner.
struct PixelRange {
  double pixel = 1.0;
  int left = 0, top = 0, right = 0, bottom = 0;  ///< in steps
};

PixelRange range_of(const DownloadOptions& options, double pixel, int step) {
  const Mercator middle = web_mercator(options.center_lat_rad, options.center_lon_rad);
  const double half = 0.5 * options.size_m / std::cos(options.center_lat_rad);
  const double stride = pixel * step;
  const auto steps = [&](double from_corner) {
    return static_cast<int>(std::floor(from_corner / stride));
  };
  PixelRange range{pixel,
                   steps(middle.x - half + kHalfWorldM),
                   steps(kHalfWorldM - middle.y - half),
                   steps(middle.x + half + kHalfWorldM),
                   steps(kHalfWorldM - middle.y + half)};
  return range;
}

void set_extent(ChunkLayer& layer, const PixelRange& range, int step) {
  layer.pixel = range.pixel;
  layer.left = -kHalfWorldM + range.left * range.pixel * step;
  layer.top = kHalfWorldM - range.top * range.pixel * step;
  layer.width_px = (range.right - range.left + 1) * step;
  layer.height_px = (range.bottom - range.top + 1) * step;
}

void cut_tiles(const DownloadOptions& options, ChunkLayer& layer) {
  const double ground_per_map = std::cos(options.center_lat_rad);
  const double zoom_0_m = 2.0 * kHalfWorldM / options.tile_px * ground_per_map;
  const int zoom =
      std::clamp(static_cast<int>(std::ceil(std::log2(zoom_0_m / options.imagery_m) - 1e-6)),
                 0,
                 options.finest_zoom);
  const double pixel = 2.0 * kHalfWorldM / options.tile_px / (1 << zoom);
  PixelRange range = range_of(options, pixel, options.tile_px);
  const int around = 1 << zoom;  // tiles around the earth
  range.top = std::max(range.top, 0);
  range.bottom = std::min(range.bottom, around - 1);
  if (range.right - range.left >= around) {
    range.left = 0;
    range.right = around - 1;
  }
  set_extent(layer, range, options.tile_px);
  for (int y = range.top; y <= range.bottom; ++y) {
    for (int column = range.left; column <= range.right; ++column) {
      const int x = (column + around) % around;  // columns wrap at the antimeridian
      Chunk chunk;
      chunk.url = tile_url(options.imagery_source, zoom, x, y);
      chunk.file = options.folder / "chunks" /
                   ("imagery_" + std::to_string(zoom) + "_" + std::to_string(y) + "_" +
                    std::to_string(x) + ".img");
      chunk.column_px = (column - range.left) * options.tile_px;
      chunk.row_px = (y - range.top) * options.tile_px;
      chunk.width_px = options.tile_px;
      chunk.height_px = options.tile_px;
      chunk.payload = Payload::kPicture;
      chunk.may_be_absent = true;
      layer.chunks.push_back(std::move(chunk));
    }
  }
}

/// Columns at which requests begin: every `chunk_px`, and at the antimeridian, where the services'
/// columns wrap. Ends with the layer's width.
std::vector<int> column_cuts(const ChunkLayer& layer, int chunk_px) {
  std::vector<int> cuts;
  for (int column = 0; column < layer.width_px; column += chunk_px) cuts.push_back(column);
  cuts.push_back(layer.width_px);
  for (const double seam : {-kHalfWorldM, kHalfWorldM}) {
    const double column = std::round((seam - layer.left) / layer.pixel);
    if (column > 0.0 && column < layer.width_px) cuts.push_back(static_cast<int>(column));
  }
  std::sort(cuts.begin(), cuts.end());
  cuts.erase(std::unique(cuts.begin(), cuts.end()), cuts.end());
  return cuts;
}

void cut_wms(const DownloadOptions& options, ChunkLayer& layer) {
  const double pixel = options.imagery_m / std::cos(options.center_lat_rad);
  set_extent(layer, range_of(options, pixel, 1), 1);
  const std::vector<int> cuts = column_cuts(layer, options.chunk_px);
  for (int row = 0; row < layer.height_px; row += options.chunk_px) {
    for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
      const int column = cuts[i];
      Chunk chunk;
      chunk.column_px = column;
      chunk.row_px = row;
      chunk.width_px = cuts[i + 1] - column;
      chunk.height_px = std::min(options.chunk_px, layer.height_px - row);
      chunk.payload = Payload::kPicture;
      const double middle = layer.left + (column + 0.5 * chunk.width_px) * pixel;
      const double turns = std::round(middle / (2.0 * kHalfWorldM));
      const double left = layer.left + column * pixel - turns * 2.0 * kHalfWorldM;
      const double top = layer.top - row * pixel;
      chunk.url = options.imagery_source;
      replace_field(chunk.url,
                    "bbox",
                    plain_number(left) + "," + plain_number(top - chunk.height_px * pixel) + "," +
                        plain_number(left + chunk.width_px * pixel) + "," + plain_number(top));
      replace_field(chunk.url, "width", std::to_string(chunk.width_px));
      replace_field(chunk.url, "height", std::to_string(chunk.height_px));
      replace_field(chunk.url, "crs", "EPSG:3857");
      chunk.file = options.folder / "chunks" /
                   ("imagery_" + std::to_string(row) + "_" + std::to_string(column) + ".img");
      layer.chunks.push_back(std::move(chunk));
    }
  }
}

}  // namespace

bool replace_field(std::string& text, const std::string& name, const std::string& value) {
  const std::string field = "{" + name + "}";
  bool found = false;
  for (std::size_t at = text.find(field); at != std::string::npos; at = text.find(field, at)) {
    text.replace(at, field.size(), value);
    at += value.size();
    found = true;
  }
  return found;
}

Result<ChunkLayer> template_layer(const DownloadOptions& options) {
  const Status usable = check_template(options);
  if (!usable) return usable.error();
  ChunkLayer layer;
  layer.what = "imagery";
  layer.source = options.imagery_source;
  layer.attribution = options.imagery_attribution;
  layer.crs = "EPSG:3857";
  layer.transfer_bytes_per_px = 0.6;  // photographs as JPEG; PNG is about three times as large
  if (has(options.imagery_source, "bbox")) {
    cut_wms(options, layer);
  } else {
    cut_tiles(options, layer);
  }
  return layer;
}

}  // namespace overfly::terrain::download
