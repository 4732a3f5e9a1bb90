#include "terrain/datum_shift.hpp"

#include <cpl_conv.h>
#include <proj.h>

#include <cmath>
#include <cstdio>

namespace overfly::terrain {
namespace {

struct ContextCloser {
  void operator()(PJ_CONTEXT* context) const { proj_context_destroy(context); }
};
struct ObjectCloser {
  void operator()(PJ* object) const { proj_destroy(object); }
};
using Context = std::unique_ptr<PJ_CONTEXT, ContextCloser>;
using Object = std::unique_ptr<PJ, ObjectCloser>;

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
  const Context context(proj_context_create());
  proj_log_level(context.get(), PJ_LOG_NONE);
  const Object raw(
      proj_create_crs_to_crs(context.get(), wkt_of(crs).c_str(), "EPSG:4326", nullptr));
  if (!raw) return std::nullopt;
  const Object transform(proj_normalize_for_visualization(context.get(), raw.get()));
  if (!transform) return std::nullopt;
  proj_trans(transform.get(), PJ_FWD, proj_coord(x, y, 0.0, 0.0));
  const Object used(proj_trans_get_last_used_operation(transform.get()));
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
           " is taken for WGS84, since no PROJ grid between them is installed: positions may be "
           "wrong by 100 m or more";
  }
  char text[32];
  std::snprintf(text, sizeof(text), "%.0f", accuracy_m);
  return file + ": without a PROJ grid, " + datum + " is related to WGS84 only to about " + text +
         " m";
}

}  // namespace overfly::terrain
