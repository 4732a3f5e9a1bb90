// The colours against WCAG 2.1 and models of colour vision.
#include "server/report/page_style.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <Eigen/Core>

#include <cmath>
#include <string>
#include <vector>

namespace overfly::server::report {
namespace {

Eigen::Vector3d linear_rgb(std::string_view colour) {
  Eigen::Vector3d rgb;
  for (int i = 0; i < 3; ++i) {
    const double value = std::stoi(std::string(colour.substr(1 + 2 * i, 2)), nullptr, 16) / 255.0;
    rgb[i] = value <= 0.04045 ? value / 12.92 : std::pow((value + 0.055) / 1.055, 2.4);
  }
  return rgb;
}

/// WCAG 2.1, "contrast ratio".
double contrast(std::string_view a, std::string_view b) {
  const Eigen::Vector3d weights(0.2126, 0.7152, 0.0722);
  const double light_a = weights.dot(linear_rgb(a));
  const double light_b = weights.dot(linear_rgb(b));
  return (std::max(light_a, light_b) + 0.05) / (std::min(light_a, light_b) + 0.05);
}

/// CIE 1976 L*a*b* of linear sRGB, white point D65.
Eigen::Vector3d lab(const Eigen::Vector3d& rgb) {
  const Eigen::Vector3d in_gamut = rgb.cwiseMax(0.0).cwiseMin(1.0);
  Eigen::Matrix3d xyz_from_rgb;
  xyz_from_rgb << 0.4124, 0.3576, 0.1805, 0.2126, 0.7152, 0.0722, 0.0193, 0.1192, 0.9505;
  const Eigen::Vector3d xyz =
      (xyz_from_rgb * in_gamut).cwiseQuotient(Eigen::Vector3d(0.95047, 1.0, 1.08883));
  const auto f = [](double t) { return t > 0.008856 ? std::cbrt(t) : 7.787 * t + 16.0 / 116.0; };
  return {116.0 * f(xyz.y()) - 16.0,
          500.0 * (f(xyz.x()) - f(xyz.y())),
          200.0 * (f(xyz.y()) - f(xyz.z()))};
}

/// Machado, Oliveira, Fernandes 2009, "A physiologically-based model for simulation of color vision
/// deficiency", severity 1.0: normal, protan, deutan, tritan.
std::vector<Eigen::Matrix3d> visions() {
  std::vector<Eigen::Matrix3d> models(4, Eigen::Matrix3d::Identity());
  models[1] << 0.152286, 1.052583, -0.204868, 0.114503, 0.786281, 0.099216, -0.003882, -0.048116,
      1.051998;
  models[2] << 0.367322, 0.860646, -0.227968, 0.280085, 0.672501, 0.047413, -0.011820, 0.042940,
      0.968881;
  models[3] << 1.255528, -0.076749, -0.178779, -0.078411, 0.930809, 0.147602, 0.004733, 0.691367,
      0.303900;
  return models;
}

class PageStyle : public ::testing::TestWithParam<const Theme*> {};
INSTANTIATE_TEST_SUITE_P(Themes, PageStyle, ::testing::Values(&kLightTheme, &kDarkTheme));

/// 1.4.3 Contrast (minimum), level AA, for text of normal size.
TEST_P(PageStyle, TextsHaveContrast) {
  const Theme& theme = *GetParam();
  for (const std::string_view text :
       {theme.text, theme.muted, theme.link, theme.error, theme.caution}) {
    EXPECT_GE(contrast(text, theme.page), 4.5) << text;
    EXPECT_GE(contrast(text, theme.box), 4.5) << text;
  }
}

/// 1.4.11 Non-text contrast, level AA.
TEST_P(PageStyle, LinesAndBandsHaveContrast) {
  const Theme& theme = *GetParam();
  for (const std::string_view colour :
       {theme.truth, theme.tracking, theme.initialising, theme.lost}) {
    EXPECT_GE(contrast(colour, theme.page), 3.0) << colour;
  }
  for (const std::string_view colour : theme.series) {
    EXPECT_GE(contrast(colour, theme.page), 3.0) << colour;
  }
}

/// A difference of 10 in CIELAB is seen at a glance.
TEST_P(PageStyle, LinesDifferForEveryColourVision) {
  const Theme& theme = *GetParam();
  std::vector<std::string_view> colours(theme.series.begin(), theme.series.end());
  colours.push_back(theme.truth);
  for (const Eigen::Matrix3d& vision : visions()) {
    for (std::size_t i = 0; i < colours.size(); ++i) {
      for (std::size_t k = 0; k < i; ++k) {
        const double difference =
            (lab(vision * linear_rgb(colours[i])) - lab(vision * linear_rgb(colours[k]))).norm();
        EXPECT_GE(difference, 10.0) << colours[i] << " and " << colours[k];
      }
    }
  }
}

TEST(StyleSheet, HasBothThemesPaperAndAllLines) {
  const std::string css = style_sheet();
  EXPECT_THAT(css, ::testing::HasSubstr("@media screen and (prefers-color-scheme:dark)"));
  EXPECT_THAT(css, ::testing::HasSubstr("@media print"));
  EXPECT_THAT(css, ::testing::HasSubstr(".s12{"));
  EXPECT_THAT(css, ::testing::Not(::testing::HasSubstr("url(")));
  EXPECT_THAT(css, ::testing::Not(::testing::HasSubstr("@import")));
  EXPECT_THAT(css, ::testing::Not(::testing::HasSubstr("<")));
}

}  // namespace
}  // namespace overfly::server::report
