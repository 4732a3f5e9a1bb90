#include "server/scenario/document/scenario_layers.hpp"

#include <cstdlib>
#include <utility>

namespace overfly::server {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

terrain::VerticalDatum datum_from(const std::string& text) {
  if (text == "ellipsoid") return terrain::VerticalDatum::kEllipsoid;
  if (text == "egm96") return terrain::VerticalDatum::kEgm96;
  if (text == "egm2008") return terrain::VerticalDatum::kEgm2008;
  if (text == "navd88") return terrain::VerticalDatum::kNavd88;
  return terrain::VerticalDatum::kUnknown;
}

std::optional<std::string> text_or_none(const Json& object, const char* key) {
  if (!object.contains(key)) return std::nullopt;
  return object.at(key).get<std::string>();
}

terrain::WorldSpec layers_from(Json& world, const FileResolver& files, const std::string& name) {
  terrain::WorldSpec spec;
  spec.name = name;
  for (Json& entry : world.at("imagery")) {
    spec.imagery.push_back({files.resolve(entry.at("file")),
                            entry.at("attribution").get<std::string>(),
                            text_or_none(entry, "crs")});
  }
  for (Json& entry : world.at("elevation")) {
    terrain::ElevationLayer layer;
    layer.file = files.resolve(entry.at("file"));
    layer.datum = datum_from(entry.value("vertical_datum", ""));
    layer.geoid_separation_m = number_or_none(entry, "geoid_separation_m");
    layer.unit_m = number_or_none(entry, "unit_m");
    layer.attribution = entry.at("attribution").get<std::string>();
    layer.crs = text_or_none(entry, "crs");
    spec.elevation.push_back(std::move(layer));
  }
  spec.ground_height_m = number_or_none(world, "ground_height_m");
  if (world.contains("origin")) {
    const Json& origin = world.at("origin");
    spec.origin = geodetic_from_deg(origin.at("lat_deg").get<double>(),
                                    origin.at("lon_deg").get<double>(),
                                    origin.at("alt_ellipsoid_m").get<double>());
  }
  if (world.contains("runway")) {
    const Json& runway = world.at("runway");
    spec.runway = {rad_from_deg(runway.at("lat_deg").get<double>()),
                   rad_from_deg(runway.at("lon_deg").get<double>()),
                   rad_from_deg(runway.at("heading_deg").get<double>())};
  }
  return spec;
}

}  // namespace

FileResolver::FileResolver(Json& document, fs::path base) : base_(std::move(base)), data_(base_) {
  if (!document.contains("data")) return;
  const char* from_environment = std::getenv("OVERFLY_DATA");
  const bool replaced = from_environment != nullptr && *from_environment != '\0';
  data_ = replaced ? fs::absolute(from_environment) : base_ / document["data"].get<std::string>();
  data_ = data_.lexically_normal();
  document["data"] = data_.string();
  has_data_ = true;
}

fs::path FileResolver::resolve(Json& field) const {
  const std::string text = field.get<std::string>();
  const bool beside_scenario = text.starts_with("./") || text.starts_with("../") || !has_data_;
  fs::path file = ((beside_scenario ? base_ : data_) / text).lexically_normal();
  if (beside_scenario) field = file.string();
  return file;
}

std::optional<double> number_or_none(const Json& object, const char* key) {
  if (!object.contains(key)) return std::nullopt;
  return object.at(key).get<double>();
}

void read_world(Json& document, const FileResolver& files, Scenario& scenario) {
  Json& world = document.at("world");
  if (world.contains("builtin")) {
    scenario.world = Scenario::BuiltinWorld{world.at("builtin").at("seed").get<std::uint64_t>()};
  } else if (world.contains("manifest")) {
    scenario.world = files.resolve(world.at("manifest"));
  } else {
    scenario.world = layers_from(world, files, scenario.name);
  }
}

}  // namespace overfly::server
