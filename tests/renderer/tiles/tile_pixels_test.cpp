#include "renderer/tiles/tile_pixels.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace overfly::renderer {
namespace {

TEST(TilePixels, GreyOfGreyIsTheSame) {
  Image rgb(256, 1, 3);
  for (int i = 0; i < 256; ++i) {
    for (int c = 0; c < 3; ++c) rgb.at(i, 0, c) = static_cast<std::uint8_t>(i);
  }
  const Image grey = grey_from_rgb(rgb);
  for (int i = 0; i < 256; ++i) EXPECT_EQ(grey.at(i, 0), i);
}

TEST(TilePixels, GreyIsLumaWithinAHalfStep) {
  Image rgb(1, 1, 3);
  for (const auto& [r, g, b] : {std::tuple{255, 0, 0}, {0, 255, 0}, {0, 0, 255}, {12, 200, 77}}) {
    rgb.data = {
        static_cast<std::uint8_t>(r), static_cast<std::uint8_t>(g), static_cast<std::uint8_t>(b)};
    EXPECT_NEAR(grey_from_rgb(rgb).at(0, 0), 0.299 * r + 0.587 * g + 0.114 * b, 1.0);
  }
}

TEST(TilePixels, MipLevelsHalveDownToOneAndKeepTheMean) {
  Image image(528, 528, 1);
  double mean = 0.0;
  for (std::size_t i = 0; i < image.data.size(); ++i) {
    image.data[i] = static_cast<std::uint8_t>((i * 2654435761U) >> 7U);
    mean += image.data[i] / static_cast<double>(image.data.size());
  }
  const auto levels = mip_chain(image);
  const int sides[] = {528, 264, 132, 66, 33, 16, 8, 4, 2, 1};
  ASSERT_EQ(levels.size(), std::size(sides));
  for (std::size_t i = 0; i < levels.size(); ++i) EXPECT_EQ(levels[i].width_px, sides[i]);
  double mean_33 = 0.0;
  for (const auto texel : levels[4].data) mean_33 += texel / (33.0 * 33.0);
  EXPECT_NEAR(mean_33, mean, 0.5);  // each rounding is unbiased to an eighth
}

TEST(TilePixels, AlphaBecomesTheFourthChannel) {
  Image rgb(2, 1, 3), alpha(2, 1, 1);
  rgb.data = {1, 2, 3, 4, 5, 6};
  alpha.data = {255, 0};
  EXPECT_EQ(with_alpha(rgb, alpha).data, (std::vector<std::uint8_t>{1, 2, 3, 255, 4, 5, 6, 0}));
}

}  // namespace
}  // namespace overfly::renderer
