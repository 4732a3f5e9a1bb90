#include "tests/terrain/raster_file.hpp"

#include <cpl_string.h>
#include <gdal_priv.h>
#include <ogr_spatialref.h>

#include <memory>
#include <stdexcept>

namespace overfly::testing {
namespace {

struct Closer {
  void operator()(GDALDataset* dataset) const { GDALClose(dataset); }
};
using Dataset = std::unique_ptr<GDALDataset, Closer>;

void require(bool good, const std::string& what) {
  if (!good) throw std::runtime_error(what + ": " + CPLGetLastErrorMsg());
}

double texture(int x, int y, int band) {
  unsigned h = static_cast<unsigned>(x / 3) * 0x8da6b343U ^
               static_cast<unsigned>(y / 3) * 0xd8163841U ^ static_cast<unsigned>(band) * 977U;
  h ^= h >> 13U;
  h *= 0x9e3779b1U;
  return static_cast<double>((h >> 16U) % 256U);
}

void fill(GDALDataset& dataset, const RasterFile& raster) {
  std::vector<double> row(static_cast<std::size_t>(raster.width_px));
  for (int band = 1; band <= raster.bands; ++band) {
    GDALRasterBand& out = *dataset.GetRasterBand(band);
    for (int y = 0; y < raster.height_px; ++y) {
      for (int x = 0; x < raster.width_px; ++x) {
        row[static_cast<std::size_t>(x)] =
            raster.value ? raster.value(x, y, band) : texture(x, y, band);
      }
      require(out.RasterIO(GF_Write,
                           0,
                           y,
                           raster.width_px,
                           1,
                           row.data(),
                           raster.width_px,
                           1,
                           GDT_Float64,
                           0,
                           0,
                           nullptr) == CE_None,
              "cannot write values");
    }
    if (raster.alpha_band == band) out.SetColorInterpretation(GCI_AlphaBand);
    if (raster.alpha_band > 0 && band <= 3) {
      constexpr GDALColorInterp kColours[] = {GCI_RedBand, GCI_GreenBand, GCI_BlueBand};
      out.SetColorInterpretation(kColours[band - 1]);
    }
    if (!raster.unit.empty()) out.SetUnitType(raster.unit.c_str());
    if (raster.nodata) out.SetNoDataValue(*raster.nodata);
  }
}

}  // namespace

void write_raster(const std::filesystem::path& file, const RasterFile& raster) {
  GDALAllRegister();
  GDALDriverManager& drivers = *GetGDALDriverManager();
  GDALDriver* driver = drivers.GetDriverByName(raster.driver.c_str());
  require(driver != nullptr, "no driver " + raster.driver);
  const Dataset memory(
      drivers.GetDriverByName("MEM")->Create("",
                                             raster.width_px,
                                             raster.height_px,
                                             raster.bands,
                                             GDALGetDataTypeByName(raster.type.c_str()),
                                             nullptr));
  require(memory != nullptr, "no memory");
  fill(*memory, raster);
  if (raster.transform) {
    std::array<double, 6> transform = *raster.transform;
    require(memory->SetGeoTransform(transform.data()) == CE_None, "no transform");
  }
  if (!raster.crs.empty()) {
    OGRSpatialReference crs;
    require(crs.SetFromUserInput(raster.crs.c_str()) == OGRERR_NONE, "no CRS " + raster.crs);
    crs.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    require(memory->SetSpatialRef(&crs) == CE_None, "no CRS");
  }
  CPLStringList options;
  for (const std::string& option : raster.options) options.AddString(option.c_str());
  const Dataset written(
      driver->CreateCopy(file.c_str(), memory.get(), FALSE, options.List(), nullptr, nullptr));
  require(written != nullptr, "cannot write " + file.string());
}

std::vector<double> read_band(const std::filesystem::path& file, int band) {
  GDALAllRegister();
  const Dataset dataset(GDALDataset::Open(file.c_str(), GDAL_OF_RASTER));
  require(dataset != nullptr, "cannot open " + file.string());
  const int width = dataset->GetRasterXSize();
  const int height = dataset->GetRasterYSize();
  std::vector<double> values(static_cast<std::size_t>(width) * height);
  require(
      dataset->GetRasterBand(band)->RasterIO(
          GF_Read, 0, 0, width, height, values.data(), width, height, GDT_Float64, 0, 0, nullptr) ==
          CE_None,
      "cannot read " + file.string());
  return values;
}

}  // namespace overfly::testing
