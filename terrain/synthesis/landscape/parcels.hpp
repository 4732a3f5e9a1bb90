// The land divided into parcels by lines: roads, tracks, hedges and field margins.
#pragma once

#include <array>
#include <vector>

#include "terrain/synthesis/landscape/colour.hpp"

namespace overfly::terrain::synthesis {

enum class Border : std::uint8_t { kRoad, kGravelRoad, kTrack, kHedge, kMargin, kDitch };
enum class LandUse : std::uint8_t {
  kCrop,
  kPasture,
  kMeadow,
  kPloughed,
  kStubble,
  kWood,
  kOrchard,
  kYard
};

struct Point {
  float x = 0.0F;  ///< east of the world's middle [m]
  float y = 0.0F;  ///< north [m]
};

struct Parcel {
  LandUse use = LandUse::kCrop;
  Rgb light;  ///< the two colours between which the soil varies
  Rgb dark;
  float row_cos = 1.0F;  ///< direction of the rows, from east towards north
  float row_sin = 0.0F;
  float row_spacing_m = 0.75F;
  float row_contrast = 0.0F;  ///< of single rows, share of brightness
  float pass_width_m = 9.0F;  ///< of one pass of the machine
  float pass_contrast = 0.0F;
  float tramline_m = 0.0F;  ///< distance between pairs of wheel tracks, 0 = none
  float grain = 0.05F;      ///< strength of the finest texture, share of brightness
  float blotch = 0.5F;      ///< strength of the soil's variation
  float bare = 0.0F;        ///< share of thin places
  std::uint32_t seed = 0;
  Point middle;
  float area_m2 = 0.0F;
};

/// Where a point lies in the division.
struct ParcelHit {
  const Parcel* parcel = nullptr;
  Border border = Border::kMargin;  ///< the nearest
  float border_m = 0.0F;            ///< distance to it
  float along_m = 0.0F;             ///< position along it
  float road_m = 0.0F;              ///< distance to the nearest road, gravel road or track
  Border road = Border::kTrack;
  float road_along_m = 0.0F;
  float road_signed_m = 0.0F;  ///< side of the road's centre line
};

/// A tree of dividing lines; its leaves are convex parcels. The descent also gives the distances to
/// the borders, since a leaf is bounded only by lines on its path.
class Parcels {
 public:
  /// Divides a square of +-half_m around the middle.
  /// @param airfield_half_x_m, airfield_half_y_m  kept free of roads around the middle
  static Parcels plan(float half_m, float airfield_half_x_m, float airfield_half_y_m, Dice& dice);

  [[nodiscard]] ParcelHit at(float x, float y) const;
  [[nodiscard]] const std::vector<Parcel>& all() const { return parcels_; }

 private:
  friend class ParcelPlanner;
  struct Node {
    float nx = 1.0F;  ///< unit normal of the line nx x + ny y = d
    float ny = 0.0F;
    float d = 0.0F;
    Border border = Border::kMargin;
    int below = -1;  ///< child where n.p < d: node index, or ~parcel index if negative
    int above = -1;
  };
  std::vector<Node> nodes_;
  std::vector<Parcel> parcels_;
};

}  // namespace overfly::terrain::synthesis
