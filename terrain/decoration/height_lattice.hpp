// Inside terrain only: the ground's up coordinate on lattices with node spacings s, 2 s, 4 s ...
// Values are cached, because a ray to the sun passes many nodes and neighbouring rays use the same
// ones.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <mutex>
#include <unordered_map>

#include "terrain/tile_source.hpp"

namespace overfly::terrain {

/// Node (i, j) of lattice l lies at x_map = left + i s 2^l, y_map = top - j s 2^l, relative to the
/// tile grid's corner. Thread-safe; a node's value does not depend on earlier queries.
class HeightLattice {
 public:
  HeightLattice(std::shared_ptr<const TileSource> tiles, double spacing_m);
  ~HeightLattice();
  HeightLattice(const HeightLattice&) = delete;
  HeightLattice& operator=(const HeightLattice&) = delete;

  [[nodiscard]] double spacing_m(int lattice) const { return spacing_m_ * (1 << lattice); }
  [[nodiscard]] Eigen::Vector2d map_of(int lattice, double i, double j) const;

  /// Reads nodes for one thread.
  class Reader {
   public:
    explicit Reader(const HeightLattice& lattice) : lattice_(lattice) {}
    /// Up coordinate at a node [m].
    [[nodiscard]] float up_m(int lattice, int i, int j);
    /// The same between nodes, bilinear.
    [[nodiscard]] float up_m(int lattice, double i, double j);

   private:
    struct Slot {
      std::uint64_t key = ~std::uint64_t{0};
      std::shared_ptr<const float[]> heights;
    };
    [[nodiscard]] const float* chunk(int lattice, int chunk_i, int chunk_j);

    const HeightLattice& lattice_;
    std::array<Slot, 64> slots_;
  };

 private:
  static constexpr int kLog2Chunk = 6;  ///< a chunk has 64 x 64 nodes
  using Heights = std::shared_ptr<const float[]>;

  [[nodiscard]] static std::uint64_t key_of(int lattice, int chunk_i, int chunk_j);
  [[nodiscard]] Heights read(int lattice, int chunk_i, int chunk_j) const;
  [[nodiscard]] Heights get(int lattice, int chunk_i, int chunk_j) const;

  std::shared_ptr<const TileSource> tiles_;
  double spacing_m_;
  mutable std::mutex mutex_;
  mutable std::unordered_map<std::uint64_t, Heights> chunks_;
};

}  // namespace overfly::terrain
