#include "renderer/ground/ground_patch.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "renderer/ground/ground_reach.hpp"
#include "renderer/worker_pool.hpp"

namespace overfly::renderer {

using terrain::TileCoverage;
using terrain::TileId;

namespace {

/// Memory of a patch without points, including its place in the containers.
constexpr std::size_t kOutlineBytes = sizeof(GroundPatch) + 160;

/// The ground at a lattice over a patch, row by row from the north.
std::vector<Eigen::Vector3d> sample_lattice(const terrain::TileSource& tiles,
                                            const TileId& id,
                                            int points_a_side,
                                            double spacing_m) {
  const terrain::TileGrid& grid = tiles.grid();
  const double size_m = std::ldexp(terrain::kTileTexels * grid.texel_m, id.level);
  const double step_m = size_m / (points_a_side - 1);
  std::vector<Eigen::Vector2d> places;
  places.reserve(static_cast<std::size_t>(points_a_side) * points_a_side);
  for (int row = 0; row < points_a_side; ++row) {
    // Patches that share a point must compute identical coordinates for it, so they are computed
    // from its integer number of steps, which is exact at every level.
    const double y_m = grid.top_y_m - (id.row * (points_a_side - 1.0) + row) * step_m;
    for (int column = 0; column < points_a_side; ++column) {
      const double x_m = grid.left_x_m + (id.col * (points_a_side - 1.0) + column) * step_m;
      places.emplace_back(x_m, y_m);
    }
  }
  return tiles.coarse_world_at(places, spacing_m);
}

constexpr int kFinePoints = 2 * kPatchCells + 1;

/// Largest distance between a square's two triangles, which meet on the diagonal from the
/// north-east to the south-west, and the ground at points half a cell apart.
/// @param fine  kFinePoints^2 points over the whole patch
double square_error_m(const GroundPatch& patch,
                      const std::vector<Eigen::Vector3d>& fine,
                      int column,
                      int row,
                      int cells) {
  const Eigen::Vector3d& north_west = patch.point(column, row);
  const Eigen::Vector3d& north_east = patch.point(column + cells, row);
  const Eigen::Vector3d& south_west = patch.point(column, row + cells);
  const Eigen::Vector3d& south_east = patch.point(column + cells, row + cells);
  const int steps = 2 * cells;
  const double scale = 1.0 / steps;
  double worst_squared = 0.0;
  for (int j = 0; j <= steps; ++j) {
    const Eigen::Vector3d* ground =
        &fine[static_cast<std::size_t>(2 * row + j) * kFinePoints + 2 * column];
    const double b = j * scale;
    for (int i = 0; i <= steps; ++i) {
      const double a = i * scale;
      Eigen::Vector3d difference = -ground[i];
      if (i + j <= steps) {
        difference += (1.0 - a - b) * north_west + a * north_east + b * south_west;
      } else {
        difference += (a + b - 1.0) * south_east + (1.0 - a) * south_west + (1.0 - b) * north_east;
      }
      worst_squared = std::max(worst_squared, difference.squaredNorm());
    }
  }
  return std::sqrt(worst_squared);
}

}  // namespace

LatticePoint lattice_point(const TileId& id, int column, int row) {
  const int scale = 1 << (id.level - kFinestPatchLevel);
  return {(id.col * kPatchCells + column) * scale, (id.row * kPatchCells + row) * scale};
}

std::size_t GroundPatchStore::Hash::operator()(const TileId& id) const {
  std::uint64_t h = static_cast<std::uint32_t>(id.col);
  h = (h << 32U) ^ static_cast<std::uint32_t>(id.row) ^
      (static_cast<std::uint64_t>(id.level) << 58U);
  h *= 0x9E3779B97F4A7C15ULL;
  return h ^ (h >> 29U);
}

GroundPatchStore::GroundPatchStore(std::shared_ptr<const terrain::TileSource> tiles,
                                   std::size_t budget_bytes)
    : tiles_(std::move(tiles)), budget_bytes_(budget_bytes) {}

std::size_t GroundPatchStore::held_bytes() const {
  const std::lock_guard lock(mutex_);
  return held_bytes_;
}

std::shared_ptr<GroundPatch> GroundPatchStore::outline(const TileId& id) {
  std::shared_ptr<GroundPatch> patch;
  {
    const std::lock_guard lock(mutex_);
    if (const auto known = patches_.find(id); known != patches_.end()) {
      order_.splice(order_.begin(), order_, known->second.place);
      patch = known->second.patch;
    } else {
      patch = std::make_shared<GroundPatch>();
      patch->id = id;
      std::list<TileId> place{id};
      patches_.emplace(id, Entry{patch, kOutlineBytes, place.begin()});
      order_.splice(order_.begin(), place);
      held_bytes_ += kOutlineBytes;
    }
  }
  std::call_once(patch->outlined, [&] { make_outline(*patch); });
  return patch;
}

void GroundPatchStore::add_bytes(const TileId& id, std::size_t bytes) {
  const std::lock_guard lock(mutex_);
  if (const auto found = patches_.find(id); found != patches_.end()) {
    found->second.bytes += bytes;
    held_bytes_ += bytes;
  }
  // A view that uses the patch still holds it.
  while (held_bytes_ > budget_bytes_ && !order_.empty()) {
    const auto oldest = patches_.find(order_.back());
    held_bytes_ -= oldest->second.bytes;
    patches_.erase(oldest);
    order_.pop_back();
  }
}

TileCoverage GroundPatchStore::coverage_of(const TileId& id) const {
  if (id.level >= tiles_->grid().levels) {
    return id.col == 0 && id.row == 0 ? TileCoverage::kPartial : TileCoverage::kNone;
  }
  return tiles_->coverage(GroundPatches::tile_of(id));
}

void GroundPatchStore::make_outline(GroundPatch& patch) const {
  patch.size_map_m = std::ldexp(terrain::kTileTexels * tiles_->grid().texel_m, patch.id.level);
  patch.coverage = coverage_of(patch.id);
  const std::vector<Eigen::Vector3d> points =
      sample_lattice(*tiles_, patch.id, kOutlineCells + 1, patch.size_map_m / (2.0 * kPatchCells));
  std::copy(points.begin(), points.end(), patch.outline.begin());
  for (const Eigen::Vector3d& point : points) patch.bounds.extend(point);
  // Margin for the relief between the outline's points: for large patches the whole range of
  // heights, for small ones a fraction of the outline's range.
  const Eigen::Vector2d range_m = tiles_->height_range_m();
  const double relief_m = range_m.y() - range_m.x();
  const double seen_m = patch.bounds.sizes().z();
  const double margin_m = std::min(relief_m, std::max(0.5 * seen_m, 0.25 * patch.size_map_m)) +
                          0.5 + patch.size_map_m * patch.size_map_m / (4.0 * kEarthRadiusM);
  patch.bounds.min().z() -= margin_m;
  patch.bounds.max().z() += margin_m;
}

void GroundPatchStore::sample(GroundPatch& patch) {
  std::call_once(patch.sampled, [&] {
    const double cell_m = patch.size_map_m / kPatchCells;
    patch.points = sample_lattice(*tiles_, patch.id, kPatchCells + 1, 0.5 * cell_m);
    // The points of a finer mesh at this place: the lattice of the patches one level below.
    const std::vector<Eigen::Vector3d> fine =
        sample_lattice(*tiles_, patch.id, kFinePoints, 0.25 * cell_m);
    std::size_t bytes = patch.points.size() * sizeof(Eigen::Vector3d);
    for (int t = 0; t <= kLog2PatchCells; ++t) {
      const int cells = 1 << t;
      std::vector<float>& errors = patch.square_error_m[t];
      errors.clear();  // of an attempt that an exception ended
      for (int row = 0; row < kPatchCells; row += cells) {
        for (int column = 0; column < kPatchCells; column += cells) {
          errors.push_back(static_cast<float>(square_error_m(patch, fine, column, row, cells)));
        }
      }
      bytes += errors.size() * sizeof(float);
    }
    add_bytes(patch.id, bytes);
    patch.is_sampled = true;
  });
}

GroundPatches::GroundPatches(std::shared_ptr<const terrain::TileSource> tiles)
    : GroundPatches(std::make_shared<GroundPatchStore>(std::move(tiles))) {}

GroundPatches::GroundPatches(std::shared_ptr<GroundPatchStore> store, WorkerPool* workers)
    : store_(std::move(store)), workers_(workers) {}

void GroundPatches::sample(std::span<GroundPatch* const> patches) const {
  std::vector<GroundPatch*> fresh;
  std::copy_if(patches.begin(), patches.end(), std::back_inserter(fresh), [](const auto* patch) {
    return !patch->is_sampled;
  });
  const auto sample_one = [&](int i) { store_->sample(*fresh[static_cast<std::size_t>(i)]); };
  const int count = static_cast<int>(fresh.size());
  if (workers_ != nullptr) {
    workers_->run(count, sample_one);
  } else {
    for (int i = 0; i < count; ++i) sample_one(i);
  }
}

GroundPatch& GroundPatches::outline(const TileId& id) {
  in_use_.push_back(store_->outline(id));
  return *in_use_.back();
}

TileId GroundPatches::tile_of(const TileId& id) {
  if (id.level >= 0) return id;
  return {0, id.col >> -id.level, id.row >> -id.level};
}

bool GroundPatches::above_imagery(const TileId& id) const {
  return id.level >= tiles().grid().levels && id.col == 0 && id.row == 0;
}

}  // namespace overfly::renderer
