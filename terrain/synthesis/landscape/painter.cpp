#include "terrain/synthesis/landscape/painter.hpp"

#include <cstdint>
#include <utility>

#include "terrain/synthesis/landscape/canvas.hpp"
#include "terrain/synthesis/landscape/ground.hpp"

namespace overfly::terrain::synthesis {
namespace {

/// Spacing of the lattice of slow values, aligned to the whole image.
constexpr int kLattice = 8;
/// Texels around a block that the last filter needs.
constexpr int kRim = 1;

void paint_ground(Canvas& canvas, const Landscape& land) {
  std::vector<const Yard*> yards;
  const float middle_x = canvas.east(canvas.width / 2);
  const float middle_y = canvas.north(canvas.height / 2);
  const float reach = 0.75F * canvas.texel_m * static_cast<float>(canvas.width + canvas.height);
  for (const Yard& yard : land.structures.yards) {
    if (std::hypot(yard.middle.x - middle_x, yard.middle.y - middle_y) <
        reach + 2.0F * yard.radius_m) {
      yards.push_back(&yard);
    }
  }
  const auto floor_div = [](int a) {
    return a >= 0 ? a / kLattice : -((-a + kLattice - 1) / kLattice);
  };
  const int first_x = floor_div(canvas.x0);
  const int first_y = floor_div(canvas.y0);
  const int columns = floor_div(canvas.x0 + canvas.width - 1) - first_x + 2;
  const int rows = floor_div(canvas.y0 + canvas.height - 1) - first_y + 2;
  std::vector<Slow> lattice(static_cast<std::size_t>(columns) * rows);
  for (int j = 0; j < rows; ++j) {
    for (int i = 0; i < columns; ++i) {
      const int u = (first_x + i) * kLattice - canvas.x0;
      const int v = (first_y + j) * kLattice - canvas.y0;
      lattice[static_cast<std::size_t>(j) * columns + i] =
          slow_at(land, canvas.east(u), canvas.north(v));
    }
  }
  std::vector<float> east(static_cast<std::size_t>(canvas.width));
  for (int u = 0; u < canvas.width; ++u) east[static_cast<std::size_t>(u)] = canvas.east(u);
  GroundPainter painter(land, std::move(yards), east);
  std::vector<Slow> line(static_cast<std::size_t>(columns));
  for (int v = 0; v < canvas.height; ++v) {
    const int j = floor_div(canvas.y0 + v) - first_y;
    const float t = static_cast<float>(canvas.y0 + v - (first_y + j) * kLattice) / kLattice;
    for (int i = 0; i < columns; ++i) {
      const Slow* node = &lattice[static_cast<std::size_t>(j) * columns + i];
      line[static_cast<std::size_t>(i)] = interpolate(node[0], node[columns], t);
    }
    painter.select_line(canvas.north(v));
    for (int u = 0; u < canvas.width; ++u) {
      const int i = floor_div(canvas.x0 + u) - first_x;
      const float s = static_cast<float>(canvas.x0 + u - (first_x + i) * kLattice) / kLattice;
      const Slow slow =
          interpolate(line[static_cast<std::size_t>(i)], line[static_cast<std::size_t>(i) + 1], s);
      canvas.colour[canvas.index(u, v)] = painter.colour(static_cast<std::size_t>(u), slow);
    }
  }
}

/// Only sky light reaches a shadow: darker and bluer.
void apply_shadows(Canvas& canvas) {
  for (std::size_t i = 0; i < canvas.colour.size(); ++i) {
    const float s = canvas.shadow[i];
    if (s <= 0.0F) continue;
    Rgb& colour = canvas.colour[i];
    colour = {colour.r * (1.0F - 0.66F * s),
              colour.g * (1.0F - 0.62F * s),
              colour.b * (1.0F - 0.54F * s)};
  }
}

/// A line of colours, each averaged with its eight neighbours: red, green, blue, red and so on.
/// @param v  of the northern neighbours
void blur_line(const Canvas& canvas, int v, std::vector<float>& line) {
  static_assert(sizeof(Rgb) == 3 * sizeof(float));
  constexpr float kBlur[3] = {0.11F, 0.78F, 0.11F};
  std::fill(line.begin(), line.end(), 0.0F);
  float* sum = line.data();
  const std::ptrdiff_t levels = std::ssize(line);
  for (int j = 0; j < 3; ++j) {
    for (int i = 0; i < 3; ++i) {
      const auto* from =
          reinterpret_cast<const float*>(canvas.colour.data() + canvas.index(i, v + j));
      const float weight = kBlur[i] * kBlur[j];
      for (std::ptrdiff_t k = 0; k < levels; ++k) sum[k] += from[k] * weight;
    }
  }
}

/// The camera's effects: slight blur, slight noise, 8 bit.
Image expose(const Canvas& canvas, int width, int height) {
  Image image(width, height, 3);
  std::vector<float> line(3 * static_cast<std::size_t>(width));
  for (int v = 0; v < height; ++v) {
    blur_line(canvas, v, line);
    for (int u = 0; u < width; ++u) {
      const float* blurred = line.data() + 3 * static_cast<std::ptrdiff_t>(u);
      Rgb sum{blurred[0], blurred[1], blurred[2]};
      // Slight haze over the whole image.
      const float grey = 0.3F * sum.r + 0.59F * sum.g + 0.11F * sum.b;
      sum = mix(sum, {grey, grey, grey}, 0.10F) * 0.95F + Rgb{7.0F, 9.0F, 12.0F};
      const std::uint32_t bits = hash(canvas.x0 + u, canvas.y0 + v, 0x5e5eU);
      const float grain = 2.0F * (unit(bits) + unit(bits * 0x9e3779b1U) - 1.0F);
      const auto level = [&](float value) {
        return static_cast<std::uint8_t>(std::clamp(value + grain + 0.5F, 0.0F, 255.0F));
      };
      std::uint8_t* out = &image.at(u, v);
      out[0] = level(sum.r);
      out[1] = level(sum.g);
      out[2] = level(sum.b);
    }
  }
  return image;
}

}  // namespace

Image paint_block(const Landscape& land, float texel_m, int x, int y, int width, int height) {
  Canvas canvas(
      x - kRim, y - kRim, width + 2 * kRim, height + 2 * kRim, texel_m, land.options.half_m);
  paint_ground(canvas, land);
  const float x_min = canvas.east(0);
  const float x_max = canvas.east(canvas.width - 1);
  const float y_max = canvas.north(0);
  const float y_min = canvas.north(canvas.height - 1);
  const std::vector<Tree> trees = trees_near(land, x_min, y_min, x_max, y_max);
  std::vector<const Structure*> structures;
  for (const Structure& structure : land.structures.all) {
    const float reach = structure.reach_m();
    if (structure.middle.x + reach > x_min && structure.middle.x - reach < x_max &&
        structure.middle.y + reach > y_min && structure.middle.y - reach < y_max) {
      structures.push_back(&structure);
    }
  }
  for (const Tree& tree : trees) cast_shadow(canvas, tree);
  for (const Structure* structure : structures) cast_shadow(canvas, *structure);
  apply_shadows(canvas);
  for (const Structure* structure : structures) draw(canvas, *structure);
  for (const Tree& tree : trees) draw(canvas, tree);
  return expose(canvas, width, height);
}

}  // namespace overfly::terrain::synthesis
