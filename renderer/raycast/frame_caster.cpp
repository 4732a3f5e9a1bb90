#include "renderer/raycast/frame_caster.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>

#include "renderer/camera/image_motion.hpp"
#include "renderer/raycast/frame_measure.hpp"
#include "renderer/raycast/ground/view_sweep.hpp"

namespace overfly::renderer::raycast {

using terrain::TileId;

namespace {

constexpr std::size_t kMaxCameras = 8;  // number of cameras whose rays are cached
constexpr double kAheadS = 1.5;         // flight time ahead for which tiles are requested
// Flight time ahead for which heights are sampled, one tile per frame
constexpr double kHeightsAheadS = 0.75;
/// Margin on each side of the path, in tiles, so that a roll finds its tiles as well.
constexpr double kAsideTiles = 0.25;

std::shared_ptr<TileStore> chosen_store(const std::shared_ptr<const terrain::TileSource>& tiles,
                                        const RaycastOptions& options) {
  if (options.tile_store != nullptr) return options.tile_store;
  TileStoreOptions store;
  store.budget_bytes = options.tile_cache_bytes;
  return std::make_shared<TileStore>(tiles, store);
}

void paint_depth(const Band& band, DepthImage& image) {
  for (const Block& block : band.blocks) {
    for (int y = 0; y < block.rows; ++y) {
      for (int x = 0; x < block.columns; ++x) {
        const Bilinear4& w = block.inverse_depth;
        const auto column = static_cast<float>(x);
        const auto row = static_cast<float>(y);
        image.at(block.x + x, block.y + y) =
            block.kind == Block::Kind::kSky
                ? std::numeric_limits<float>::infinity()
                : 1.0F / (w[0] + w[1] * column + (w[2] + w[3] * column) * row);
      }
    }
  }
}

}  // namespace

FrameCaster::FrameCaster(std::shared_ptr<const terrain::TileSource> tiles,
                         const RaycastOptions& options)
    : tiles_(std::move(tiles)),
      pool_(options.threads),
      kernel_(options.kernel != nullptr ? *options.kernel : best_sample_kernel()),
      field_(tiles_),
      texels_(chosen_store(tiles_, options), options.tile_cache_bytes) {}

const RayGrid& FrameCaster::rays_of(const CameraModel& camera) {
  const auto known = std::find_if(
      rays_.begin(), rays_.end(), [&](const RayGrid& rays) { return rays.is_of(camera); });
  if (known != rays_.end()) {
    rays_.splice(rays_.begin(), rays_, known);
  } else {
    rays_.emplace_front(camera);
    if (rays_.size() > kMaxCameras) rays_.pop_back();
  }
  return rays_.front();
}

FrameCaster::Frame FrameCaster::begin(const CameraRequest& request) {
  const RayGrid& rays = rays_of(request.camera);
  const GroundTree& tree = field_.select(sweep_of(request, rays));
  return {request, rays, GroundCaster(tree), {}, {}};
}

void FrameCaster::cast(const Frame& frame, const ShutterPoses& poses, bool depth_only) {
  BlockSettings settings;
  settings.request = &frame.request;
  settings.rays = &frame.rays;
  settings.poses = &poses;
  settings.caster = &frame.caster;
  settings.tiles = tiles_.get();
  settings.depth_only = depth_only;
  const int rows = frame.rays.rows();
  nodes_.resize(rows + 1);
  bands_.resize(rows);
  pool_.run(rows + 1, [&](int row) { cast_row(settings, row, nodes_[row].nodes); });
  pool_.run(rows, [&](int row) {
    build_band(settings, row, nodes_[row].nodes, nodes_[row + 1].nodes, bands_[row]);
  });
}

void FrameCaster::load_tiles(const Frame& frame) {
  std::set<TileId> ids;
  for (const Band& band : bands_) {
    std::copy_if(
        band.tiles.begin(), band.tiles.end(), std::inserter(ids, ids.end()), [&](const TileId& id) {
          return !frame.found.contains(id) && tiles_->coverage(id) != terrain::TileCoverage::kNone;
        });
  }
  texels_.load({ids.begin(), ids.end()}, frame.request.format, frame.request.tile_wait_ns);
}

Status FrameCaster::find_tiles(Frame& frame) {
  const PixelFormat format = frame.request.format;
  const bool for_all = frame.request.tile_wait_ns == kForAllTiles;
  if (frame.request.tile_wait_ns > 0) load_tiles(frame);
  band_tiles_.resize(bands_.size());
  for (std::size_t i = 0; i < bands_.size(); ++i) {
    band_tiles_[i].clear();
    for (const TileId& id : bands_[i].tiles) {
      auto known = frame.found.find(id);
      if (known == frame.found.end()) {
        Result<FoundTile> found = FoundTile{nullptr, id};
        if (tiles_->coverage(id) != terrain::TileCoverage::kNone) {
          found = for_all ? texels_.get(id, format) : texels_.find(id, format);
        }
        if (!found.ok()) return found.error();
        if (found->id != id) frame.late.insert(id);
        known = frame.found.emplace(id, std::move(*found)).first;
      }
      band_tiles_[i].push_back(known->second);
    }
  }
  return {};
}

void FrameCaster::paint(const Painter& painter, const Canvas& canvas) {
  pool_.run(static_cast<int>(bands_.size()),
            [&](int row) { painter.paint(bands_[row], band_tiles_[row], canvas); });
}

Status FrameCaster::draw_instants(Frame& frame, CameraFrame& drawn) {
  const CameraRequest& request = frame.request;
  const PinholeCamera& size = request.camera.pinhole();
  const int channels = channel_count(request.format);
  const std::vector<ExposureInstant> instants = exposure_instants(request, *tiles_);
  Canvas canvas;
  canvas.width_px = size.width_px;
  canvas.channels = channels;
  RadianceImage sums;
  if (is_linear(request.format) || instants.size() > 1) {
    sums = RadianceImage(size.width_px, size.height_px, channels);
    canvas.sums = sums.data.data();
  }
  if (!is_linear(request.format)) {
    drawn.image = Image(size.width_px, size.height_px, channels);
    if (instants.size() == 1) canvas.bytes = drawn.image.data.data();
  }
  const Painter painter(request, kernel_);
  for (const ExposureInstant& instant : instants) {
    canvas.weight = instant.weight;
    cast(frame, ShutterPoses(request, instant.offset_ns), false);
    if (Status status = find_tiles(frame); !status) return status;
    paint(painter, canvas);
  }
  if (is_linear(request.format)) {
    drawn.radiance = std::move(sums);
  } else if (instants.size() > 1) {
    std::transform(sums.data.begin(), sums.data.end(), drawn.image.data.begin(), [](float value) {
      return static_cast<std::uint8_t>(rounded(value));
    });
  }
  return {};
}

void FrameCaster::measure(const Frame& frame, CameraFrame& drawn) {
  const int levels = tiles_->grid().levels;
  const auto has_imagery = [&](double u, double v, double lod) {
    const int level = std::clamp(static_cast<int>(std::floor(lod)), 0, levels - 1);
    const double side = static_cast<double>(terrain::kTileTexels) * (1 << level);
    const TileId id{
        level, static_cast<int>(std::floor(u / side)), static_cast<int>(std::floor(v / side))};
    const auto found = frame.found.find(id);
    if (found == frame.found.end() || found->second.texels == nullptr) {
      const terrain::TileGrid& grid = tiles_->grid();
      return tiles_->has_imagery(grid.left_x_m + u * grid.texel_m, grid.top_y_m - v * grid.texel_m);
    }
    const TileId& drawn_id = found->second.id;
    const double scale = std::ldexp(1.0, -drawn_id.level);
    return found->second.texels->has_imagery(
        u * scale - static_cast<double>(drawn_id.col) * terrain::kTileTexels + terrain::kTileBorder,
        v * scale - static_cast<double>(drawn_id.row) * terrain::kTileTexels +
            terrain::kTileBorder);
  };
  const FrameStatistics statistics = measure_rays(drawn.camera,
                                                  ShutterPoses(frame.request, 0),
                                                  drawn.T_world_camera,
                                                  frame.caster,
                                                  *tiles_,
                                                  has_imagery,
                                                  pool_);
  drawn.texels_per_pixel_min = statistics.texels_per_pixel_min;
  drawn.texels_per_pixel_median = statistics.texels_per_pixel_median;
  drawn.void_fraction = statistics.void_fraction;
  drawn.axis_depth_m = statistics.axis_depth_m;
}

/// Requests the frame's tiles shifted along the camera's path over the map, and samples heights
/// there.
void FrameCaster::look_ahead(const Frame& frame) {
  const CameraRequest& request = frame.request;
  const Eigen::Vector2d way_m = kAheadS * request.velocity_world_m_s.head<2>();
  if (way_m.squaredNorm() == 0.0) return;
  const TexelMap& map = field_.map();
  const Eigen::Vector2d way = map.map_per_world * way_m / tiles_->grid().texel_m;
  const Eigen::Vector2d along = way.normalized();
  std::set<TileId> ahead;
  for (const auto& [id, found] : frame.found) {
    const double side = static_cast<double>(terrain::kTileTexels) * (1 << id.level);
    for (const double share : {0.5, 1.0}) {
      for (const double aside : {-kAsideTiles, kAsideTiles}) {
        const double col = id.col + share * way.x() / side - aside * along.y();
        const double row = id.row - share * way.y() / side - aside * along.x();
        for (const double rounding : {0.0, 0.999}) {
          ahead.insert({id.level,
                        static_cast<int>(std::floor(col + rounding)),
                        static_cast<int>(std::floor(row + rounding))});
        }
      }
    }
  }
  std::vector<TileId> ids;
  std::copy_if(ahead.begin(), ahead.end(), std::back_inserter(ids), [&](const TileId& id) {
    return tiles_->coverage(id) != terrain::TileCoverage::kNone;
  });
  // Work for later frames is distributed among them: texels in one, heights in another.
  if (texels_.prefetch(ids, request.format)) return;
  ViewSweep later = sweep_of(request, frame.rays);
  later.position += kHeightsAheadS * request.velocity_world_m_s;
  field_.prepare(later);
}

Result<CameraFrame> FrameCaster::draw(const CameraRequest& request) {
  Frame frame = begin(request);
  CameraFrame drawn;
  drawn.t_ns = request.t_ns;
  drawn.T_world_camera = request.T_world_camera.at(request.t_ns);
  drawn.camera = request.camera;
  if (Status status = draw_instants(frame, drawn); !status) return status.error();
  drawn.late_tiles = static_cast<int>(frame.late.size());
  measure(frame, drawn);
  look_ahead(frame);
  texels_.trim();
  return drawn;
}

DepthImage FrameCaster::depth(const CameraRequest& request) {
  const Frame frame = begin(request);
  cast(frame, ShutterPoses(request, 0), true);
  const PinholeCamera& size = request.camera.pinhole();
  DepthImage image(size.width_px, size.height_px, 1);
  pool_.run(static_cast<int>(bands_.size()), [&](int row) { paint_depth(bands_[row], image); });
  return image;
}

}  // namespace overfly::renderer::raycast
