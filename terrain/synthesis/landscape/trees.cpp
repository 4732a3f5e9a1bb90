#include "terrain/synthesis/landscape/trees.hpp"

#include "terrain/synthesis/landscape/ground.hpp"

namespace overfly::terrain::synthesis {
namespace {

constexpr float kCellM = 4.2F;
/// Longest reach of a crown with its shadow.
constexpr float kReachM = 26.0F;

struct Stand {
  float chance = 0.0F;  ///< of a tree in a cell
  float size = 1.0F;    ///< of its crown and height
  bool bale = false;    ///< a bale of straw instead
};

/// Probability of a tree at a place.
Stand stand_at(const Landscape& land, float x, float y) {
  const Point uv = land.airfield.to_uv(x, y);
  const float outside = land.airfield.outside_m(uv.x, uv.y);
  if (outside < 6.0F) return {};
  const float shore = land.water.pond_m(x, y);
  const float stream = land.water.stream_m(x, y) - land.water.stream_half_width_m(y);
  if (shore < 2.5F || stream < 1.8F) return {};
  for (const Structure& structure : land.structures.all) {
    const float dx = x - structure.middle.x;
    const float dy = y - structure.middle.y;
    if (dx * dx + dy * dy < structure.half_length_m * structure.half_length_m + 36.0F) return {};
  }
  const Point bend = land.bend_at(x, y);
  const ParcelHit hit = land.parcels.at(x + bend.x, y + bend.y);
  if (hit.road_m < (hit.road == Border::kRoad ? 8.0F : 5.0F)) return {};
  const std::uint32_t seed = land.water.seed + 300;
  const float clump =
      noise(x / 31.0F, y / 31.0F, seed) + 0.5F * noise(x / 12.0F, y / 12.0F, seed + 1);
  Stand stand{0.0008F, 1.0F};
  // No tall trees in the approach path.
  const bool approach = std::abs(uv.y) < 120.0F && outside < 260.0F;
  const float wood = land.wood_at(x, y);
  const float ragged = 3.0F + 9.0F * noise(x / 37.0F, y / 37.0F, seed + 3);
  const bool inside_wood = hit.parcel->use == LandUse::kWood && hit.border_m > ragged;
  if (inside_wood || wood > 0.5F) {
    stand.chance = hit.border_m < 4.0F ? 0.5F : 0.90F;
    stand.chance *= smoothstep(-1.15F, -0.75F, clump);
    stand.size = 1.02F + 0.38F * noise(x / 90.0F, y / 90.0F, seed + 2);
  } else if (hit.border == Border::kHedge && hit.border_m < 4.0F) {
    stand = {0.75F * smoothstep(-0.7F, -0.2F, clump), 0.62F + 0.3F * clump};
  } else if (hit.parcel->use == LandUse::kPasture) {
    stand.chance = 0.012F * smoothstep(0.1F, 0.8F, clump) + 0.002F;
  } else if ((hit.border == Border::kMargin || hit.border == Border::kDitch) &&
             hit.border_m < 3.0F) {
    stand = {0.16F * smoothstep(-0.5F, 0.6F, clump), 0.55F};
  } else if (hit.parcel->use == LandUse::kStubble || hit.parcel->use == LandUse::kMeadow) {
    const bool baled = unit(hash(9, 9, hit.parcel->seed)) < 0.5F && hit.border_m > 9.0F;
    if (baled) stand = {0.022F, 1.0F, true};
  } else if (hit.road == Border::kRoad && hit.road_m < 14.0F) {
    stand = {0.04F * smoothstep(0.0F, 0.6F, clump), 0.9F};
  }
  if (stream < 30.0F) {
    const float wet =
        0.75F * (1.0F - smoothstep(8.0F, 30.0F, stream)) * smoothstep(-0.6F, 0.1F, clump);
    if (wet > stand.chance) stand = {wet, 1.05F};
  }
  if (shore < 16.0F) stand.chance = std::max(stand.chance, 0.22F * smoothstep(-0.2F, 0.5F, clump));
  for (const Yard& yard : land.structures.yards) {
    constexpr float kPlantedM = 9.0F;
    if (surely_outside(yard, x, y, kPlantedM)) continue;
    const float edge = yard_m(yard, x, y);
    if (edge > kPlantedM) continue;
    const bool rim = edge > -6.0F;
    stand.chance = yard.garden ? (rim ? 0.22F : 0.08F) : (rim ? 0.15F : 0.01F);
    stand.size = 0.85F;
  }
  if (approach) stand.size = std::min(stand.size, 0.5F);
  return stand;
}

Tree grown(const Stand& stand, float x, float y, std::uint32_t seed) {
  Tree tree;
  tree.at = {x, y};
  tree.seed = seed;
  if (stand.bale) {
    tree.radius_m = 0.95F;
    tree.height_m = 2.2F;
    tree.colour = {214, 198, 150};
    return tree;
  }
  const float vigour = unit(hash(1, 2, seed));
  tree.radius_m = std::max(1.1F, stand.size * lerp(1.9F, 4.3F, vigour * vigour + 0.15F * vigour));
  tree.height_m = tree.radius_m * lerp(2.0F, 3.1F, unit(hash(3, 4, seed)));
  const float kind = unit(hash(5, 6, seed));
  tree.colour = kind < 0.55F   ? mix({78, 94, 50}, {96, 110, 58}, unit(hash(7, 8, seed)))
                : kind < 0.85F ? mix({62, 80, 46}, {76, 90, 52}, unit(hash(7, 8, seed)))
                               : mix({108, 112, 66}, {128, 118, 72}, unit(hash(7, 8, seed)));
  return tree;
}

/// An orchard's trees stand in rows.
void plant_orchards(const Landscape& land,
                    float x_min,
                    float y_min,
                    float x_max,
                    float y_max,
                    std::vector<Tree>& trees) {
  constexpr float kRowM = 7.0F;
  constexpr float kStepM = 5.0F;
  for (const Parcel& parcel : land.parcels.all()) {
    if (parcel.use != LandUse::kOrchard) continue;
    const float reach = 1.2F * std::sqrt(parcel.area_m2) + 60.0F;
    if (parcel.middle.x + reach < x_min || parcel.middle.x - reach > x_max ||
        parcel.middle.y + reach < y_min || parcel.middle.y - reach > y_max) {
      continue;
    }
    const int rows = static_cast<int>(reach / kRowM);
    const int steps = static_cast<int>(reach / kStepM);
    for (int row = -rows; row <= rows; ++row) {
      for (int step = -steps; step <= steps; ++step) {
        const float along = static_cast<float>(step) * kStepM;
        const float across = static_cast<float>(row) * kRowM;
        const std::uint32_t seed = hash(row, step, parcel.seed);
        const float x = parcel.middle.x + along * parcel.row_cos - across * parcel.row_sin +
                        0.8F * (unit(seed) - 0.5F);
        const float y = parcel.middle.y + along * parcel.row_sin + across * parcel.row_cos +
                        0.8F * (unit(hash(1, 1, seed)) - 0.5F);
        if (x < x_min - kReachM || x > x_max + kReachM || y < y_min - kReachM ||
            y > y_max + kReachM)
          continue;
        const ParcelHit hit = land.parcel_at(x, y);
        const Point uv = land.airfield.to_uv(x, y);
        if (hit.parcel != &parcel || hit.border_m < 7.0F || hit.road_m < 8.0F ||
            unit(hash(2, 2, seed)) < 0.06F || land.airfield.outside_m(uv.x, uv.y) < 10.0F ||
            land.water.pond_m(x, y) < 5.0F || land.water.stream_m(x, y) < 10.0F) {
          continue;
        }
        Tree tree = grown({1.0F, 0.62F}, x, y, seed);
        tree.radius_m = std::clamp(tree.radius_m, 1.5F, 2.3F);
        tree.height_m = 1.8F * tree.radius_m;
        trees.push_back(tree);
      }
    }
  }
}

}  // namespace

std::vector<Tree> trees_near(
    const Landscape& land, float x_min, float y_min, float x_max, float y_max) {
  std::vector<Tree> trees;
  const std::uint32_t seed = land.water.seed + 400;
  const int left = floor_int((x_min - kReachM) / kCellM);
  const int right = floor_int((x_max + kReachM) / kCellM);
  const int bottom = floor_int((y_min - kReachM) / kCellM);
  const int top = floor_int((y_max + kReachM) / kCellM);
  for (int j = bottom; j <= top; ++j) {
    for (int i = left; i <= right; ++i) {
      const std::uint32_t own = hash(i, j, seed);
      const float x = (static_cast<float>(i) + unit(hash(1, 0, own))) * kCellM;
      const float y = (static_cast<float>(j) + unit(hash(2, 0, own))) * kCellM;
      const Stand stand = stand_at(land, x, y);
      if (unit(hash(3, 0, own)) >= stand.chance) continue;
      trees.push_back(grown(stand, x, y, own));
    }
  }
  plant_orchards(land, x_min, y_min, x_max, y_max, trees);
  std::sort(trees.begin(), trees.end(), [](const Tree& a, const Tree& b) {
    if (a.height_m != b.height_m) return a.height_m < b.height_m;
    return a.seed < b.seed;
  });
  return trees;
}

}  // namespace overfly::terrain::synthesis
