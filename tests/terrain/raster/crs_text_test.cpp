#include "terrain/raster/crs_text.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <ogr_spatialref.h>

#include <memory>

namespace overfly::terrain {
namespace {

using ::testing::HasSubstr;

std::string wkt_of(int epsg, const char* format) {
  OGRSpatialReference crs;
  crs.importFromEPSG(epsg);
  const std::string option = std::string("FORMAT=") + format;
  const char* const options[] = {option.c_str(), nullptr};
  char* text = nullptr;
  crs.exportToWkt(&text, options);
  const std::unique_ptr<char, decltype(&CPLFree)> owner(text, &CPLFree);
  return text;
}

TEST(CrsText, TakesCodesWktAndProjTexts) {
  for (const std::string& text : {std::string("EPSG:32616"),
                                  std::string("epsg:26916+5703"),
                                  std::string("ESRI:102003"),
                                  std::string("OGC:CRS84"),
                                  std::string("+proj=utm +zone=16 +datum=WGS84"),
                                  std::string("+proj=lcc +lat_1=43 +lat_2=45.5 +lat_0=41.75 "
                                              "+lon_0=-120.5 +x_0=399999.9999984 +y_0=0 "
                                              "+ellps=GRS80 +to_meter=1200/3937 +no_defs"),
                                  std::string("+proj=merc +a=6378137 +b=6378137 +nadgrids=@null"),
                                  std::string(R"(GEOGCS["an Extension = b",DATUM["d",)"
                                              R"(SPHEROID["s",6378137,298.2]]])"),
                                  std::string("+proj=longlat +datum=WGS84 "
                                              "+geoidgrids=us_nga_egm96_15.tif +vunits=m"),
                                  wkt_of(32616, "WKT1_GDAL"),
                                  wkt_of(32616, "WKT2_2019"),
                                  wkt_of(3857, "WKT1_GDAL"),  // has an extension with +nadgrids
                                  wkt_of(4326, "WKT1_ESRI"),
                                  wkt_of(9518, "WKT2_2019")}) {
    const Status status = check_crs_text(text, "crs");
    EXPECT_TRUE(status.ok()) << (status ? "" : status.error().message);
  }
}

TEST(CrsText, RefusesWhatNamesAFileOrAnAddress) {
  const std::string geogcs = R"(GEOGCS["a",DATUM["d",SPHEROID["s",6378137,298.2]],PRIMEM["g",0],)";
  for (const std::string& text :
       {std::string("http://127.0.0.1:1/crs"),
        std::string("https://example.org/EPSG/4326"),
        std::string("/vsicurl/http://127.0.0.1:1/a.wkt"),
        std::string("/etc/passwd"),
        std::string("secret.prj"),
        std::string("ESRI::/etc/passwd"),
        std::string("urn:ogc:def:crs:EPSG::4326"),
        std::string("IGNF:/etc/passwd"),
        std::string("+init=epsg:4326"),
        std::string("+init=/etc/passwd:x +proj=utm"),
        std::string("+proj=utm +zone=16 +nadgrids=/etc/passwd"),
        std::string("+proj=utm +zone=16 +nadgrids=@/etc/passwd,null"),
        std::string("+proj=utm +zone=16 +nadgrids=../secret.gsb"),
        std::string("+proj=utm +zone=16 +nadgrids=@x, /etc/passwd"),
        std::string("+proj=utm +zone=16 +nadgrids = /etc/passwd"),
        std::string("+proj=utm +zone=16 +geoidgrids=http://127.0.0.1:1/a.tif"),
        std::string("+proj=utm +zone=16 +NADGRIDS=~/a.gsb"),
        std::string("+proj=defmodel +model=/etc/passwd"),
        std::string("+proj=tinshift +file=/etc/passwd"),
        geogcs + R"(UNIT["degree",0.01],EXTENSION["PROJ4","+proj=longlat +nadgrids=/etc/passwd"]])",
        geogcs + R"(UNIT["degree",0.01],Extension [ "PROJ4_GRIDS" , "/etc/passwd" ]])",
        std::string(
            R"(BOUNDCRS[SOURCECRS[x],ABRIDGEDTRANSFORMATION[PARAMETERFILE["g","/etc/x"]]])"),
        // Printed quotes, doubled ones, none: PROJ reads all of them.
        geogcs +
            "EXTENSION[\xE2\x80\x9CPROJ4_GRIDS\xE2\x80\x9D,\"/etc/x\"],AUTHORITY[\"a\",\"b\"]]",
        geogcs + R"(EXTENSION["a""b","PROJ4_GRIDS","/etc/x"],AUTHORITY["a","b"]])",
        geogcs + R"(EXTENSION[PROJ4_GRIDS,/etc/x],AUTHORITY["a","b"]])",
        geogcs + R"(EXTENSION["PROJ4_GRIDS",/etc/x],AUTHORITY["a","b"]])",
        geogcs + R"(EXTENSION["PROJ4_GRIDS","a"/etc/x"b"],AUTHORITY["a","b"]])",
        geogcs + R"(EXTENSION["PROJ4_GRIDS","/etc/x)",
        // A method may be a PROJ text; strings that touch other text are one.
        std::string(R"(BOUNDCRS[SOURCECRS[x],ABRIDGEDTRANSFORMATION[METHOD[)"
                    R"("PROJ-based operation method: proj=vgridshift grids="/etc/x" "]]])"),
        std::string(R"(BOUNDCRS[SOURCECRS[x],ABRIDGEDTRANSFORMATION[METHOD[)"
                    R"("PROJ-based operation method: proj=vgridshift grids=/etc/x"]]])"),
        std::string(R"(BOUNDCRS[SOURCECRS[x],ABRIDGEDTRANSFORMATION[METHOD[)"
                    R"("PROJ tinshift file=/etc/x"]]])"),
        std::string("{\"type\": \"GeographicCRS\"}"),
        std::string("<gml:CRS/>"),
        std::string("EPSG:32616") + '\0' + "x",
        std::string(),
        std::string(1'000'000, 'A') + "[",
        "PROJCS[" + std::string(1'000'000, '[')}) {
    const Status status = check_crs_text(text, "imagery.0.crs");
    ASSERT_FALSE(status.ok()) << text;
    EXPECT_EQ(status.error().code, ErrorCode::kInvalidArgument);
    EXPECT_THAT(status.error().message, HasSubstr("imagery.0.crs = \""));
    EXPECT_THAT(status.error().message, HasSubstr("must be an authority's code"));
    EXPECT_LT(status.error().message.size(), 300U);
  }
}

}  // namespace
}  // namespace overfly::terrain
