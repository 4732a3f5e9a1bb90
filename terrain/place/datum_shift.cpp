#include "terrain/place/datum_shift.hpp"

#include <cpl_conv.h>
#include <proj.h>

#include <cmath>
#include <cstdio>

#include "terrain/place/proj_handles.hpp"

namespace overfly::terrain {
namespace {

std::string wkt_of(const OGRSpatialReference& crs) {
  char* text = nullptr;
  const char* const options[] = {"FORMAT=WKT2_2019", nullptr};
  crs.exportToWkt(&text, options);
  std::string wkt = text != nullptr ? text : "";
  CPLFree(text);
  return wkt;
}

}  // namespace

std::optional<std::string> datum_shift_doubt(const OGRSpatialReference& crs,
                                             double x,
                                             double y,
                                             const std::string& file) {
  const ProjContext context(proj_context_create());
  proj_log_level(context.get(), PJ_LOG_NONE);
  const ProjObject raw(
      proj_create_crs_to_crs(context.get(), wkt_of(crs).c_str(), "EPSG:4326", nullptr));
  if (!raw) return std::nullopt;
  const ProjObject transform(proj_normalize_for_visualization(context.get(), raw.get()));
  if (!transform) return std::nullopt;
  proj_trans(transform.get(), PJ_FWD, proj_coord(x, y, 0.0, 0.0));
  const ProjObject used(proj_trans_get_last_used_operation(transform.get()));
  if (!used) return std::nullopt;
  const bool guess =
      proj_coordoperation_has_ballpark_transformation(context.get(), used.get()) != 0;
  const double accuracy_m = proj_coordoperation_get_accuracy(context.get(), used.get());
  constexpr double kGoodM = 5.0;
  if (!guess && accuracy_m <= kGoodM) return std::nullopt;
  const char* geographic = crs.GetAttrValue("DATUM");
  const std::string datum = geographic != nullptr ? geographic : "its datum";
  if (guess || accuracy_m < 0.0) {
    return file + ": " + datum +
           " is treated as WGS84, since no PROJ grid between them is installed: positions may be "
           "wrong by 100 m or more";
  }
  char text[32];
  std::snprintf(text, sizeof(text), "%.0f", accuracy_m);
  return file + ": without a PROJ grid, " + datum + " is related to WGS84 only to about " + text +
         " m";
}

}  // namespace overfly::terrain
