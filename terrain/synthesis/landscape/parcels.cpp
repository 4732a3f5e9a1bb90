#include "terrain/synthesis/landscape/parcels.hpp"

#include <limits>

namespace overfly::terrain::synthesis {
namespace {

using Polygon = std::vector<Point>;

/// The part of a convex polygon with n.p >= d (keep_above) or <= d.
Polygon clip(const Polygon& polygon, float nx, float ny, float d, bool keep_above) {
  Polygon result;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Point& a = polygon[i];
    const Point& b = polygon[(i + 1) % polygon.size()];
    float side_a = nx * a.x + ny * a.y - d;
    float side_b = nx * b.x + ny * b.y - d;
    if (!keep_above) {
      side_a = -side_a;
      side_b = -side_b;
    }
    if (side_a >= 0.0F) result.push_back(a);
    if ((side_a > 0.0F && side_b < 0.0F) || (side_a < 0.0F && side_b > 0.0F)) {
      const float t = side_a / (side_a - side_b);
      result.push_back({lerp(a.x, b.x, t), lerp(a.y, b.y, t)});
    }
  }
  return result;
}

float area_of(const Polygon& polygon) {
  float twice = 0.0F;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Point& a = polygon[i];
    const Point& b = polygon[(i + 1) % polygon.size()];
    twice += a.x * b.y - b.x * a.y;
  }
  return 0.5F * std::abs(twice);
}

Point middle_of(const Polygon& polygon) {
  Point sum;
  for (const Point& p : polygon) {
    sum.x += p.x / static_cast<float>(polygon.size());
    sum.y += p.y / static_cast<float>(polygon.size());
  }
  return sum;
}

/// Direction of the longest edge.
Point long_direction(const Polygon& polygon) {
  Point best{1.0F, 0.0F};
  float longest = 0.0F;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Point& a = polygon[i];
    const Point& b = polygon[(i + 1) % polygon.size()];
    const float length = std::hypot(b.x - a.x, b.y - a.y);
    if (length <= longest) continue;
    longest = length;
    best = {(b.x - a.x) / length, (b.y - a.y) / length};
  }
  return best;
}

float extent_along(const Polygon& polygon, const Point& direction) {
  float low = std::numeric_limits<float>::max();
  float high = -low;
  for (const Point& p : polygon) {
    const float s = p.x * direction.x + p.y * direction.y;
    low = std::min(low, s);
    high = std::max(high, s);
  }
  return high - low;
}

/// Chooses the seasonal appearance of a parcel from above.
void choose_use(Parcel& parcel, Dice& dice) {
  const float lot = dice.unit();
  const auto vary = [&](Rgb colour, float spread) {
    const float all = dice.between(-spread, spread);
    return Rgb{colour.r + all + dice.between(-4, 4),
               colour.g + all + dice.between(-4, 4),
               colour.b + all + dice.between(-4, 4)};
  };
  const auto set = [&](LandUse use, Rgb light, Rgb dark, float spread) {
    parcel.use = use;
    parcel.light = vary(light, spread);
    parcel.dark = vary(dark, spread);
  };
  parcel.row_spacing_m = dice.between(0.7F, 1.5F);
  parcel.pass_width_m = dice.between(4.5F, 12.0F);
  parcel.pass_contrast = dice.between(0.015F, 0.05F);
  if (lot < 0.17F) {  // maize
    set(LandUse::kCrop, {104, 122, 76}, {66, 86, 52}, 8);
    parcel.row_contrast = dice.between(0.06F, 0.14F);
    parcel.grain = 0.13F;
    parcel.bare = 0.12F;
  } else if (lot < 0.32F) {  // beans
    set(LandUse::kCrop, {134, 138, 92}, {88, 104, 62}, 10);
    parcel.row_contrast = dice.between(0.08F, 0.18F);
    parcel.tramline_m = dice.chance(0.5F) ? 24.0F : 0.0F;
    parcel.grain = 0.10F;
    parcel.bare = 0.3F;
  } else if (lot < 0.44F) {  // cereal
    set(LandUse::kCrop, {186, 170, 120}, {146, 134, 86}, 10);
    parcel.row_contrast = dice.between(0.03F, 0.07F);
    parcel.tramline_m = dice.between(16.0F, 27.0F);
    parcel.grain = 0.07F;
    parcel.bare = 0.1F;
  } else if (lot < 0.55F) {
    set(LandUse::kStubble, {198, 182, 142}, {158, 138, 100}, 10);
    parcel.row_contrast = dice.between(0.05F, 0.10F);
    parcel.pass_contrast = dice.between(0.04F, 0.09F);
    parcel.grain = 0.09F;
    parcel.bare = 0.25F;
  } else if (lot < 0.67F) {
    set(LandUse::kPloughed, {160, 136, 108}, {98, 78, 60}, 10);
    parcel.row_contrast = dice.between(0.10F, 0.22F);
    parcel.row_spacing_m = dice.between(0.9F, 2.2F);
    parcel.grain = 0.11F;
    parcel.blotch = 0.75F;
  } else if (lot < 0.79F) {
    set(LandUse::kPasture, {134, 134, 88}, {94, 104, 62}, 8);
    parcel.grain = 0.12F;
    parcel.pass_contrast = 0.0F;
    parcel.bare = 0.35F;
  } else if (lot < 0.89F) {
    set(LandUse::kMeadow, {150, 152, 98}, {106, 122, 70}, 8);
    parcel.pass_contrast = dice.between(0.05F, 0.12F);
    parcel.pass_width_m = dice.between(4.0F, 8.0F);
    parcel.grain = 0.09F;
  } else if (lot < 0.945F) {
    set(LandUse::kWood, {96, 98, 64}, {70, 76, 46}, 4);
    parcel.pass_contrast = 0.0F;
    parcel.grain = 0.14F;
  } else if (lot < 0.96F) {
    set(LandUse::kOrchard, {132, 136, 88}, {100, 110, 66}, 6);
    parcel.pass_contrast = 0.0F;
    parcel.grain = 0.10F;
  } else {  // fallow
    set(LandUse::kMeadow, {164, 150, 112}, {118, 116, 78}, 8);
    parcel.pass_contrast = 0.02F;
    parcel.grain = 0.12F;
    parcel.bare = 0.5F;
  }
}

Border choose_border(int depth, Dice& dice) {
  const float lot = dice.unit();
  if (depth < 3) return lot < 0.4F ? Border::kGravelRoad : Border::kTrack;
  if (lot < 0.10F) return Border::kGravelRoad;
  if (lot < 0.40F) return Border::kTrack;
  if (lot < 0.66F) return Border::kHedge;
  return lot < 0.92F ? Border::kMargin : Border::kDitch;
}

}  // namespace

class ParcelPlanner {
 public:
  ParcelPlanner(Parcels& parcels, Dice& dice) : parcels_(parcels), dice_(dice) {}

  /// Divides by a given line first.
  template <typename Below, typename Above>
  int cut(
      const Polygon& land, float nx, float ny, float d, Border border, Below below, Above above) {
    const int index = static_cast<int>(parcels_.nodes_.size());
    parcels_.nodes_.push_back({nx, ny, d, border, -1, -1});
    const int first = below(clip(land, nx, ny, d, false));
    const int second = above(clip(land, nx, ny, d, true));
    parcels_.nodes_[index].below = first;
    parcels_.nodes_[index].above = second;
    return index;
  }

  /// Divides until the pieces are fields.
  int divide(const Polygon& land, int depth) {
    const float area = area_of(land);
    const Point along = long_direction(land);
    const Point across{-along.y, along.x};
    const float length = extent_along(land, along);
    const float width = extent_along(land, across);
    // From paddocks of a hectare to fields of thirty.
    const float wanted = 9e3F * std::exp(3.4F * dice_.unit());
    if (area < wanted || depth > 14 || std::max(length, width) < 70.0F)
      return leaf(land, along, area);
    // Cut across the longer extent, slightly off square like old boundaries.
    const Point main = length >= width ? along : across;
    const float turn = dice_.between(-0.09F, 0.09F) * (dice_.chance(0.2F) ? 3.0F : 1.0F);
    const float nx = main.x * std::cos(turn) - main.y * std::sin(turn);
    const float ny = main.x * std::sin(turn) + main.y * std::cos(turn);
    const Point middle = middle_of(land);
    const float shift = dice_.between(-0.16F, 0.16F) * std::max(length, width);
    const float d = nx * middle.x + ny * middle.y + shift;
    const auto next = [&](const Polygon& part) { return divide(part, depth + 1); };
    return cut(land, nx, ny, d, choose_border(depth, dice_), next, next);
  }

 private:
  int leaf(const Polygon& land, const Point& along, float area) {
    Parcel parcel;
    parcel.seed = dice_.seed();
    parcel.row_cos = along.x;
    parcel.row_sin = along.y;
    parcel.middle = middle_of(land);
    parcel.area_m2 = area;
    choose_use(parcel, dice_);
    parcels_.parcels_.push_back(parcel);
    return ~static_cast<int>(parcels_.parcels_.size() - 1);
  }

  Parcels& parcels_;
  Dice& dice_;
};

Parcels Parcels::plan(float half_m, float airfield_half_x_m, float airfield_half_y_m, Dice& dice) {
  Parcels parcels;
  ParcelPlanner planner(parcels, dice);
  const float edge = 1.5F * half_m;  // beyond the image, so that its edge cuts fields
  const Polygon land = {{-edge, -edge}, {edge, -edge}, {edge, edge}, {-edge, edge}};
  const float west = -airfield_half_x_m - dice.between(0.05F, 0.12F) * half_m;
  const float east = airfield_half_x_m + dice.between(0.05F, 0.14F) * half_m;
  const float south = -airfield_half_y_m - dice.between(0.05F, 0.14F) * half_m;
  const float north = airfield_half_y_m + dice.between(0.05F, 0.12F) * half_m;
  const float tilt = dice.between(-0.05F, 0.05F);
  const float c = std::cos(tilt);
  const float s = std::sin(tilt);
  const auto fields = [&](const Polygon& part) { return planner.divide(part, 1); };
  const auto center = [&](const Polygon& part) {
    return planner.cut(part, -s, c, south, Border::kRoad, fields, [&](const Polygon& rest) {
      return planner.cut(rest, -s, c, north, Border::kGravelRoad, fields, fields);
    });
  };
  planner.cut(land, c, s, west, Border::kGravelRoad, fields, [&](const Polygon& rest) {
    return planner.cut(rest, c, s, east, Border::kRoad, center, fields);
  });
  return parcels;
}

ParcelHit Parcels::at(float x, float y) const {
  ParcelHit hit;
  hit.border_m = std::numeric_limits<float>::max();
  hit.road_m = hit.border_m;
  int index = 0;
  while (index >= 0) {
    const Node& node = nodes_[static_cast<std::size_t>(index)];
    const float side = node.nx * x + node.ny * y - node.d;
    const float distance = std::abs(side);
    if (distance < hit.border_m) {
      hit.border_m = distance;
      hit.border = node.border;
      hit.along_m = -node.ny * x + node.nx * y;
    }
    if (node.border <= Border::kTrack && distance < hit.road_m) {
      hit.road_m = distance;
      hit.road = node.border;
      hit.road_along_m = -node.ny * x + node.nx * y;
      hit.road_signed_m = side;
    }
    index = side < 0.0F ? node.below : node.above;
  }
  const int leaf = ~index;
  hit.parcel = &parcels_[static_cast<std::size_t>(leaf)];
  return hit;
}

}  // namespace overfly::terrain::synthesis
