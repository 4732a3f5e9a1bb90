#include "terrain/synthesis/landscape/structures.hpp"

#include <array>

namespace overfly::terrain::synthesis {
namespace {

constexpr std::array<Rgb, 8> kRoofs = {{{176, 180, 182},
                                        {150, 152, 150},
                                        {206, 204, 196},
                                        {146, 98, 78},
                                        {128, 84, 70},
                                        {104, 104, 108},
                                        {88, 84, 82},
                                        {170, 150, 128}}};

Structure building(Point at,
                   float direction_rad,
                   float length,
                   float width,
                   float height,
                   const Rgb& colour,
                   Dice& dice) {
  Structure made;
  made.middle = at;
  made.cos = std::cos(direction_rad);
  made.sin = std::sin(direction_rad);
  made.half_length_m = 0.5F * length;
  made.half_width_m = 0.5F * width;
  made.height_m = height;
  const float shade = dice.between(-14.0F, 14.0F);
  made.colour = colour + shade;
  made.seed = dice.seed();
  return made;
}

Point rotated(const Point& at, float direction_rad, float along, float across) {
  const float c = std::cos(direction_rad);
  const float s = std::sin(direction_rad);
  return {at.x + along * c - across * s, at.y + along * s + across * c};
}

class Planner {
 public:
  Planner(Structures& out, Dice& dice) : out_(out), dice_(dice) {}

  void farmstead(const Point& at, float direction_rad) {
    out_.yards.push_back({at, dice_.between(28.0F, 46.0F), dice_.seed(), false});
    const int barns = 2 + dice_.below(3);
    for (int i = 0; i < barns; ++i) {
      const float along = (static_cast<float>(i) - 0.5F * static_cast<float>(barns)) * 24.0F;
      const float across = dice_.between(6.0F, 18.0F) * (i % 2 == 0 ? 1.0F : -1.0F);
      const float turn = dice_.chance(0.35F) ? 1.5708F : 0.0F;
      out_.all.push_back(building(rotated(at, direction_rad, along, across),
                                  direction_rad + turn,
                                  dice_.between(16.0F, 38.0F),
                                  dice_.between(9.0F, 16.0F),
                                  dice_.between(5.0F, 9.0F),
                                  kRoofs[dice_.below(8)],
                                  dice_));
    }
    const int tanks = dice_.below(4);
    for (int i = 0; i < tanks; ++i) {
      Structure tank =
          building(rotated(at, direction_rad, 30.0F + 8.5F * static_cast<float>(i), -8.0F),
                   0.0F,
                   7.0F,
                   7.0F,
                   dice_.between(6.0F, 12.0F),
                   {196, 198, 198},
                   dice_);
      tank.roof = Roof::kRound;
      out_.all.push_back(tank);
    }
    house(rotated(at, direction_rad, -44.0F, 0.0F), direction_rad);
    cars(at, 18.0F, 2 + dice_.below(4));
  }

  void house(const Point& at, float direction_rad) {
    out_.yards.push_back({at, dice_.between(14.0F, 22.0F), dice_.seed(), true});
    out_.all.push_back(building(at,
                                direction_rad + dice_.between(-0.1F, 0.1F),
                                dice_.between(11.0F, 17.0F),
                                dice_.between(7.5F, 10.0F),
                                dice_.between(4.5F, 7.0F),
                                kRoofs[2 + dice_.below(6)],
                                dice_));
    if (dice_.chance(0.6F)) {
      out_.all.push_back(building(rotated(at, direction_rad, dice_.between(10.0F, 14.0F), 9.0F),
                                  direction_rad,
                                  6.5F,
                                  5.0F,
                                  3.0F,
                                  kRoofs[dice_.below(8)],
                                  dice_));
    }
  }

  void cars(const Point& around, float spread_m, int count) {
    static constexpr std::array<Rgb, 6> kPaints = {{{214, 214, 212},
                                                    {58, 60, 64},
                                                    {120, 122, 126},
                                                    {150, 44, 40},
                                                    {48, 70, 112},
                                                    {190, 186, 170}}};
    for (int i = 0; i < count; ++i) {
      const Point at = {around.x + dice_.between(-spread_m, spread_m),
                        around.y + dice_.between(-spread_m, spread_m)};
      car(at, dice_.between(0.0F, 3.14F), kPaints[dice_.below(6)]);
    }
  }

  void car(const Point& at, float direction_rad, const Rgb& paint) {
    Structure made = building(at, direction_rad, 4.6F, 1.9F, 1.5F, paint, dice_);
    made.roof = Roof::kFlat;
    out_.all.push_back(made);
  }

  void airfield(const Airfield& field) {
    const float along = std::atan2(field.heading_cos, field.heading_sin);
    const float half = field.apron_half_m();
    const float row_v = Airfield::kApronFarM + 16.0F;
    for (float u = -half + 22.0F; u < half - 18.0F; u += dice_.between(36.0F, 50.0F)) {
      out_.all.push_back(building(field.to_xy(u, row_v),
                                  along,
                                  dice_.between(24.0F, 34.0F),
                                  dice_.between(20.0F, 28.0F),
                                  dice_.between(7.0F, 10.0F),
                                  kRoofs[dice_.below(3)],
                                  dice_));
    }
    for (float u = -half + 12.0F; u < half - 8.0F; u += 17.0F) {
      for (const float v : {124.0F, 172.0F}) {
        if (!dice_.chance(0.6F)) continue;
        Structure plane = building(field.to_xy(u + dice_.between(-2.0F, 2.0F), v),
                                   along + 1.5708F + dice_.between(-0.2F, 0.2F),
                                   dice_.between(7.0F, 10.0F),
                                   dice_.between(9.0F, 12.0F),
                                   1.6F,
                                   {228, 228, 224},
                                   dice_);
        plane.roof = Roof::kAircraft;
        out_.all.push_back(plane);
      }
    }
    for (float u = -half; u < -half + 60.0F; u += 3.0F) {
      if (dice_.chance(0.55F)) {
        car(field.to_xy(u, row_v + 30.0F), along + 1.5708F, {150, 152, 156});
      }
    }
  }

 private:
  Structures& out_;
  Dice& dice_;
};

}  // namespace

Structures Structures::plan(float half_m,
                            const Airfield& airfield,
                            const Parcels& parcels,
                            const Water& water,
                            Dice& dice) {
  Structures structures;
  Planner planner(structures, dice);
  planner.airfield(airfield);
  // Houses stand next to roads: places are drawn at random until enough are suitable.
  const float area_km2 = 4e-6F * half_m * half_m;
  int farms = std::max(1, static_cast<int>(0.9F * area_km2));
  int houses = static_cast<int>(3.2F * area_km2);
  for (int trial = 0; trial < 20000 && farms + houses > 0; ++trial) {
    const Point at = {dice.between(-0.96F, 0.96F) * half_m, dice.between(-0.96F, 0.96F) * half_m};
    const ParcelHit hit = parcels.at(at.x, at.y);
    const Point uv = airfield.to_uv(at.x, at.y);
    const bool free = airfield.outside_m(uv.x, uv.y) > 90.0F &&
                      water.stream_m(at.x, at.y) > 60.0F && water.pond_m(at.x, at.y) > 50.0F &&
                      hit.parcel->use != LandUse::kWood;
    if (!free || hit.road > Border::kGravelRoad) continue;
    // Along the road: its direction follows from two neighbouring places.
    const float nx = parcels.at(at.x + 1.0F, at.y).road_signed_m - hit.road_signed_m;
    const float ny = parcels.at(at.x, at.y + 1.0F).road_signed_m - hit.road_signed_m;
    const float direction = std::atan2(nx, -ny);
    if (farms > 0 && hit.road_m > 45.0F && hit.road_m < 75.0F) {
      planner.farmstead(at, direction);
      --farms;
    } else if (houses > 0 && hit.road_m > 20.0F && hit.road_m < 34.0F) {
      planner.house(at, direction);
      --houses;
    }
  }
  return structures;
}

}  // namespace overfly::terrain::synthesis
