// The tiles and heights of a world as one run or viewer reads them; records which ones could not be
// read.
#pragma once

#include <atomic>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include "terrain/decoration/tile_decorator.hpp"
#include "terrain/height_errors.hpp"

namespace overfly::server {

/// Forwards all calls, except status(). Thread-safe.
class WatchedTiles final : public terrain::TileDecorator {
 public:
  /// @param cancel  ends the reading of a tile; may be null, must outlive the tiles
  WatchedTiles(std::shared_ptr<const terrain::TileSource> base, const std::atomic<bool>* cancel)
      : TileDecorator(std::move(base)), cancel_(cancel) {}

  [[nodiscard]] Eigen::Vector3d world_from_map(double x_map_m, double y_map_m) const override {
    return watched([&] { return base().world_from_map(x_map_m, y_map_m); });
  }
  [[nodiscard]] Eigen::Vector3d coarse_world_from_map(double x_map_m,
                                                      double y_map_m,
                                                      double spacing_m) const override {
    return watched([&] { return base().coarse_world_from_map(x_map_m, y_map_m, spacing_m); });
  }
  [[nodiscard]] std::vector<Eigen::Vector3d> coarse_world_at(
      std::span<const Eigen::Vector2d> places_map_m, double spacing_m) const override {
    return watched([&] { return base().coarse_world_at(places_map_m, spacing_m); });
  }
  [[nodiscard]] Eigen::Vector2d map_from_world(double east_m, double north_m) const override {
    return watched([&] { return base().map_from_world(east_m, north_m); });
  }
  [[nodiscard]] double ground_up_m(double east_m, double north_m) const override {
    return watched([&] { return base().ground_up_m(east_m, north_m); });
  }

  /// kIo after a height could not be read through these tiles; `tile` returns the same error. What
  /// other users of the world could not read does not count.
  [[nodiscard]] Status status() const override;
  /// The error of a tile whose latest read failed, if there is one.
  [[nodiscard]] Status unread() const;

 private:
  [[nodiscard]] Result<terrain::Tile> read_tile(const terrain::TileId& id,
                                                const terrain::Cancelled& cancelled) const override;

  template <typename Query>
  std::invoke_result_t<Query> watched(const Query& query) const {
    const terrain::HeightErrors errors;
    auto answer = query();
    if (const Status read = errors.status(); !read) keep(read.error());
    return answer;
  }
  void keep(const Error& error) const;

  const std::atomic<bool>* cancel_;
  mutable std::mutex mutex_;
  mutable std::optional<Error> unread_height_;  ///< the first
  mutable std::map<terrain::TileId, Error> unread_;
};

}  // namespace overfly::server
