#include <algorithm>
#include <cmath>
#include <cstdio>

#include "core/motion/pose.hpp"
#include "terrain/download/layers.hpp"

namespace overfly::terrain {
namespace download {

Result<std::vector<ChunkLayer>> lay_out_download(const DownloadOptions& options,
                                                 PoliteFetcher& fetcher,
                                                 std::vector<std::string>& warnings) {
  const Status valid = options.validate();
  if (!valid) return valid.error();
  std::vector<ChunkLayer> layers;
  auto imagery = options.imagery_source == kUsgsSource
                     ? usgs_layer(options, false, fetcher, warnings)
                     : template_layer(options);
  if (!imagery) return imagery.error();
  layers.push_back(std::move(*imagery));
  if (options.elevation_source == kUsgsSource) {
    auto elevation = usgs_layer(options, true, fetcher, warnings);
    if (!elevation) return elevation.error();
    layers.push_back(std::move(*elevation));
  }
  std::size_t requests = 0;
  for (const ChunkLayer& layer : layers) requests += layer.chunks.size();
  if (requests > static_cast<std::size_t>(options.most_requests)) {
    return Error{
        ErrorCode::kInvalidArgument,
        "the square needs " + std::to_string(requests) + " requests, limit " +
            std::to_string(options.most_requests) +
            " (most_requests): request a smaller or coarser area, or raise the limit if the "
            "service's terms allow it"};
  }
  return layers;
}

}  // namespace download

namespace {

Error out_of_limits(const char* field, double value, const char* limits) {
  char text[160];
  std::snprintf(text, sizeof(text), "%s = %g: must be in %s", field, value, limits);
  return {ErrorCode::kInvalidArgument, text};
}

struct Limit {
  const char* field;
  double value, low, high;
  const char* text;
};

}  // namespace

Status DownloadOptions::validate() const {
  const Limit limits[] = {
      {"center.lat_deg", deg_from_rad(center_lat_rad), -85.0, 85.0, "[-85, 85]"},
      {"center.lon_deg", deg_from_rad(center_lon_rad), -180.0, 180.0, "[-180, 180]"},
      {"size_m", size_m, 100.0, 100e3, "[100, 100000]"},
      {"imagery_m", imagery_m, 0.05, 100.0, "[0.05, 100]"},
      {"elevation_m", elevation_m, 0.5, 500.0, "[0.5, 500]"},
      {"elevation_margin_m", elevation_margin_m, 0.0, 50e3, "[0, 50000]"},
      {"tile_px", static_cast<double>(tile_px), 64.0, 1024.0, "[64, 1024]"},
      {"finest_zoom", static_cast<double>(finest_zoom), 0.0, 24.0, "[0, 24]"},
      {"chunk_px", static_cast<double>(chunk_px), 64.0, 8192.0, "[64, 8192]"},
      {"parallel", static_cast<double>(parallel), 1.0, 8.0, "[1, 8]"},
      {"attempts", static_cast<double>(attempts), 1.0, 20.0, "[1, 20]"},
      {"first_wait_s", first_wait_s, 0.0, 60.0, "[0, 60]"},
      {"longest_wait_s", longest_wait_s, 0.0, 86400.0, "[0, 86400]"},
      {"stall_s", stall_s, 1.0, 3600.0, "[1, 3600]"},
      {"ground_height_m", ground_height_m.value_or(0.0), -12000.0, 12000.0, "[-12000, 12000]"},
  };
  for (const Limit& limit : limits) {
    if (!(limit.value >= limit.low && limit.value <= limit.high)) {
      return out_of_limits(limit.field, limit.value, limit.text);
    }
  }
  if (elevation_source != kUsgsSource && elevation_source != kNoSource) {
    return Error{ErrorCode::kInvalidArgument,
                 "elevation_source = \"" + elevation_source + "\": must be `usgs` or `none`"};
  }
  if (folder.empty()) return Error{ErrorCode::kInvalidArgument, "folder: is empty"};
  const double side_px = size_m / imagery_m;
  constexpr double kWidestPx = 200000.0;
  if (side_px > kWidestPx) return out_of_limits("size_m / imagery_m", side_px, "[1, 200000]");
  return {};
}

Result<DownloadPlan> plan_download(const DownloadOptions& options) {
  const std::atomic<bool> stop{false};
  DownloadOptions quick = options;  // values that cannot be queried now are assumed, with a warning
  quick.attempts = std::min(options.attempts, 2);
  download::PoliteFetcher fetcher(quick, stop);
  DownloadPlan plan;
  auto layers = download::lay_out_download(quick, fetcher, plan.warnings);
  if (!layers) return layers.error();
  for (const download::ChunkLayer& from : *layers) {
    DownloadPlan::Layer layer;
    layer.what = from.what;
    layer.source = from.source;
    layer.attribution = from.attribution;
    layer.crs = from.crs;
    layer.pixel_m = from.pixel;
    layer.width_px = from.width_px;
    layer.height_px = from.height_px;
    for (const download::Chunk& chunk : from.chunks) {
      layer.requests.push_back({chunk.url, chunk.file, chunk.width_px, chunk.height_px});
    }
    const double pixels = static_cast<double>(from.width_px) * from.height_px;
    const double bytes_per_px = from.heights ? 4.0 : 3.0;
    layer.transfer_bytes = static_cast<std::uint64_t>(pixels * from.transfer_bytes_per_px);
    // The result with its overviews; compression is assumed to save nothing.
    layer.disk_bytes =
        layer.transfer_bytes + static_cast<std::uint64_t>(pixels * bytes_per_px * 4.0 / 3.0);
    plan.layers.push_back(std::move(layer));
  }
  return plan;
}

}  // namespace overfly::terrain
