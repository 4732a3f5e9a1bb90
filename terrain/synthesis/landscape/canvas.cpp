#include "terrain/synthesis/landscape/canvas.hpp"

#include "terrain/synthesis/landscape/relief.hpp"

namespace overfly::terrain::synthesis {
namespace {

/// Coverage by a crown, a ragged disc, with an edge of the given width.
float crown_cover(const Tree& tree, float dx, float dy, float distance, float edge_m) {
  constexpr float kMean = 0.88F;
  constexpr float kRaggedness = 0.24F;
  constexpr float kRoundingM = 0.01F;
  // Only near the edge its shape matters.
  const float sure_m = edge_m + kRoundingM;
  if (distance < (kMean - kRaggedness) * tree.radius_m - sure_m) return 1.0F;
  if (distance > (kMean + kRaggedness) * tree.radius_m + sure_m) return 0.0F;
  const float inverse = 1.0F / std::max(distance, 0.05F);
  const float radius_m =
      tree.radius_m *
      (kMean + kRaggedness * noise(1.9F * dx * inverse + 5.0F, 1.9F * dy * inverse, tree.seed));
  return soft(distance - radius_m, edge_m);
}

/// A structure's own axes.
struct Local {
  float along;
  float across;
};

Local to_local(const Structure& s, float x, float y) {
  const float dx = x - s.middle.x;
  const float dy = y - s.middle.y;
  return {dx * s.cos + dy * s.sin, -dx * s.sin + dy * s.cos};
}

/// Distance to the outline, negative inside.
float outline_m(const Structure& s, const Local& at) {
  switch (s.roof) {
    case Roof::kRound:
      return std::hypot(at.along, at.across) - s.half_length_m;
    case Roof::kAircraft: {
      const float fuselage =
          std::max(std::abs(at.along) - s.half_length_m, std::abs(at.across) - 0.65F);
      const float wing = std::max(std::abs(at.along - 0.22F * s.half_length_m) - 0.75F,
                                  std::abs(at.across) - s.half_width_m);
      const float tail = std::max(std::abs(at.along + 0.9F * s.half_length_m) - 0.4F,
                                  std::abs(at.across) - 0.34F * s.half_width_m);
      return std::min(fuselage, std::min(wing, tail));
    }
    default:
      return std::max(std::abs(at.along) - s.half_length_m, std::abs(at.across) - s.half_width_m);
  }
}

/// Distance from a place to the outline swept along the shadow's direction.
float shadow_m(const Structure& s, float x, float y) {
  float nearest = 1e9F;
  constexpr int kSteps = 6;
  for (int step = 0; step <= kSteps; ++step) {
    const float height = s.height_m * static_cast<float>(step) / kSteps;
    const Local at = to_local(s, x - height * kShadowEast, y - height * kShadowNorth);
    nearest = std::min(nearest, outline_m(s, at));
  }
  return nearest;
}

}  // namespace

void cast_shadow(Canvas& canvas, const Tree& tree) {
  // The crown is a sphere on a trunk: its shadow is a disc that extends back to the foot.
  constexpr float kDarkest = 0.92F;
  const float reach = tree.radius_m * 1.15F;
  for (const float level : {0.3F, 0.62F}) {
    const float height = level * tree.height_m;
    const float x = tree.at.x + height * kShadowEast;
    const float y = tree.at.y + height * kShadowNorth;
    canvas.around(x, y, reach + 0.5F, [&](int u, int v) {
      float& shadow = canvas.shadow[canvas.index(u, v)];
      if (shadow >= kDarkest) return;
      const float dx = canvas.east(u) - x;
      const float dy = canvas.north(v) - y;
      const float distance = std::sqrt(dx * dx + dy * dy);
      if (distance > reach) return;
      shadow = std::max(shadow, kDarkest * crown_cover(tree, dx, dy, distance, 0.35F));
    });
  }
}

void cast_shadow(Canvas& canvas, const Structure& structure) {
  canvas.around(structure.middle.x, structure.middle.y, structure.reach_m(), [&](int u, int v) {
    const float distance = shadow_m(structure, canvas.east(u), canvas.north(v));
    if (distance > 0.4F) return;
    float& shadow = canvas.shadow[canvas.index(u, v)];
    shadow = std::max(shadow, soft(distance, 0.25F));
  });
}

void draw(Canvas& canvas, const Tree& tree) {
  const float reach = tree.radius_m * 1.15F;
  const float inverse_radius = 1.0F / tree.radius_m;
  canvas.around(tree.at.x, tree.at.y, reach + 0.3F, [&](int u, int v) {
    const float x = canvas.east(u);
    const float y = canvas.north(v);
    const float dx = x - tree.at.x;
    const float dy = y - tree.at.y;
    const float distance = std::sqrt(dx * dx + dy * dy);
    if (distance > reach) return;
    const float cover = crown_cover(tree, dx, dy, distance, 0.22F);
    if (cover <= 0.0F) return;
    // A lumpy dome in the sun; gaps between the lumps are dark.
    const float east = dx * inverse_radius;
    const float north = dy * inverse_radius;
    const float up = std::sqrt(std::max(0.06F, 1.0F - std::min(1.0F, east * east + north * north)));
    const float lumps = noise(x * 0.95F, y * 0.95F, tree.seed);
    const float leaves = noise(x * 2.3F, y * 2.3F, tree.seed + 1);
    const float facing = kSunEast * east + kSunNorth * north + kSunUp * up;
    const float light =
        0.46F + 0.62F * std::max(0.0F, facing + 0.24F * lumps) + 0.20F * leaves + 0.10F * lumps;
    Rgb& colour = canvas.colour[canvas.index(u, v)];
    colour = mix(colour, tree.colour * std::max(0.25F, light), cover);
  });
}

void draw(Canvas& canvas, const Structure& structure) {
  canvas.around(structure.middle.x, structure.middle.y, structure.reach_m(), [&](int u, int v) {
    const Local at = to_local(structure, canvas.east(u), canvas.north(v));
    const float distance = outline_m(structure, at);
    if (distance > 0.3F) return;
    float light = 1.0F;
    if (structure.roof == Roof::kGable) {
      // Two slopes of 25 degrees; their light follows from the structure's direction.
      const float side = at.across > 0.0F ? 1.0F : -1.0F;
      const float tilt_east = -structure.sin * side * 0.42F;
      const float tilt_north = structure.cos * side * 0.42F;
      const float facing =
          (tilt_east * kSunEast + tilt_north * kSunNorth + 0.907F * kSunUp) / kSunUp;
      light = 0.25F + 0.80F * facing;
      light *= 1.0F + 0.10F * soft(std::abs(at.across) - 0.15F, 0.2F);
      light *= 1.0F -
               0.05F * soft(std::abs(at.along - std::round(at.along / 1.2F) * 1.2F) - 0.12F, 0.15F);
    } else if (structure.roof == Roof::kRound) {
      const float r = 1.0F / structure.half_length_m;
      const Local sun = {kSunEast * structure.cos + kSunNorth * structure.sin,
                         -kSunEast * structure.sin + kSunNorth * structure.cos};
      light = 0.92F + 0.3F * r * (at.along * sun.along + at.across * sun.across);
    } else if (structure.roof == Roof::kFlat && structure.half_length_m < 3.0F) {
      light = std::abs(at.along) < 0.45F * structure.half_length_m ? 1.0F : 0.86F;
    }
    const float x = canvas.east(u);
    const float y = canvas.north(v);
    const float dirt = 0.05F * noise(x * 0.35F, y * 0.35F, structure.seed) +
                       0.035F * noise(x * 2.7F, y * 2.7F, structure.seed + 1);
    Rgb& colour = canvas.colour[canvas.index(u, v)];
    colour = mix(colour, structure.colour * (light + dirt), soft(distance, 0.18F));
  });
}

}  // namespace overfly::terrain::synthesis
