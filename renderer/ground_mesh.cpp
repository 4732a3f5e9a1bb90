#include "renderer/ground_mesh.hpp"

#include <algorithm>
#include <cmath>

namespace overfly::renderer {

using terrain::TileId;

namespace {

constexpr double kTextureTexels = terrain::kTileTexels + 2 * terrain::kTileBorder;

/// Texture coordinates of a patch's corner and of its extent in the tile that covers it.
struct TextureWindow {
  double u = 0.0, v = 0.0, size = 0.0;
};

TextureWindow texture_window(const GroundLeaf& leaf) {
  const TileId& id = leaf.patch->id;
  const int levels_down = leaf.texture.level - id.level;
  const double share = std::ldexp(1.0, -levels_down);
  const double column = id.col * share - leaf.texture.col;
  const double row = id.row * share - leaf.texture.row;
  return {(terrain::kTileBorder + column * terrain::kTileTexels) / kTextureTexels,
          (terrain::kTileBorder + row * terrain::kTileTexels) / kTextureTexels,
          share * terrain::kTileTexels / kTextureTexels};
}

class Builder {
 public:
  Builder(const View& view, GroundMesh& mesh) : view_(view), mesh_(mesh) {}

  void append(const GroundLeaf& leaf) {
    first_vertex_ = static_cast<std::uint32_t>(mesh_.vertices.size());
    cells_ = 1 << leaf.log2_cells;
    append_vertices(leaf);
    for (int row = 0; row < cells_; ++row) {
      for (int column = 0; column < cells_; ++column) append_cell(leaf, column, row);
    }
  }

 private:
  void append_vertices(const GroundLeaf& leaf) {
    const TextureWindow window = texture_window(leaf);
    const int step = kPatchCells >> leaf.log2_cells;
    codes_.clear();
    for (int row = 0; row <= cells_; ++row) {
      for (int column = 0; column <= cells_; ++column) {
        const Eigen::Vector3d p =
            view_.camera_from_world(leaf.patch->point(column * step, row * step));
        codes_.push_back(static_cast<std::uint8_t>(view_.outcode(p)));
        mesh_.vertices.push_back({static_cast<float>(p.x()),
                                  static_cast<float>(p.y()),
                                  static_cast<float>(p.z()),
                                  static_cast<float>(window.u + window.size * column / cells_),
                                  static_cast<float>(window.v + window.size * row / cells_)});
      }
    }
  }

  /// Vertex of a grid position; on a border that is coarser than the patch, the border's vertex
  /// before it.
  [[nodiscard]] std::uint32_t vertex(const GroundLeaf& leaf, int column, int row) const {
    const auto snap = [](int i, int log2_ratio) { return i >> log2_ratio << log2_ratio; };
    if (row == 0) column = snap(column, leaf.log2_border_ratio[kNorth]);
    if (row == cells_) column = snap(column, leaf.log2_border_ratio[kSouth]);
    if (column == 0) row = snap(row, leaf.log2_border_ratio[kWest]);
    if (column == cells_) row = snap(row, leaf.log2_border_ratio[kEast]);
    return static_cast<std::uint32_t>(row * (cells_ + 1) + column);
  }

  void append_cell(const GroundLeaf& leaf, int column, int row) {
    const std::uint32_t nw = vertex(leaf, column, row);
    const std::uint32_t ne = vertex(leaf, column + 1, row);
    const std::uint32_t sw = vertex(leaf, column, row + 1);
    const std::uint32_t se = vertex(leaf, column + 1, row + 1);
    append_triangle(nw, sw, ne);
    append_triangle(ne, sw, se);
  }

  /// Counter-clockwise from above, so that the normal points up.
  void append_triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    if (a == b || b == c || c == a) return;
    if ((codes_[a] & codes_[b] & codes_[c]) != 0U) return;
    if (!faces_camera(first_vertex_ + a, first_vertex_ + b, first_vertex_ + c)) {
      mesh_.needs_depth_test = true;
      return;
    }
    mesh_.indices.push_back(first_vertex_ + a);
    mesh_.indices.push_back(first_vertex_ + b);
    mesh_.indices.push_back(first_vertex_ + c);
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
  GroundMesh& mesh_;
  std::vector<std::uint8_t> codes_;
  std::uint32_t first_vertex_ = 0;
  int cells_ = 0;
};

}  // namespace

GroundMesh build_ground_mesh(GroundPatches& patches, const View& view, const MeshLimits& limits) {
  std::vector<GroundLeaf> leaves = select_ground(patches, view, limits);
  std::sort(leaves.begin(), leaves.end(), [](const GroundLeaf& a, const GroundLeaf& b) {
    if (a.textured != b.textured) return a.textured;
    if (a.textured && a.texture != b.texture) return a.texture < b.texture;
    return a.patch->id < b.patch->id;
  });
  GroundMesh mesh;
  Builder builder(view, mesh);
  for (const GroundLeaf& leaf : leaves) {
    const auto first = static_cast<std::uint32_t>(mesh.indices.size());
    builder.append(leaf);
    const auto count = static_cast<std::uint32_t>(mesh.indices.size()) - first;
    if (count == 0) continue;
    if (!mesh.batches.empty()) {
      GroundBatch& last = mesh.batches.back();
      if (last.textured == leaf.textured && (!leaf.textured || last.texture == leaf.texture)) {
        last.index_count += count;
        continue;
      }
    }
    mesh.batches.push_back({leaf.textured, leaf.texture, first, count});
  }
  patches.end_view();
  return mesh;
}

}  // namespace overfly::renderer
