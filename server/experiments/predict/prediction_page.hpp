// A prediction as one self-contained HTML page.
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "core/camera/image.hpp"
#include "core/result.hpp"
#include "server/experiments/predict/prediction.hpp"

namespace overfly::server::predict {

/// Risks up to `below` have the colour `rgb` on the map.
struct RiskColour {
  double below = 1.0;
  std::array<std::uint8_t, 3> rgb{};
  const char* words = "";
};
/// From the lowest to the highest risk: "RdYlBu" of ColorBrewer (Harrower, Brewer 2003), which all
/// common kinds of colour vision tell apart.
inline constexpr std::array<RiskColour, 5> kRiskColours = {{{0.05, {44, 123, 182}, "below 5 %"},
                                                            {0.2, {171, 217, 233}, "5 to 20 %"},
                                                            {0.5, {255, 255, 191}, "20 to 50 %"},
                                                            {0.8, {253, 174, 97}, "50 to 80 %"},
                                                            {2.0, {215, 25, 28}, "above 80 %"}}};
[[nodiscard]] const RiskColour& colour_of(double risk);

/// The ground under the colours of its cells. @param ground  RGB, of the map's area
[[nodiscard]] Image coloured_map(const RiskMap& map, const Image& ground);

/// @param ground  as of coloured_map; empty = without a map
/// Errors: as encode_jpeg.
[[nodiscard]] Result<std::string> page_of(const Prediction& prediction, const Image& ground);

}  // namespace overfly::server::predict
