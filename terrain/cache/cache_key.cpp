#include "terrain/cache/cache_key.hpp"

#include <algorithm>
#include <chrono>
#include <nlohmann/json.hpp>
#include <set>

#include "terrain/files/file_digest.hpp"
#include "terrain/place/geoid.hpp"
#include "terrain/raster/source_files.hpp"

namespace overfly::terrain {
namespace fs = std::filesystem;
namespace {

using Json = nlohmann::ordered_json;

fs::path home_of(const WorldSpec& spec) { return fs::absolute(spec.cache_folder).parent_path(); }

std::string relative_name(const WorldSpec& spec, const fs::path& file) {
  return fs::absolute(file).lexically_normal().lexically_proximate(home_of(spec)).generic_string();
}

template <typename Layer>
Json layer_fields(const WorldSpec& spec, const Layer& layer) {
  Json json{{"file", relative_name(spec, layer.file)}};
  if (layer.crs) json["crs"] = *layer.crs;
  if (layer.nodata) json["nodata"] = *layer.nodata;
  return json;
}

}  // namespace

std::string cache_fields(const WorldSpec& spec) {
  Json json;
  json["version"] = kCacheVersion;
  for (const ImageryLayer& layer : spec.imagery) {
    Json fields = layer_fields(spec, layer);
    if (layer.range) fields["range"] = *layer.range;
    json["imagery"].push_back(fields);
  }
  for (const ElevationLayer& layer : spec.elevation) {
    Json fields = layer_fields(spec, layer);
    fields["datum"] = to_string(layer.datum);
    if (layer.geoid_separation_m) fields["geoid_separation_m"] = *layer.geoid_separation_m;
    if (layer.unit_m) fields["unit_m"] = *layer.unit_m;
    json["elevation"].push_back(fields);
  }
  if (spec.origin) json["origin"] = {spec.origin->lat_rad, spec.origin->lon_rad};
  return json.dump();
}

Result<std::vector<CacheSource>> cache_sources(const WorldSpec& spec) {
  std::set<fs::path> files;
  for (const ImageryLayer& layer : spec.imagery) {
    const Status added = add_source_files(layer.file, files);
    if (!added) return added.error();
  }
  for (const ElevationLayer& layer : spec.elevation) {
    const Status added = add_source_files(layer.file, files);
    if (!added) return added.error();
  }
  std::vector<CacheSource> sources;
  for (const fs::path& file : files) {
    std::error_code failed;
    if (!fs::is_regular_file(file, failed)) continue;  // may appear next to a raster
    CacheSource source;
    source.file = relative_name(spec, file);
    source.size_bytes = fs::file_size(file, failed);
    if (failed) return Error{ErrorCode::kNotFound, file.string() + ": " + failed.message()};
    source.modified_ns = std::chrono::duration_cast<std::chrono::nanoseconds>(
                             fs::last_write_time(file, failed).time_since_epoch())
                             .count();
    sources.push_back(std::move(source));
  }
  return sources;
}

fs::path source_path(const WorldSpec& spec, const CacheSource& source) {
  return (home_of(spec) / source.file).lexically_normal();
}

std::string source_changes(const WorldSpec& spec,
                           const std::vector<CacheSource>& before,
                           const std::vector<CacheSource>& now) {
  for (const CacheSource& source : now) {
    const auto old = std::find_if(before.begin(), before.end(), [&](const CacheSource& other) {
      return other.file == source.file;
    });
    if (old == before.end()) return source.file + " is new";
    if (old->size_bytes != source.size_bytes) return source.file + " has a different size";
    if (old->modified_ns == source.modified_ns) continue;
    if (digest_is_sampled(old->digest)) return source.file + " has another modification time";
    const auto digest = file_digest(source_path(spec, source));
    if (!digest || *digest != old->digest) return source.file + " has changed";
  }
  if (before.size() != now.size()) return "a file was removed";
  return "";
}

}  // namespace overfly::terrain
