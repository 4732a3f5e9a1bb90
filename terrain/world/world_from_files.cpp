#include "terrain/world/world_from_files.hpp"

#include <algorithm>
#include <cmath>

#include "terrain/raster/gdal_dataset.hpp"
#include "terrain/raster/georeference.hpp"

namespace overfly::terrain {
namespace {

enum class Content { kPicture, kHeights, kEither };

Content content_of(GDALDataset& dataset) {
  GDALRasterBand* band = dataset.GetRasterBand(1);
  const GDALDataType type = band->GetRasterDataType();
  if (dataset.GetRasterCount() >= 2 || band->GetColorTable() != nullptr || type == GDT_Byte) {
    return Content::kPicture;
  }
  const std::string driver = dataset.GetDriver()->GetDescription();
  const bool of_heights = driver == "USGSDEM" || driver == "SRTMHGT" || driver == "DTED";
  const std::string unit = band->GetUnitType();
  if (of_heights || !unit.empty() || type != GDT_UInt16) return Content::kHeights;
  return Content::kEither;
}

/// Approximate size of a pixel on the ground, used for sorting.
double pixel_m(const Georeference& place) {
  const double* g = place.transform.g;
  const double size = std::hypot(g[1], g[4]);
  constexpr double kEarthRadiusM = 6371e3;
  return place.crs.IsGeographic() != 0 ? size * place.crs.GetAngularUnits() * kEarthRadiusM
                                       : size * place.crs.GetLinearUnits();
}

template <typename Layer>
using Sized = std::pair<double, Layer>;

template <typename Layer>
std::vector<Layer> finest_first(std::vector<Sized<Layer>> sized) {
  std::stable_sort(
      sized.begin(), sized.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<Layer> layers;
  layers.reserve(sized.size());
  for (auto& [size, layer] : sized) layers.push_back(std::move(layer));
  return layers;
}

}  // namespace

Result<WorldSpec> world_from_files(const std::vector<std::filesystem::path>& files) {
  std::vector<Sized<ImageryLayer>> pictures;
  std::vector<Sized<ElevationLayer>> heights;
  for (const std::filesystem::path& file : files) {
    const GdalMessages messages;
    auto dataset = open_raster(file);
    if (!dataset) return dataset.error();
    auto place = read_georeference(**dataset, file, {}, messages.empty() ? "" : messages.text());
    if (!place) return place.error();
    const Content content = content_of(**dataset);
    if (content == Content::kEither) {
      return Error{ErrorCode::kInvalidArgument,
                   file.string() +
                       ": one band of 16-bit numbers without a unit may be a picture or heights; "
                       "list it in a manifest, under \"imagery\" or \"elevation\""};
    }
    if (content == Content::kPicture) {
      ImageryLayer layer;
      layer.file = file;
      pictures.emplace_back(pixel_m(*place), layer);
    } else {
      ElevationLayer layer;
      layer.file = file;
      heights.emplace_back(pixel_m(*place), layer);
    }
  }
  if (pictures.empty()) {
    return Error{ErrorCode::kInvalidArgument,
                 "none of the files is a picture; a world needs imagery"};
  }
  WorldSpec spec;
  spec.imagery = finest_first(std::move(pictures));
  spec.elevation = finest_first(std::move(heights));
  return spec;
}

}  // namespace overfly::terrain
