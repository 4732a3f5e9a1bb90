#include "renderer/ground/ground_mesh.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

#include "renderer/ground/ground_corners.hpp"
#include "renderer/ground/ground_squares.hpp"

namespace overfly::renderer {

using terrain::TileId;

namespace {

/// Texture coordinates of a patch's corner, and its extent, in the tile that covers it.
struct TextureWindow {
  double u = 0.0, v = 0.0, size = 0.0;
};

TextureWindow texture_window(const GroundLeaf& leaf) {
  const TileId& id = leaf.patch->id;
  const int levels_down = leaf.texture.level - id.level;
  const double share = std::ldexp(1.0, -levels_down);
  const double column = id.col * share - leaf.texture.col;
  const double row = id.row * share - leaf.texture.row;
  return {(terrain::kTileBorder + column * terrain::kTileTexels) / terrain::kTileSide,
          (terrain::kTileBorder + row * terrain::kTileTexels) / terrain::kTileSide,
          share * terrain::kTileTexels / terrain::kTileSide};
}

class Builder {
 public:
  Builder(const View& view, const GroundCorners& corners, GroundMesh& mesh)
      : view_(view), corners_(corners), mesh_(mesh) {}

  void append(const GroundLeaf& leaf, const std::vector<GroundSquare>& squares) {
    leaf_ = &leaf;
    window_ = texture_window(leaf);
    vertex_at_.fill(kNone);
    for (const GroundSquare& square : squares) append_square(square);
  }

 private:
  static constexpr std::uint32_t kNone = 0xFFFFFFFFU;
  static constexpr int kPoints = kPatchCells + 1;

  /// @param column, row  in cells of the patch; T-junctions of finer patches lie between cells
  std::uint32_t append_vertex(const Eigen::Vector3d& p_world, double column, double row) {
    const Eigen::Vector3d p = view_.camera_from_world(p_world);
    codes_.push_back(static_cast<std::uint8_t>(view_.outcode(p)));
    mesh_.vertices.push_back({static_cast<float>(p.x()),
                              static_cast<float>(p.y()),
                              static_cast<float>(p.z()),
                              static_cast<float>(window_.u + window_.size * column / kPatchCells),
                              static_cast<float>(window_.v + window_.size * row / kPatchCells)});
    return static_cast<std::uint32_t>(mesh_.vertices.size() - 1);
  }

  std::uint32_t vertex(int column, int row) {
    std::uint32_t& index = vertex_at_[row * kPoints + column];
    if (index == kNone) index = append_vertex(point(column, row), column, row);
    return index;
  }

  /// The patch's own ground point, or on its rim the one shared by all neighbours.
  [[nodiscard]] const Eigen::Vector3d& point(int column, int row) const {
    const auto on_rim = [](int i) { return i == 0 || i == kPatchCells; };
    if (on_rim(column) || on_rim(row)) {
      const Eigen::Vector3d* shared = corners_.find(lattice_point(leaf_->patch->id, column, row));
      if (shared != nullptr) return *shared;
    }
    return leaf_->patch->point(column, row);
  }

  void append_square(const GroundSquare& square) {
    const int side = 1 << square.t;
    const int west = square.column, north = square.row;
    const int east = west + side, south = north + side;
    const std::uint32_t nw = vertex(west, north), ne = vertex(east, north);
    const std::uint32_t sw = vertex(west, south), se = vertex(east, south);
    if ((codes_[nw] & codes_[ne] & codes_[sw] & codes_[se]) != 0U) return;
    // Counter-clockwise seen from above.
    rim_.clear();
    append_side(nw, west, north, west, south);
    append_side(sw, west, south, east, south);
    append_side(se, east, south, east, north);
    append_side(ne, east, north, west, north);
    if (rim_.size() == 4) {
      append_triangle(nw, sw, ne);
      append_triangle(ne, sw, se);
      return;
    }
    const std::uint32_t middle = centre(square);
    for (std::size_t i = 0; i < rim_.size(); ++i) {
      append_triangle(middle, rim_[i], rim_[(i + 1) % rim_.size()]);
    }
  }

  std::uint32_t centre(const GroundSquare& square) {
    const int half = (1 << square.t) / 2;
    if (half > 0) return vertex(square.column + half, square.row + half);
    const Eigen::Vector3d mean =
        0.5 * (point(square.column + 1, square.row) + point(square.column, square.row + 1));
    return append_vertex(mean, square.column + 0.5, square.row + 0.5);
  }

  /// Appends the side's first vertex and the corners of smaller squares that lie on the side.
  void append_side(std::uint32_t first, int c0, int r0, int c1, int r1) {
    rim_.push_back(first);
    const auto from = lattice_point(leaf_->patch->id, c0, r0);
    const auto to = lattice_point(leaf_->patch->id, c1, r1);
    append_between(from, to, {c0 * 1.0, r0 * 1.0}, {c1 * 1.0, r1 * 1.0});
  }

  /// A division of a square or patch adds the midpoints of its sides, so a side without a corner at
  /// its midpoint has no corners at all.
  void append_between(const LatticePoint& from,
                      const LatticePoint& to,
                      const Eigen::Vector2d& from_cell,
                      const Eigen::Vector2d& to_cell) {
    if (std::abs(from[0] - to[0]) + std::abs(from[1] - to[1]) < 2) return;
    const LatticePoint middle{(from[0] + to[0]) / 2, (from[1] + to[1]) / 2};
    const Eigen::Vector3d* point = corners_.find(middle);
    if (point == nullptr) return;
    const Eigen::Vector2d cell = 0.5 * (from_cell + to_cell);
    append_between(from, middle, from_cell, cell);
    const bool on_grid = cell.x() == std::floor(cell.x()) && cell.y() == std::floor(cell.y());
    rim_.push_back(on_grid ? vertex(static_cast<int>(cell.x()), static_cast<int>(cell.y()))
                           : append_vertex(*point, cell.x(), cell.y()));
    append_between(middle, to, cell, to_cell);
  }

  void append_triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    if ((codes_[a] & codes_[b] & codes_[c]) != 0U) return;
    if (!faces_camera(a, b, c)) {
      mesh_.needs_depth_test = true;
      return;
    }
    mesh_.indices.push_back(a);
    mesh_.indices.push_back(b);
    mesh_.indices.push_back(c);
  }

  [[nodiscard]] bool faces_camera(std::uint32_t a, std::uint32_t b, std::uint32_t c) const {
    const auto position = [this](std::uint32_t i) {
      const GroundVertex& vertex = mesh_.vertices[i];
      return Eigen::Vector3d(vertex.x, vertex.y, vertex.z);
    };
    const Eigen::Vector3d p = position(a);
    return (position(b) - p).cross(position(c) - p).dot(p) < 0.0;
  }

  const View& view_;
  const GroundCorners& corners_;
  GroundMesh& mesh_;
  const GroundLeaf* leaf_ = nullptr;
  TextureWindow window_;
  std::array<std::uint32_t, kPoints * kPoints> vertex_at_{};  // of the patch's points
  std::vector<std::uint8_t> codes_;                           // of the mesh's vertices
  std::vector<std::uint32_t> rim_;
};

bool same_texture(const GroundBatch& batch, const GroundLeaf& leaf) {
  return batch.textured == leaf.textured && (!leaf.textured || batch.texture == leaf.texture);
}

}  // namespace

GroundMesh build_ground_mesh(GroundPatches& patches, const View& view, const MeshLimits& limits) {
  GroundCorners corners;
  std::vector<GroundLeaf> leaves = select_ground(
      patches, view, limits, [&](const GroundPatch& patch) { add_division(patch, corners); });
  std::sort(leaves.begin(), leaves.end(), [](const GroundLeaf& a, const GroundLeaf& b) {
    if (a.textured != b.textured) return a.textured;
    if (a.textured && a.texture != b.texture) return a.texture < b.texture;
    return a.patch->id < b.patch->id;
  });
  std::vector<std::vector<GroundSquare>> squares;
  squares.reserve(leaves.size());
  for (const GroundLeaf& leaf : leaves) {
    squares.push_back(divide_into_squares(leaf, limits, corners));
  }
  GroundMesh mesh;
  Builder builder(view, corners, mesh);
  for (std::size_t i = 0; i < leaves.size(); ++i) {
    const auto first = static_cast<std::uint32_t>(mesh.indices.size());
    builder.append(leaves[i], squares[i]);
    const auto count = static_cast<std::uint32_t>(mesh.indices.size()) - first;
    if (count == 0) continue;
    if (!mesh.batches.empty() && same_texture(mesh.batches.back(), leaves[i])) {
      mesh.batches.back().index_count += count;
    } else {
      mesh.batches.push_back({leaves[i].textured, leaves[i].texture, first, count});
    }
  }
  patches.end_view();
  return mesh;
}

}  // namespace overfly::renderer
