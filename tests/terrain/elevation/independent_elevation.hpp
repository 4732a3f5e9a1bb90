// Heights straight from a file by another way than terrain's: PROJ's own interface for the place,
// four posts and the textbook's bilinear formula for the height.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "core/earth/geodesy.hpp"

namespace overfly::testing {

class IndependentElevation {
 public:
  /// @param crs  the file's, as PROJ names it ("EPSG:26910")
  IndependentElevation(const std::filesystem::path& file, const std::string& crs);
  ~IndependentElevation();
  IndependentElevation(const IndependentElevation&) = delete;
  IndependentElevation& operator=(const IndependentElevation&) = delete;

  /// The raster's value, in its own unit; NaN where a post is missing.
  [[nodiscard]] double value_at(double lat_rad, double lon_rad) const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace overfly::testing
