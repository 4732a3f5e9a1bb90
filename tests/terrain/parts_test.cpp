// The small parts of the room: geoid, polynomial maps, digests, picture files, height grids.
#include <gdal_priv.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "core/motion/pose.hpp"
#include "terrain/elevation/height_grid.hpp"
#include "terrain/files/file_digest.hpp"
#include "terrain/place/geoid.hpp"
#include "terrain/place/geoid_table.hpp"
#include "terrain/place/smooth_map.hpp"
#include "terrain/raster/gdal_messages.hpp"
#include "terrain/raster/image_file.hpp"
#include "tests/support/support.hpp"
#include "tests/support/synthetic_world.hpp"

namespace overfly::terrain {
namespace {

using testing::TemporaryFolder;

constexpr std::uint32_t kMostSidePx = 64;

TEST(Geoid, TableAgreesWithPublishedEgm96Heights) {
  // NGA's test points for EGM96 (tide-free, metres): the table's stated error is 8 m.
  struct Place {
    double lat_deg;
    double lon_deg;
    double separation_m;
  };
  const Place places[] = {{38.6281550, 269.7791550, -31.628},
                          {-14.6212170, 305.0211140, -2.969},
                          {46.8743190, 102.4487290, -43.575},
                          {-23.6174460, 133.8747120, 15.871},
                          {38.6254730, 359.9995000, 50.066},
                          {-0.4667440, 0.0023000, 17.329}};
  for (const Place& place : places) {
    const double table_m = egm96_table_m(rad_from_deg(place.lat_deg), rad_from_deg(place.lon_deg));
    EXPECT_NEAR(table_m, place.separation_m, kEgm96TableErrorM) << place.lat_deg;
    std::vector<std::string> warnings;
    const auto model = choose_geoid(VerticalDatum::kEgm96,
                                    {},
                                    rad_from_deg(place.lat_deg),
                                    rad_from_deg(place.lon_deg),
                                    "f",
                                    warnings);
    ASSERT_TRUE(model);
    if (model->grid.empty()) continue;
    Eigen::Matrix2Xd point(2, 1);
    point << rad_from_deg(place.lon_deg), rad_from_deg(place.lat_deg);
    // Bilinear in the 15' grid against NGA's spline.
    EXPECT_NEAR(geoid_separation_m(*model, point)[0], place.separation_m, 0.35) << place.lat_deg;
    EXPECT_TRUE(warnings.empty());
  }
}

TEST(Geoid, IsAboveTheEllipsoidWherePublished) {
  EXPECT_NEAR(egm96_table_m(rad_from_deg(39.35), rad_from_deg(-86.03)), -33.0, 2.0);
  EXPECT_NEAR(egm96_table_m(rad_from_deg(4.7), rad_from_deg(78.8)), -105.0, 3.0);
  EXPECT_NEAR(egm96_table_m(rad_from_deg(90.0), rad_from_deg(12.0)), 13.6, 0.5);
  EXPECT_NEAR(egm96_table_m(rad_from_deg(-5.0), rad_from_deg(-179.9999)),
              egm96_table_m(rad_from_deg(-5.0), rad_from_deg(179.9999)),
              0.01);
}

TEST(Geoid, AConstantServesWhereTheDatumsGridIsMissing) {
  std::vector<std::string> warnings;
  const auto model = choose_geoid(VerticalDatum::kNavd88, -20.0, 0.0, 0.0, "f.tif", warnings);
  ASSERT_TRUE(model);  // NAVD88's grids end at North America
  EXPECT_EQ(model->constant_m, -20.0);
  EXPECT_TRUE(warnings.empty());
  const auto without = choose_geoid(VerticalDatum::kNavd88, {}, 0.0, 0.0, "f.tif", warnings);
  ASSERT_TRUE(without);
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_NE(warnings[0].find("navd88"), std::string::npos) << warnings[0];
  EXPECT_NE(warnings[0].find("EGM96"), std::string::npos) << warnings[0];
}

TEST(SmoothMap, KeepsItsBoundBetweenItsCheckPoints) {
  const PlaneFunction exact = [](const Eigen::Matrix2Xd& points, Eigen::MatrixXd& values) {
    values.resize(2, points.cols());
    values.row(0) = (points.row(0) * 1e-3).array().sin() * (points.row(1) * 7e-4).array().cos();
    values.row(1) = (points.row(0) * 3e-4 + points.row(1) * 2e-4).array().exp();
    return true;
  };
  const MapRect domain{-1000.0, 200.0, 1500.0, 2500.0};
  const auto map = SmoothMap<2>::fit(domain, exact, 1e-7);
  ASSERT_TRUE(map);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> x(domain.x_min, domain.x_max);
  std::uniform_real_distribution<double> y(domain.y_min, domain.y_max);
  for (int i = 0; i < 2000; ++i) {
    Eigen::Matrix2Xd point(2, 1);
    point << x(random), y(random);
    Eigen::MatrixXd value;
    exact(point, value);
    EXPECT_LT(((*map)(point(0, 0), point(1, 0)) - value.col(0)).norm(), 3e-7);
  }
}

TEST(SmoothMap, RefusesWhatIsNotSmooth) {
  const PlaneFunction step = [](const Eigen::Matrix2Xd& points, Eigen::MatrixXd& values) {
    values = (points.row(0).array() > 0.3).cast<double>().matrix();
    return true;
  };
  EXPECT_FALSE(SmoothMap<1>::fit({-1, -1, 1, 1}, step, 1e-3));
}

TEST(HeightGrid, InterpolatesBetweenPostsAndHoldsTheEdge) {
  HeightGrid grid{3, 2, {0, 10, 20, 100, 110, 120}};
  EXPECT_DOUBLE_EQ(grid.bilinear(1, 0), 10);
  EXPECT_DOUBLE_EQ(grid.bilinear(0.5, 0.5), 55);
  EXPECT_DOUBLE_EQ(grid.bilinear(-4, 0.5), 50);
  EXPECT_DOUBLE_EQ(grid.bilinear(9, 9), 120);
}

TEST(HeightGrid, FillsVoidsBetweenTheirNeighboursOnly) {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  HeightGrid grid{4, 4, std::vector<float>(16, 7.0F)};
  grid.at(1, 1) = grid.at(2, 1) = kNan;
  EXPECT_EQ(fill_voids(grid), 2U);
  for (const float height : grid.heights_m) EXPECT_FLOAT_EQ(height, 7.0F);
  HeightGrid empty{2, 1, {kNan, kNan}};
  EXPECT_EQ(fill_voids(empty), 2U);
  EXPECT_TRUE(std::isnan(empty.at(0, 0)));
}

TEST(FileDigest, EqualsThePublishedExample) {
  // FIPS 180-4's example.
  TemporaryFolder folder;
  testing::write_text(folder.path() / "abc", "abc");
  EXPECT_EQ(*file_digest(folder.path() / "abc"),
            "sha256:ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_FALSE(file_digest(folder.path() / "none"));
}

TEST(ImageFile, PngReadsBackExactly) {
  TemporaryFolder folder;
  for (const int channels : {1, 3}) {
    const Image image = testing::textured_image(37, 21, channels);
    ASSERT_TRUE(write_png(folder.path() / "a.png", image));
    const auto read = read_png(folder.path() / "a.png", kMostSidePx);
    ASSERT_TRUE(read) << read.error().message;
    EXPECT_EQ(read->channels, channels);
    EXPECT_EQ(read->data, image.data);
  }
  int files = 0;
  for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(folder.path())) {
    ++files;
  }
  EXPECT_EQ(files, 1) << "no side-car file";
}

TEST(ImageFile, DeepPngReadsBackExactlyWithSixteenBitSamples) {
  TemporaryFolder folder;
  for (const int channels : {1, 3}) {
    Image16 image(41, 23, channels);
    for (std::size_t i = 0; i < image.data.size(); ++i) {
      image.data[i] = static_cast<std::uint16_t>(i * 2654435761U >> 7U);
    }
    ASSERT_TRUE(write_png(folder.path() / "a.png", image));
    const auto read = read_png16(folder.path() / "a.png", kMostSidePx);
    ASSERT_TRUE(read) << read.error().message;
    EXPECT_EQ(read->channels, channels);
    EXPECT_EQ(read->data, image.data);
    // The header's bit depth: RFC 2083, section 4.1.1.
    EXPECT_EQ(testing::read_text(folder.path() / "a.png")[24], 16);
    EXPECT_FALSE(read_png(folder.path() / "a.png", kMostSidePx)) << "would lose the low 8 bits";
  }
  ASSERT_TRUE(write_png(folder.path() / "b.png", Image(2, 2, 1)));
  EXPECT_FALSE(read_png16(folder.path() / "b.png", kMostSidePx));
  EXPECT_FALSE(write_png(folder.path() / "c.png", Image16()));
}

TEST(ImageFile, IsBlackWhereThePaletteHasNoColour) {
  TemporaryFolder folder;
  const auto file = folder.path() / "a.png";
  ASSERT_TRUE(write_png(file, Image(1, 1, 1)));  // registers the drivers
  GDALDriverManager& drivers = *GetGDALDriverManager();
  const GDALDatasetUniquePtr memory(
      drivers.GetDriverByName("MEM")->Create("", 3, 1, 1, GDT_Byte, nullptr));
  GDALColorTable palette;
  const GDALColorEntry red{200, 20, 30, 255};
  palette.SetColorEntry(0, &red);
  palette.SetColorEntry(1, &red);
  GDALRasterBand& band = *memory->GetRasterBand(1);
  ASSERT_EQ(band.SetColorTable(&palette), CE_None);
  std::uint8_t indices[] = {1, 5, 0};
  ASSERT_EQ(band.RasterIO(GF_Write, 0, 0, 3, 1, indices, 3, 1, GDT_Byte, 0, 0, nullptr), CE_None);
  const GdalMessages quiet;
  GDALClose(drivers.GetDriverByName("PNG")->CreateCopy(
      file.c_str(), memory.get(), FALSE, nullptr, nullptr, nullptr));
  const auto read = read_png(file, kMostSidePx);
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->data, (std::vector<std::uint8_t>{200, 20, 30, 0, 0, 0, 200, 20, 30}));
}

TEST(ImageFile, RefusesASizeAboveTheLimit) {
  TemporaryFolder folder;
  const auto file = folder.path() / "a.png";
  ASSERT_TRUE(write_png(file, Image(40, 20, 1)));
  EXPECT_TRUE(read_png(file, 40));
  const auto wide = read_png(file, 39);
  ASSERT_FALSE(wide);
  EXPECT_EQ(wide.error().message, file.string() + ": 40 x 20 px: must be at most 39 a side");
  ASSERT_TRUE(write_png(file, Image16(20, 40, 3)));
  EXPECT_FALSE(read_png16(file, 39)) << "too high";
}

TEST(ImageFile, RefusesAPgmThatIsShorterThanItsSamples) {
  TemporaryFolder folder;
  const auto file = folder.path() / "a.pgm";
  const std::string header = "P5\n40 20\n65535\n";
  const std::string samples(std::size_t{2} * 40 * 20, 'x');
  testing::write_text(file, header + samples);
  EXPECT_TRUE(read_png16(file, kMostSidePx));
  testing::write_text(file, header + "ab");
  const auto cut = read_png16(file, kMostSidePx);
  ASSERT_FALSE(cut);
  EXPECT_EQ(cut.error().message,
            file.string() + ": 17 bytes: must be at least 1600 for 40 x 20 px");
}

TEST(ImageFile, ErrorsNameTheFile) {
  TemporaryFolder folder;
  const Status empty = write_png(folder.path() / "a.png", Image());
  ASSERT_FALSE(empty);
  EXPECT_EQ(empty.error().code, ErrorCode::kInvalidArgument);
  const Status lost = write_png(folder.path() / "no" / "a.png", Image(2, 2, 1));
  ASSERT_FALSE(lost);
  EXPECT_NE(lost.error().message.find("a.png"), std::string::npos);
  EXPECT_FALSE(read_png(folder.path() / "none.png", kMostSidePx));
}

TEST(ImageFile, DepthKeepsMetresAndSky) {
  TemporaryFolder folder;
  DepthImage depth(3, 2, 1, 310.25F);
  depth.at(2, 1) = std::numeric_limits<float>::infinity();
  ASSERT_TRUE(write_geotiff_depth(folder.path() / "d.tif", depth));
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "d.tif"));
  EXPECT_FALSE(write_geotiff_depth(folder.path() / "e.tif", DepthImage()));
}

}  // namespace
}  // namespace overfly::terrain
