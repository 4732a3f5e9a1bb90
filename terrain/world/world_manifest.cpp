#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>

#include "core/motion/pose.hpp"
#include "core/outside/file_text.hpp"
#include "core/outside/outside_json.hpp"
#include "terrain/place/geoid.hpp"
#include "terrain/world.hpp"

namespace overfly::terrain {
namespace fs = std::filesystem;
namespace {

using Json = nlohmann::ordered_json;
constexpr int kFormatVersion = 1;
constexpr std::uint64_t kManifestMaxBytes = std::uint64_t{16} << 20U;

std::string shown(const Json& value) {
  std::string text = value.dump();
  constexpr std::size_t kLongest = 60;
  return text.size() > kLongest ? text.substr(0, kLongest) + "..." : text;
}

/// Reads the fields of one JSON object and keeps the first error.
class Fields {
 public:
  Fields(const Json& object, std::string file, std::string path, std::optional<Error>& error)
      : object_(object), file_(std::move(file)), path_(std::move(path)), error_(error) {
    if (!object_.is_object()) fail("", object_, "must be an object");
  }

  void fail(const std::string& field, const Json& value, const std::string& limit) {
    if (error_) return;
    error_ = Error{ErrorCode::kInvalidArgument,
                   file_ + ": " + name(field) + " = " + shown(value) + ": " + limit};
  }
  void missing(const std::string& field) {
    if (!error_) {
      error_ = Error{ErrorCode::kInvalidArgument, file_ + ": " + name(field) + " is missing"};
    }
  }
  /// A field that may be absent.
  const Json* find(const std::string& field) {
    known_.insert(field);
    if (!object_.is_object() || !object_.contains(field)) return nullptr;
    return &object_.at(field);
  }
  std::optional<double> number(const std::string& field, double low, double high) {
    const Json* value = find(field);
    if (value == nullptr) return std::nullopt;
    char limit[80];
    std::snprintf(limit, sizeof(limit), "must be a number in [%g, %g]", low, high);
    if (!value->is_number() || !(value->get<double>() >= low && value->get<double>() <= high)) {
      fail(field, *value, limit);
      return std::nullopt;
    }
    return value->get<double>();
  }
  double required_number(const std::string& field, double low, double high) {
    if (find(field) == nullptr) missing(field);
    return number(field, low, high).value_or(low);
  }
  std::optional<std::string> text(const std::string& field) {
    const Json* value = find(field);
    if (value == nullptr) return std::nullopt;
    if (!value->is_string()) {
      fail(field, *value, "must be a string");
      return std::nullopt;
    }
    return value->get<std::string>();
  }
  [[nodiscard]] std::string name(const std::string& field) const {
    return path_.empty() ? field : field.empty() ? path_ : path_ + "." + field;
  }
  /// Call last: reports fields that were never read, which are probably misspelt.
  void reject_unknown() {
    if (!object_.is_object()) return;
    for (const auto& [key, value] : object_.items()) {
      if (!known_.contains(key)) fail(key, value, "unknown field");
    }
  }

 private:
  const Json& object_;
  std::string file_;
  std::string path_;
  std::optional<Error>& error_;
  std::set<std::string> known_;
};

struct Reader {
  std::string manifest;
  fs::path folder;
  std::optional<Error> error;

  Fields fields(const Json& object, const std::string& path) {
    return {object, manifest, path, error};
  }
  fs::path file_of(Fields& fields) {
    const auto text = fields.text("file");
    if (!text) fields.missing("file");
    const fs::path file = text.value_or("");
    return (folder / file).lexically_normal();
  }

  /// Samples are compared as 32-bit floats. Their largest value is written with few digits as
  /// 3.4028235e+38, which is beyond it.
  static std::optional<double> nodata(Fields& in) {
    constexpr double kWritten = 3.4028235e38;
    constexpr double kLargest = std::numeric_limits<float>::max();
    const std::optional<double> value = in.number("nodata", -kWritten, kWritten);
    return value ? std::optional(std::clamp(*value, -kLargest, kLargest)) : std::nullopt;
  }

  std::optional<std::array<double, 2>> range(Fields& in) {
    const Json* value = in.find("range");
    if (value == nullptr) return std::nullopt;
    const bool numbers = value->is_array() && value->size() == 2 && value->at(0).is_number() &&
                         value->at(1).is_number();
    std::array<double, 2> range{};
    if (numbers) range = {value->at(0).get<double>(), value->at(1).get<double>()};
    if (!(range[0] >= -1e38 && range[0] < range[1] && range[1] <= 1e38)) {
      in.fail("range", *value, "must be [LOW, HIGH], two numbers in [-1e+38, 1e+38], LOW < HIGH");
      return std::nullopt;
    }
    return range;
  }

  ImageryLayer imagery(const Json& object, const std::string& path) {
    Fields in = fields(object, path);
    ImageryLayer layer;
    layer.file = file_of(in);
    layer.attribution = in.text("attribution").value_or("");
    layer.crs = in.text("crs");
    layer.nodata = nodata(in);
    layer.range = range(in);
    in.reject_unknown();
    return layer;
  }

  VerticalDatum datum(Fields& in) {
    const auto text = in.text("vertical_datum");
    if (!text) return VerticalDatum::kUnknown;
    for (const auto datum : {VerticalDatum::kEllipsoid,
                             VerticalDatum::kEgm96,
                             VerticalDatum::kEgm2008,
                             VerticalDatum::kNavd88,
                             VerticalDatum::kUnknown}) {
      if (*text == to_string(datum)) return datum;
    }
    in.fail("vertical_datum", *text, "must be one of ellipsoid, egm96, egm2008, navd88, unknown");
    return VerticalDatum::kUnknown;
  }

  ElevationLayer elevation(const Json& object, const std::string& path) {
    Fields in = fields(object, path);
    ElevationLayer layer;
    layer.file = file_of(in);
    layer.datum = datum(in);
    layer.geoid_separation_m = in.number("geoid_separation_m", -150.0, 150.0);
    layer.unit_m = in.number("unit_m", 1e-4, 1e4);
    layer.attribution = in.text("attribution").value_or("");
    layer.crs = in.text("crs");
    layer.nodata = nodata(in);
    in.reject_unknown();
    return layer;
  }

  template <typename Layer>
  void layers(Fields& in,
              const char* field,
              std::vector<Layer>& out,
              Layer (Reader::*read)(const Json&, const std::string&)) {
    const Json* list = in.find(field);
    if (list == nullptr) return;
    if (!list->is_array()) {
      in.fail(field, *list, "must be an array");
      return;
    }
    for (std::size_t i = 0; i < list->size(); ++i) {
      out.push_back((this->*read)((*list)[i], std::string(field) + "." + std::to_string(i)));
    }
  }

  WorldSpec world(const Json& object) {
    Fields in = fields(object, "");
    WorldSpec spec;
    const double version = in.required_number("format_version", 1, 1e6);
    if (version != kFormatVersion) {
      in.fail("format_version", version, "this program reads version 1");
    }
    spec.name = in.text("name").value_or("");
    in.find("description");
    layers(in, "imagery", spec.imagery, &Reader::imagery);
    layers(in, "elevation", spec.elevation, &Reader::elevation);
    if (spec.imagery.empty() && !error) in.missing("imagery");
    spec.ground_height_m = in.number("ground_height_m", -12000.0, 12000.0);
    if (const Json* origin = in.find("origin")) {
      Fields at = fields(*origin, "origin");
      spec.origin = geodetic_from_deg(at.required_number("lat_deg", -90.0, 90.0),
                                      at.required_number("lon_deg", -180.0, 180.0),
                                      at.required_number("alt_ellipsoid_m", -12000.0, 12000.0));
      at.reject_unknown();
    }
    if (const Json* runway = in.find("runway")) {
      Fields at = fields(*runway, "runway");
      spec.runway =
          WorldSpec::Runway{rad_from_deg(at.required_number("lat_deg", -90.0, 90.0)),
                            rad_from_deg(at.required_number("lon_deg", -180.0, 180.0)),
                            rad_from_deg(at.required_number("heading_deg", -360.0, 360.0))};
      at.reject_unknown();
    }
    in.reject_unknown();
    return spec;
  }
};

/// A path in the manifest's form: relative if the file is in the manifest's folder.
std::string path_in(const fs::path& folder, const fs::path& file) {
  const fs::path relative = fs::absolute(file).lexically_relative(fs::absolute(folder));
  const bool inside = !relative.empty() && *relative.begin() != "..";
  return inside ? relative.generic_string() : fs::absolute(file).generic_string();
}

Json to_json(const WorldSpec& spec, const fs::path& folder) {
  Json json;
  json["format_version"] = kFormatVersion;
  json["name"] = spec.name;
  json["imagery"] = Json::array();
  for (const ImageryLayer& layer : spec.imagery) {
    Json entry{{"file", path_in(folder, layer.file)}};
    if (layer.crs) entry["crs"] = *layer.crs;
    if (layer.nodata) entry["nodata"] = *layer.nodata;
    if (layer.range) entry["range"] = *layer.range;
    if (!layer.attribution.empty()) entry["attribution"] = layer.attribution;
    json["imagery"].push_back(entry);
  }
  for (const ElevationLayer& layer : spec.elevation) {
    Json entry{{"file", path_in(folder, layer.file)}};
    if (layer.datum != VerticalDatum::kUnknown) entry["vertical_datum"] = to_string(layer.datum);
    if (layer.geoid_separation_m) entry["geoid_separation_m"] = *layer.geoid_separation_m;
    if (layer.unit_m) entry["unit_m"] = *layer.unit_m;
    if (layer.crs) entry["crs"] = *layer.crs;
    if (layer.nodata) entry["nodata"] = *layer.nodata;
    if (!layer.attribution.empty()) entry["attribution"] = layer.attribution;
    json["elevation"].push_back(entry);
  }
  if (spec.ground_height_m) json["ground_height_m"] = *spec.ground_height_m;
  if (spec.origin) {
    json["origin"] = {{"lat_deg", deg_from_rad(spec.origin->lat_rad)},
                      {"lon_deg", deg_from_rad(spec.origin->lon_rad)},
                      {"alt_ellipsoid_m", spec.origin->alt_ellipsoid_m}};
  }
  if (spec.runway) {
    json["runway"] = {{"lat_deg", deg_from_rad(spec.runway->lat_rad)},
                      {"lon_deg", deg_from_rad(spec.runway->lon_rad)},
                      {"heading_deg", deg_from_rad(spec.runway->heading_rad)}};
  }
  return json;
}

}  // namespace

Result<WorldSpec> read_world_manifest(const fs::path& manifest, const SourcePolicy& sources) {
  if (sources.confined()) {
    if (Status status = sources.check(manifest, "world.manifest"); !status) return status.error();
  }
  const Result<std::string> text = read_file_text(manifest, kManifestMaxBytes);
  if (!text) return text.error();
  const Result<Json> json = json_from_outside<Json>(*text, manifest.string());
  if (!json) return json.error();
  Reader reader{manifest.string(), manifest.parent_path(), std::nullopt};
  WorldSpec spec = reader.world(*json);
  if (reader.error) return *reader.error;
  spec.cache_folder = cache_folder_of(manifest);
  spec.sources = sources;
  return spec;
}

fs::path cache_folder_of(const fs::path& manifest) {
  fs::path folder = manifest;
  return folder.replace_extension(".cache");
}

Status write_world_manifest(const fs::path& manifest, const WorldSpec& spec) {
  const fs::path part = manifest.string() + ".part";
  const std::string text = to_json(spec, manifest.parent_path()).dump(2) + '\n';
  const Result<std::string> there = read_file_text(manifest, text.size());
  if (there && *there == text) return {};
  {
    std::ofstream out(part, std::ios::binary);
    out << text;
    if (!out.flush()) {
      return Error{ErrorCode::kIo, manifest.string() + ": cannot be written"};
    }
  }
  std::error_code failed;
  fs::rename(part, manifest, failed);
  if (failed) return Error{ErrorCode::kIo, manifest.string() + ": " + failed.message()};
  return {};
}

}  // namespace overfly::terrain
