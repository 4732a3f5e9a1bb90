#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "core/motion/pose.hpp"
#include "core/outside/outside_json.hpp"
#include "terrain/download/layers.hpp"
#include "terrain/place/map_plane.hpp"

namespace overfly::terrain::download {
namespace {

constexpr const char* kNaipCredit = "USDA NAIP imagery, USGS The National Map";
constexpr const char* k3depCredit = "USGS 3DEP elevation, The National Map";
/// NAD83 has UTM zones 1 to 23 north as EPSG:26901 to 26923.
constexpr int kLastNad83Zone = 23;

std::string utm_crs(double lat_rad, double lon_rad) {
  const double lon_deg = deg_from_rad(lon_rad);
  const int zone = std::clamp(static_cast<int>(std::floor((lon_deg + 180.0) / 6.0)) + 1, 1, 60);
  const bool north = lat_rad >= 0.0;
  const int base = north && zone <= kLastNad83Zone ? 26900 : north ? 32600 : 32700;
  return "EPSG:" + std::to_string(base + zone);
}

/// The square's middle in the layer's CRS.
Result<Eigen::Vector2d> middle_in(const std::string& crs, const DownloadOptions& options) {
  OGRSpatialReference reference;
  GdalMessages messages;
  if (reference.SetFromUserInput(crs.c_str()) != OGRERR_NONE) {
    return Error{ErrorCode::kInternal, crs + ": " + messages.text()};
  }
  reference.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  const auto transform = CrsTransform::create(wgs84_crs(), reference, crs);
  if (!transform) return transform.error();
  Eigen::Matrix2Xd point(2, 1);
  point << deg_from_rad(options.center_lon_rad), deg_from_rad(options.center_lat_rad);
  if (!(*transform)->apply(point)) {
    return Error{ErrorCode::kInvalidArgument,
                 "center: is outside the area of " + crs + "; the latitude must be within 84 deg"};
  }
  return Eigen::Vector2d(point.col(0));
}

std::string export_url(const std::string& service, const ChunkLayer& layer, const Chunk& chunk) {
  const double left = layer.left + chunk.column_px * layer.pixel;
  const double top = layer.top - chunk.row_px * layer.pixel;
  const std::string epsg = layer.crs.substr(layer.crs.find(':') + 1);
  std::string url = service + "/exportImage?bbox=" + plain_number(left) + "," +
                    plain_number(top - chunk.height_px * layer.pixel) + "," +
                    plain_number(left + chunk.width_px * layer.pixel) + "," + plain_number(top);
  url += "&bboxSR=" + epsg + "&imageSR=" + epsg;
  url += "&size=" + std::to_string(chunk.width_px) + "," + std::to_string(chunk.height_px);
  url += "&adjustAspectRatio=false&format=tiff&interpolation=RSP_BilinearInterpolation";
  url += layer.heights ? "&pixelType=F32&noData=-999999&noDataInterpretation=esriNoDataMatchAny"
                       : "&pixelType=U8&bandIds=0,1,2";
  return url + "&f=image";
}

void cut(ChunkLayer& layer,
         const std::string& service,
         int width_limit_px,
         int height_limit_px,
         const std::filesystem::path& folder) {
  for (int row = 0; row < layer.height_px; row += height_limit_px) {
    for (int column = 0; column < layer.width_px; column += width_limit_px) {
      Chunk chunk;
      chunk.column_px = column;
      chunk.row_px = row;
      chunk.width_px = std::min(width_limit_px, layer.width_px - column);
      chunk.height_px = std::min(height_limit_px, layer.height_px - row);
      chunk.url = export_url(service, layer, chunk);
      chunk.file = folder / "chunks" /
                   (layer.what + "_" + std::to_string(row) + "_" + std::to_string(column) + ".tif");
      layer.chunks.push_back(std::move(chunk));
    }
  }
}

}  // namespace

std::string plain_number(double value) {
  char text[64];
  std::snprintf(text, sizeof(text), "%.6f", value);
  std::string number = text;
  number.erase(number.find_last_not_of('0') + 1);
  if (number.back() == '.') number.pop_back();
  return number;
}

Result<ImageServiceLimits> ask_image_service(const std::string& service, PoliteFetcher& fetcher) {
  const std::string url = service + "?f=json";
  nlohmann::json answer;
  const auto asked = fetcher.get(url, [&](const HttpReply& reply) -> Verdict {
    if (reply.status == 204) return {Verdict::Kind::kTryAgain, "the answer is empty"};
    if (reply.status != 200) {
      return {Verdict::Kind::kFailed, "HTTP status " + std::to_string(reply.status)};
    }
    const std::string text(reply.body.begin(), reply.body.end());
    auto json = json_from_outside<nlohmann::json>(text, url);
    if (!json || !json->is_object() || json->contains("error")) {
      return {Verdict::Kind::kTryAgain, "the service answered: " + words_of(reply)};
    }
    answer = std::move(*json);
    return {};
  });
  if (!asked) return asked.error();
  ImageServiceLimits limits;
  const auto read = [&](const char* field, int& value) {
    if (answer.contains(field) && answer[field].is_number()) value = answer[field].get<int>();
  };
  read("maxImageWidth", limits.width_px);
  read("maxImageHeight", limits.height_px);
  if (limits.width_px < 16 || limits.height_px < 16) {
    return Error{ErrorCode::kIo, url + ": permits only images of less than 16 px"};
  }
  if (answer.contains("copyrightText") && answer["copyrightText"].is_string()) {
    limits.credit = answer["copyrightText"].get<std::string>();
  }
  return limits;
}

Result<ChunkLayer> usgs_layer(const DownloadOptions& options,
                              bool heights,
                              PoliteFetcher& fetcher,
                              std::vector<std::string>& warnings) {
  const std::string& service = heights ? options.elevation_service : options.imagery_service;
  ChunkLayer layer;
  layer.what = heights ? "elevation" : "imagery";
  layer.source = service;
  layer.heights = heights;
  layer.attribution = heights ? k3depCredit : kNaipCredit;
  layer.crs = utm_crs(options.center_lat_rad, options.center_lon_rad);
  layer.pixel = heights ? options.elevation_m : options.imagery_m;
  layer.transfer_bytes_per_px = heights ? 4.0 : 3.0;
  const auto middle = middle_in(layer.crs, options);
  if (!middle) return middle.error();
  const double reach_m = 0.5 * options.size_m + (heights ? options.elevation_margin_m : 0.0);
  // Corners are multiples of a pixel, so that the same place always has the same pixels.
  const auto snapped = [&](double value) { return std::floor(value / layer.pixel) * layer.pixel; };
  layer.left = snapped(middle->x() - reach_m);
  layer.top = snapped(middle->y() + reach_m) + layer.pixel;
  layer.width_px = static_cast<int>(std::ceil(2.0 * reach_m / layer.pixel)) + 1;
  layer.height_px = layer.width_px;

  auto limits = ask_image_service(service, fetcher);
  if (!limits) {
    if (limits.error().code == ErrorCode::kCancelled) return limits.error();
    layer.without_limits = limits.error();
    warnings.push_back("the service's limits are not known; 4000 px are assumed: " +
                       limits.error().message);
    limits = ImageServiceLimits{};
  }
  if (!limits->credit.empty()) layer.attribution += " (" + limits->credit + ")";
  cut(layer,
      service,
      std::min(options.chunk_px, limits->width_px),
      std::min(options.chunk_px, limits->height_px),
      options.folder);
  return layer;
}

}  // namespace overfly::terrain::download
