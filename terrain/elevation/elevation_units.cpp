#include "terrain/elevation/elevation_units.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/text/lower_case.hpp"

namespace overfly::terrain {
namespace {

constexpr double kFootM = 0.3048;
constexpr double kUsSurveyFootM = 1200.0 / 3937.0;

bool is_metre(const std::string& unit) {
  return unit == "m" || unit == "metre" || unit == "meter" || unit == "metres" || unit == "meters";
}

}  // namespace

double height_unit_m(GDALDataset& dataset,
                     const ElevationLayer& layer,
                     const OGRSpatialReference& crs,
                     std::vector<std::string>& warnings) {
  if (layer.unit_m) return *layer.unit_m;
  const std::string unit = lower_case(dataset.GetRasterBand(1)->GetUnitType());
  const bool vertical_feet =
      crs.IsVertical() != 0 && std::abs(crs.GetTargetLinearUnits("VERT_CS") - 1.0) > 1e-3;
  if (is_metre(unit) && vertical_feet) {
    warnings.push_back(
        layer.file.string() +
        ": the band gives metres as the unit of heights, its vertical reference system feet; "
        "metres are assumed. If they are feet, the ground is 3.28 times too high: set "
        "\"unit_m\" in the manifest");
  }
  if (is_metre(unit)) return 1.0;
  if (unit.find("us") != std::string::npos && unit.find('f') != std::string::npos) {
    return kUsSurveyFootM;
  }
  if (unit == "ft" || unit == "foot" || unit == "feet") return kFootM;
  if (crs.IsVertical() != 0) return crs.GetTargetLinearUnits("VERT_CS");
  if (!unit.empty()) {
    warnings.push_back(layer.file.string() + ": unit of the heights is \"" + unit +
                       "\", which is unknown; metres are assumed: set \"unit_m\" in the "
                       "manifest if that is wrong");
  } else if (crs.IsProjected() != 0 && std::abs(crs.GetLinearUnits() - 1.0) > 1e-3) {
    warnings.push_back(
        layer.file.string() +
        ": unit of the heights is not given; metres are assumed. If they are feet, the "
        "ground is 3.28 times too high: set \"unit_m\" in the manifest");
  }
  return 1.0;
}

HeightDatum height_datum(const ElevationLayer& layer, const OGRSpatialReference& crs) {
  HeightDatum found{layer.datum, {}};
  if (crs.IsVertical() != 0) {
    const char* name = crs.GetAttrValue("VERT_CS");
    found.named = name != nullptr ? name : "unnamed";
  } else if (crs.GetAxesCount() == 3) {
    found.named = "ellipsoidal height";
  }
  if (found.datum != VerticalDatum::kUnknown) return found;
  const std::string text = lower_case(found.named);
  for (const auto& [word, datum] : {std::pair("navd88", VerticalDatum::kNavd88),
                                    std::pair("egm2008", VerticalDatum::kEgm2008),
                                    std::pair("egm96", VerticalDatum::kEgm96),
                                    std::pair("ellipsoid", VerticalDatum::kEllipsoid)}) {
    if (text.find(word) == std::string::npos) continue;
    found.datum = datum;
    break;
  }
  return found;
}

Status check_height_band(GDALDataset& dataset,
                         const std::string& file,
                         std::vector<std::string>& warnings) {
  GDALRasterBand* band = dataset.GetRasterBand(1);
  if (GDALDataTypeIsComplex(band->GetRasterDataType()) != 0) {
    return Error{ErrorCode::kInvalidArgument, file + ": has complex samples, not heights"};
  }
  if (band->GetRasterDataType() != GDT_Byte) return {};
  if (dataset.GetRasterCount() >= 3 || band->GetColorTable() != nullptr) {
    return Error{ErrorCode::kInvalidArgument,
                 file +
                     ": is an image (8-bit colours), not elevation; is it listed in the wrong "
                     "place?"};
  }
  warnings.push_back(file +
                     ": elevation has 8 bits: 256 heights in steps of one unit, so it may be a "
                     "shaded relief image; the ground will have terraces");
  return {};
}

}  // namespace overfly::terrain
