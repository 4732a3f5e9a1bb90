#include <gtest/gtest.h>

#include <limits>

#include "core/motion/pose.hpp"
#include "terrain/world.hpp"
#include "tests/support/support.hpp"

namespace overfly::terrain {
namespace {

using testing::TemporaryFolder;

std::string error_of(const std::string& text) {
  TemporaryFolder folder;
  testing::write_text(folder.path() / "world.json", text);
  const auto spec = read_world_manifest(folder.path() / "world.json");
  if (spec) return "no error";
  EXPECT_NE(spec.error().message.find("world.json"), std::string::npos);
  return spec.error().message;
}

TEST(WorldManifest, ReadsBackWhatWasWritten) {
  TemporaryFolder folder;
  WorldSpec spec;
  spec.name = "Here";
  spec.imagery.push_back({folder.path() / "sub" / "a.tif", "Somebody", "EPSG:2994"});
  spec.elevation.push_back(
      {folder.path() / "b.tif", VerticalDatum::kEgm2008, -33.25, 0.3048, "Someone", "EPSG:26916"});
  spec.ground_height_m = 12.5;
  spec.origin = geodetic_from_deg(39.35, -86.03, 210.0);
  spec.runway = WorldSpec::Runway{rad_from_deg(39.36), rad_from_deg(-86.03), rad_from_deg(181.0)};
  ASSERT_TRUE(write_world_manifest(folder.path() / "world.json", spec));
  const auto read = read_world_manifest(folder.path() / "world.json");
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->name, "Here");
  ASSERT_EQ(read->imagery.size(), 1U);
  EXPECT_EQ(read->imagery[0].file, spec.imagery[0].file);
  EXPECT_EQ(read->imagery[0].attribution, "Somebody");
  EXPECT_EQ(read->imagery[0].crs, "EPSG:2994");
  ASSERT_EQ(read->elevation.size(), 1U);
  EXPECT_EQ(read->elevation[0].file, spec.elevation[0].file);
  EXPECT_EQ(read->elevation[0].datum, VerticalDatum::kEgm2008);
  EXPECT_EQ(read->elevation[0].geoid_separation_m, -33.25);
  EXPECT_EQ(read->elevation[0].unit_m, 0.3048);
  EXPECT_EQ(read->ground_height_m, 12.5);
  EXPECT_NEAR(read->origin->lat_rad, spec.origin->lat_rad, 1e-14);
  EXPECT_NEAR(read->runway->heading_rad, spec.runway->heading_rad, 1e-14);
}

TEST(WorldManifest, RefusesDeepJson) {
  EXPECT_NE(error_of(R"({"format_version": )" + std::string(100'000, '['))
                .find("is nested more than 64 deep"),
            std::string::npos);
}

TEST(WorldManifest, NamesFilesInItsFolderRelatively) {
  TemporaryFolder folder;
  WorldSpec spec;
  spec.imagery.push_back({folder.path() / "a.tif", "", {}});
  ASSERT_TRUE(write_world_manifest(folder.path() / "world.json", spec));
  EXPECT_NE(testing::read_text(folder.path() / "world.json").find("\"file\": \"a.tif\""),
            std::string::npos);
}

TEST(WorldManifest, ErrorsNameFieldValueAndLimit) {
  const std::string head = R"({"format_version": 1, "imagery": [{"file": "a.tif"}], )";
  const std::pair<std::string, std::vector<std::string>> cases[] = {
      {R"({"imagery": [{"file": "a.tif"}]})", {"format_version", "missing"}},
      {R"({"format_version": 7, "imagery": [{"file": "a.tif"}]})", {"format_version = 7", "1"}},
      {R"({"format_version": 1})", {"imagery", "missing"}},
      {R"({"format_version": 1, "imagery": "a.tif"})", {"imagery = \"a.tif\"", "array"}},
      {R"({"format_version": 1, "imagery": [{}]})", {"imagery.0.file", "missing"}},
      {R"({"format_version": 1, "imagery": [{"file": 5}]})", {"imagery.0.file = 5", "string"}},
      {R"({"format_version": 1, "imagery": [{"file": "a.tif", "colour": 1}]})",
       {"imagery.0.colour", "unknown field"}},
      {R"({"format_version": 1, "imagery": [{"file": "a.tif", "range": [5, 5]}]})",
       {"imagery.0.range = [5,5]", "LOW < HIGH"}},
      {R"({"format_version": 1, "imagery": [{"file": "a.tif", "range": 255}]})",
       {"imagery.0.range = 255", "two numbers"}},
      {head + R"("elevation": [{"file": "b.tif", "vertical_datum": "msl"}]})",
       {"elevation.0.vertical_datum = \"msl\"", "egm96"}},
      {head + R"("elevation": [{"file": "b.tif", "geoid_separation_m": 400}]})",
       {"elevation.0.geoid_separation_m = 400", "[-150, 150]"}},
      {head + R"("elevation": [{"file": "b.tif", "unit_m": 0}]})", {"elevation.0.unit_m = 0"}},
      {head + R"("origin": {"lat_deg": 91, "lon_deg": 0, "alt_ellipsoid_m": 0}})",
       {"origin.lat_deg = 91", "[-90, 90]"}},
      {head + R"("origin": {"lat_deg": 9, "lon_deg": 0}})", {"origin.alt_ellipsoid_m", "missing"}},
      {head + R"("runway": {"lat_deg": 9, "lon_deg": "x", "heading_deg": 1}})",
       {"runway.lon_deg = \"x\"", "number"}},
      {head + R"("ground_height_m": 1e9})", {"ground_height_m = ", "[-12000, 12000]"}},
      {head + R"("weather": {}})", {"weather", "unknown field"}},
      {R"([1, 2])", {"must be an object"}},
      {R"({"format_version": 1,)", {"line 1, column 22", "syntax error"}},
  };
  for (const auto& [text, parts] : cases) {
    const std::string error = error_of(text);
    for (const std::string& part : parts) {
      EXPECT_NE(error.find(part), std::string::npos) << part << " in: " << error;
    }
  }
}

TEST(WorldManifest, NodataMayBeTheLargestFloat) {
  TemporaryFolder folder;
  constexpr float kLargest = std::numeric_limits<float>::max();
  for (const std::string text : {"-3.4028235e38", "-3.40282347e+38", "-3.4028234663852886e+38"}) {
    testing::write_text(folder.path() / "world.json",
                        R"({"format_version": 1, "imagery": [{"file": "a.tif", "nodata": )" + text +
                            R"(}], "elevation": [{"file": "b.tif", "nodata": )" + text + "}]}");
    const auto spec = read_world_manifest(folder.path() / "world.json");
    ASSERT_TRUE(spec) << spec.error().message;
    EXPECT_EQ(spec->imagery[0].nodata, -kLargest) << text;
    EXPECT_EQ(spec->elevation[0].nodata, -kLargest) << text;
  }
  EXPECT_NE(error_of(R"({"format_version": 1, "imagery": [{"file": "a.tif", "nodata": 1e39}]})")
                .find("imagery.0.nodata = 1e+39"),
            std::string::npos);
}

TEST(WorldManifest, OfAMissingFileIsNotFound) {
  TemporaryFolder folder;
  const auto spec = read_world_manifest(folder.path() / "world.json");
  ASSERT_FALSE(spec);
  EXPECT_EQ(spec.error().code, ErrorCode::kNotFound);
}

}  // namespace
}  // namespace overfly::terrain
