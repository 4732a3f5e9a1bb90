#include "renderer/raycast/paint/painter.hpp"

#include <algorithm>
#include <array>

namespace overfly::renderer::raycast {

namespace {

constexpr int kMaxValues = 3 * kBlockPixels;

Bilinear4 scaled(const Bilinear4& f, float scale) {
  return {f[0] * scale, f[1] * scale, f[2] * scale, f[3] * scale};
}

void fill(const Block& block, const Colour& colour, int channels, float* values) {
  for (int c = 0; c < channels; ++c) {
    std::fill_n(values + c * kBlockPixels, block.rows * kBlockSide, colour[c]);
  }
}

/// The nearest integers of a row of values in [0, 255]. @param columns  at most kBlockSide
void put_row(const float* row, int columns, std::uint8_t* out) {
  std::array<std::uint8_t, kBlockSide> bytes;  // no alias of the values, so that vectors are used
  for (int x = 0; x < kBlockSide; ++x) bytes[x] = static_cast<std::uint8_t>(rounded(row[x]));
  if (columns == kBlockSide) {
    std::copy(bytes.begin(), bytes.end(), out);  // of a length known to the compiler
  } else {
    std::copy_n(bytes.begin(), columns, out);
  }
}

template <int kChannels>
void put_bytes(const Block& block, const float* values, const Canvas& canvas) {
  const auto byte = [](float value) { return static_cast<std::uint8_t>(rounded(value)); };
  for (int y = 0; y < block.rows; ++y) {
    std::uint8_t* out =
        canvas.bytes +
        (static_cast<std::size_t>(block.y + y) * canvas.width_px + block.x) * kChannels;
    if constexpr (kChannels == 1) {
      put_row(values + y * kBlockSide, block.columns, out);
      continue;
    }
    for (int c = 0; c < kChannels; ++c) {
      const float* row = values + c * kBlockPixels + y * kBlockSide;
      if (block.columns == kBlockSide) {  // a length known to the compiler
        for (int x = 0; x < kBlockSide; ++x) out[x * kChannels + c] = byte(row[x]);
      } else {
        for (int x = 0; x < block.columns; ++x) out[x * kChannels + c] = byte(row[x]);
      }
    }
  }
}

template <int kChannels>
void add_sums(const Block& block, const float* values, const Canvas& canvas) {
  for (int y = 0; y < block.rows; ++y) {
    float* out = canvas.sums +
                 (static_cast<std::size_t>(block.y + y) * canvas.width_px + block.x) * kChannels;
    for (int c = 0; c < kChannels; ++c) {
      const float* row = values + c * kBlockPixels + y * kBlockSide;
      if (block.columns == kBlockSide) {
        for (int x = 0; x < kBlockSide; ++x) out[x * kChannels + c] += canvas.weight * row[x];
      } else {
        for (int x = 0; x < block.columns; ++x) out[x * kChannels + c] += canvas.weight * row[x];
      }
    }
  }
}

/// The block's place in its tile.
TexelBlock texels_of(const Block& block, const terrain::TileId& tile) {
  const float per_texel = 1.0F / static_cast<float>(1 << tile.level);
  const double side = static_cast<double>(terrain::kTileTexels) * (1 << tile.level);
  TexelBlock texels;
  texels.columns = block.columns;
  texels.rows = block.rows;
  texels.u0 = static_cast<float>((block.u - tile.col * side) * per_texel) +
              static_cast<float>(terrain::kTileBorder);
  texels.v0 = static_cast<float>((block.v - tile.row * side) * per_texel) +
              static_cast<float>(terrain::kTileBorder);
  texels.numerator_u = scaled(block.numerator_u, per_texel);
  texels.numerator_v = scaled(block.numerator_v, per_texel);
  texels.inverse_depth = block.inverse_depth;
  texels.lod = block.lod;
  texels.lod[0] -= static_cast<float>(tile.level);
  return texels;
}

/// As above, of the block moved by a part of a pixel.
TexelBlock texels_of(const Block& block, const terrain::TileId& tile, float x, float y) {
  Block other = block;
  other.numerator_u = moved(block.numerator_u, x, y);
  other.numerator_v = moved(block.numerator_v, x, y);
  other.inverse_depth = moved(block.inverse_depth, x, y);
  other.lod = moved(block.lod, x, y);
  return texels_of(other, tile);
}

using Put = void (*)(const Block& block, const float* values, const Canvas& canvas);

Put put_of(const Canvas& canvas) {
  if (canvas.bytes != nullptr) return canvas.channels == 1 ? put_bytes<1> : put_bytes<3>;
  return canvas.channels == 1 ? add_sums<1> : add_sums<3>;
}

}  // namespace

Painter::Painter(const CameraRequest& request, const SampleKernel& kernel)
    : kernel_(kernel),
      colours_(SceneColours::of(request)),
      channels_(channel_count(request.format)),
      unit_(is_linear(request.format) ? 1.0F / 65535.0F : 1.0F),
      reference_(request.quality == RenderQuality::kReference),
      hazy_(request.atmosphere.extinction_per_m > 0.0) {}

void Painter::paint(const Band& band,
                    const std::vector<FoundTile>& tiles,
                    const Canvas& canvas) const {
  const Put put = put_of(canvas);
  std::array<SamplePlan, 2> plans;
  const auto plan = [&](std::size_t i) {
    if (i >= band.blocks.size()) return;
    const Block& block = band.blocks[i];
    const auto fetch = [&](const auto* pixels) {
      // Rows are far apart, so that the processor does not read them ahead by itself.
      const std::size_t stride = static_cast<std::size_t>(canvas.width_px) * canvas.channels;
      const auto* first = pixels + block.y * stride + std::size_t{block.x} * canvas.channels;
      for (int y = 0; y < block.rows; ++y) __builtin_prefetch(first + y * stride, 1);
    };
    if (canvas.bytes == nullptr) {
      fetch(canvas.sums);
    } else {
      fetch(canvas.bytes);
    }
    if (!planned(block)) return;
    const FoundTile& tile = tiles[block.tile];
    kernel_.plan(texels_of(block, tile.id), *tile.texels, plans[i % 2]);
  };
  const auto next_colour = [&](std::size_t i, float* values) {
    plan(i + 1);
    colour_of(band.blocks[i], tiles, plans[i % 2], values);
  };
  float values[kMaxValues] = {};
  plan(0);
  for (std::size_t i = 0; i < band.blocks.size(); ++i) {
    const Block& block = band.blocks[i];
    next_colour(i, values);
    if (block.quarter) {
      float part[kMaxValues];
      for (int k = 1; k < 4; ++k) {
        next_colour(++i, part);
        for (int c = 0; c < channels_; ++c) values[c * kBlockPixels] += part[c * kBlockPixels];
      }
      for (int c = 0; c < channels_; ++c) values[c * kBlockPixels] *= 0.25F;
    }
    put(block, values, canvas);
  }
}

bool Painter::planned(const Block& block) const {
  return block.kind == Block::Kind::kGround && (!reference_ || block.quarter);
}

void Painter::colour_of(const Block& block,
                        const std::vector<FoundTile>& tiles,
                        const SamplePlan& plan,
                        float* values) const {
  switch (block.kind) {
    case Block::Kind::kSky:
      return fill(block, colours_.sky, channels_, values);
    case Block::Kind::kVoid:
      fill(block, colours_.nothing, channels_, values);
      break;
    case Block::Kind::kGround:
      if (!planned(block)) {
        sample_four(block, tiles[block.tile], values);
        break;
      }
      kernel_.read(plan, values);
      if (unit_ == 1.0F) break;
      for (int c = 0; c < channels_; ++c) {
        float* plane = values + c * kBlockPixels;
        for (int i = 0; i < block.rows * kBlockSide; ++i) plane[i] *= unit_;
      }
      break;
  }
  if (hazy_) haze(block, values);
}

void Painter::sample_four(const Block& block, const FoundTile& tile, float* values) const {
  float taps[4][kMaxValues];
  SamplePlan plan;
  for (int i = 0; i < 4; ++i) {
    const float x = i % 2 == 0 ? -0.25F : 0.25F;
    const float y = i < 2 ? -0.25F : 0.25F;
    kernel_.plan(texels_of(block, tile.id, x, y), *tile.texels, plan);
    kernel_.read(plan, taps[i]);
  }
  const float share = 0.25F * unit_;
  for (int c = 0; c < channels_; ++c) {
    for (int i = c * kBlockPixels; i < c * kBlockPixels + block.rows * kBlockSide; ++i) {
      values[i] = share * ((taps[0][i] + taps[1][i]) + (taps[2][i] + taps[3][i]));
    }
  }
}

void Painter::haze(const Block& block, float* values) const {
  for (int y = 0; y < block.rows; ++y) {
    const auto row = static_cast<float>(y);
    for (int x = 0; x < block.columns; ++x) {
      const auto column = static_cast<float>(x);
      const float clear = block.clear[0] + block.clear[1] * column +
                          (block.clear[2] + block.clear[3] * column) * row;
      for (int c = 0; c < channels_; ++c) {
        float& value = values[c * kBlockPixels + y * kBlockSide + x];
        value = colours_.air[c] + clear * (value - colours_.air[c]);
      }
    }
  }
}

}  // namespace overfly::renderer::raycast
