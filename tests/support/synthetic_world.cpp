#include "tests/support/synthetic_world.hpp"

#include <gdal_priv.h>
#include <ogr_spatialref.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <vector>

namespace overfly::testing {
namespace fs = std::filesystem;
namespace {

struct Closer {
  void operator()(GDALDataset* dataset) const { GDALClose(dataset); }
};
using Dataset = std::unique_ptr<GDALDataset, Closer>;

void require(bool good, const std::string& what) {
  if (!good) throw std::runtime_error(what + ": " + CPLGetLastErrorMsg());
}

OGRSpatialReference reference(const std::string& name) {
  OGRSpatialReference crs;
  require(crs.SetFromUserInput(name.c_str()) == OGRERR_NONE, "unknown CRS " + name);
  crs.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  return crs;
}

Dataset create(const fs::path& file,
               int width,
               int height,
               int bands,
               GDALDataType type,
               const CPLStringList& options) {
  GDALAllRegister();
  GDALDriver* driver = GetGDALDriverManager()->GetDriverByName("GTiff");
  Dataset dataset(
      driver->Create(file.c_str(), width, height, bands, type, const_cast<char**>(options.List())));
  require(dataset != nullptr, "cannot create " + file.string());
  return dataset;
}

void place(GDALDataset& dataset, const std::string& crs, double left, double top, double pixel) {
  double transform[6] = {left, pixel, 0.0, top, 0.0, -pixel};
  require(dataset.SetGeoTransform(transform) == CE_None, "cannot set the georeference");
  const OGRSpatialReference spatial = reference(crs);
  require(dataset.SetSpatialRef(&spatial) == CE_None, "cannot set the CRS");
}

/// A number in [0, 1) that only the lattice point decides (an integer hash).
double lattice_value(int x, int y, unsigned seed) {
  unsigned h = static_cast<unsigned>(x) * 0x8da6b343U ^ static_cast<unsigned>(y) * 0xd8163841U ^
               seed * 0xcb1ab31fU;
  h ^= h >> 13U;
  h *= 0x9e3779b1U;
  h ^= h >> 16U;
  h *= 0x85ebca6bU;
  h ^= h >> 13U;
  return h / 4294967296.0;
}

double smooth_noise(double x, double y, unsigned seed) {
  const int i = static_cast<int>(std::floor(x));
  const int j = static_cast<int>(std::floor(y));
  const auto ease = [](double t) { return t * t * (3.0 - 2.0 * t); };
  const double s = ease(x - i);
  const double t = ease(y - j);
  const double north = std::lerp(lattice_value(i, j, seed), lattice_value(i + 1, j, seed), s);
  const double south =
      std::lerp(lattice_value(i, j + 1, seed), lattice_value(i + 1, j + 1, seed), s);
  return std::lerp(north, south, t);
}

}  // namespace

void write_geotiff(const fs::path& file, const GeoTiff& tiff) {
  const Image& image = tiff.image;
  CPLStringList options;
  if (tiff.jpeg) {
    options.SetNameValue("COMPRESS", "JPEG");
    options.SetNameValue("JPEG_QUALITY", "90");
    if (image.channels == 3) options.SetNameValue("PHOTOMETRIC", "YCBCR");
  }
  options.SetNameValue("TILED", "YES");
  if (image.channels == 3) options.SetNameValue("INTERLEAVE", "PIXEL");
  CPLSetThreadLocalConfigOption("GDAL_TIFF_INTERNAL_MASK", "YES");
  Dataset dataset =
      create(file, image.width_px, image.height_px, image.channels, GDT_Byte, options);
  if (tiff.pixel_is_point) dataset->SetMetadataItem("AREA_OR_POINT", "Point");
  place(*dataset, tiff.crs, tiff.left, tiff.top, tiff.pixel);
  require(dataset->RasterIO(GF_Write,
                            0,
                            0,
                            image.width_px,
                            image.height_px,
                            const_cast<std::uint8_t*>(image.data.data()),
                            image.width_px,
                            image.height_px,
                            GDT_Byte,
                            image.channels,
                            nullptr,
                            image.channels,
                            GSpacing{image.channels} * image.width_px,
                            1,
                            nullptr) == CE_None,
          "cannot write " + file.string());
  if (!tiff.valid.empty()) {
    require(dataset->CreateMaskBand(GMF_PER_DATASET) == CE_None, "cannot create a mask");
    require(dataset->GetRasterBand(1)->GetMaskBand()->RasterIO(
                GF_Write,
                0,
                0,
                image.width_px,
                image.height_px,
                const_cast<std::uint8_t*>(tiff.valid.data.data()),
                image.width_px,
                image.height_px,
                GDT_Byte,
                0,
                0,
                nullptr) == CE_None,
            "cannot write the mask");
  }
  if (tiff.overviews > 0) {
    dataset->FlushCache(false);
    std::vector<int> factors;
    for (int i = 1; i <= tiff.overviews; ++i) factors.push_back(1 << i);
    require(dataset->BuildOverviews(
                "AVERAGE", tiff.overviews, factors.data(), 0, nullptr, nullptr, nullptr) == CE_None,
            "cannot build overviews");
  }
  dataset.reset();
  CPLSetThreadLocalConfigOption("GDAL_TIFF_INTERNAL_MASK", nullptr);
}

void write_elevation(const fs::path& file,
                     const ImageBuffer<float>& heights_m,
                     const std::string& crs,
                     double left,
                     double top,
                     double pixel) {
  const Dataset dataset =
      create(file, heights_m.width_px, heights_m.height_px, 1, GDT_Float32, CPLStringList());
  place(*dataset, crs, left, top, pixel);
  constexpr float kNoData = -9999.0F;
  std::vector<float> posts = heights_m.data;
  for (float& height : posts) {
    if (std::isnan(height)) height = kNoData;
  }
  GDALRasterBand* band = dataset->GetRasterBand(1);
  band->SetNoDataValue(kNoData);
  band->SetUnitType("m");
  require(band->RasterIO(GF_Write,
                         0,
                         0,
                         heights_m.width_px,
                         heights_m.height_px,
                         posts.data(),
                         heights_m.width_px,
                         heights_m.height_px,
                         GDT_Float32,
                         0,
                         0,
                         nullptr) == CE_None,
          "cannot write " + file.string());
}

Image textured_image(int width_px, int height_px, int channels, unsigned seed) {
  Image image(width_px, height_px, channels);
  for (int y = 0; y < height_px; ++y) {
    for (int x = 0; x < width_px; ++x) {
      double sum = 0.0;
      double total = 0.0;
      for (int octave = 0; octave < 6; ++octave) {
        const double cell = 1.5 * (1 << octave);
        const double weight = std::sqrt(cell);
        sum += weight * smooth_noise(x / cell, y / cell, seed * 16U + octave);
        total += weight;
      }
      const double value = std::clamp(128.0 + 420.0 * (sum / total - 0.5), 0.0, 255.0);
      for (int c = 0; c < channels; ++c) {
        image.at(x, y, c) = static_cast<std::uint8_t>(value * (1.0 - 0.08 * c));
      }
    }
  }
  return image;
}

Image checkerboard_image(int width_px, int height_px, int square_px) {
  Image image(width_px, height_px, 1);
  for (int y = 0; y < height_px; ++y) {
    for (int x = 0; x < width_px; ++x) {
      const bool light = ((x / square_px) + (y / square_px)) % 2 == 1;
      image.at(x, y) = light ? 220 : 35;
    }
  }
  return image;
}

terrain::WorldSpec write_synthetic_world(const fs::path& folder,
                                         const SyntheticWorldOptions& options) {
  const int zone = static_cast<int>(std::floor((options.lon_deg + 180.0) / 6.0)) + 1;
  const std::string crs = "EPSG:" + std::to_string((options.lat_deg >= 0.0 ? 32600 : 32700) + zone);
  const OGRSpatialReference wgs84 = reference("EPSG:4326");
  const OGRSpatialReference utm = reference(crs);
  const std::unique_ptr<OGRCoordinateTransformation> transform(
      OGRCreateCoordinateTransformation(&wgs84, &utm));
  require(transform != nullptr, "no transformation");
  double x = options.lon_deg;
  double y = options.lat_deg;
  require(transform->Transform(1, &x, &y) != 0, "the middle has no place in " + crs);

  const int side_px = static_cast<int>(std::lround(options.size_m / options.texel_m));
  GeoTiff imagery;
  imagery.image = textured_image(side_px, side_px, 3, options.seed);
  imagery.crs = crs;
  imagery.left = std::floor(x - 0.5 * options.size_m);
  imagery.top = std::ceil(y + 0.5 * options.size_m);
  imagery.pixel = options.texel_m;
  write_geotiff(folder / "imagery.tif", imagery);

  constexpr double kPostM = 10.0;
  constexpr double kMarginM = 300.0;
  const int posts = static_cast<int>((options.size_m + 2.0 * kMarginM) / kPostM) + 1;
  ImageBuffer<float> heights(posts, posts, 1);
  for (int row = 0; row < posts; ++row) {
    for (int column = 0; column < posts; ++column) {
      const double hill = smooth_noise(column / 17.3, row / 17.3, options.seed + 77U) - 0.5;
      heights.at(column, row) = static_cast<float>(options.ground_m + options.relief_m * hill);
    }
  }
  write_elevation(folder / "elevation.tif",
                  heights,
                  crs,
                  imagery.left - kMarginM,
                  imagery.top + kMarginM,
                  kPostM);

  terrain::WorldSpec spec;
  spec.name = "synthetic";
  spec.imagery.push_back({folder / "imagery.tif", "synthetic imagery", {}});
  terrain::ElevationLayer elevation;
  elevation.file = folder / "elevation.tif";
  elevation.datum = terrain::VerticalDatum::kEllipsoid;
  spec.elevation.push_back(elevation);
  return spec;
}

}  // namespace overfly::testing
