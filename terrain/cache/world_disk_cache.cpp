#include "terrain/cache/world_disk_cache.hpp"

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>

#include "core/measure/sha256.hpp"
#include "core/outside/file_text.hpp"
#include "core/outside/outside_json.hpp"
#include "terrain/cache/chunk_file.hpp"
#include "terrain/floor_div.hpp"
#include "terrain/raster/area_average.hpp"

namespace overfly::terrain {
namespace fs = std::filesystem;
namespace {

using Json = nlohmann::ordered_json;

std::string chunk_name(int column, int row) {
  return "x" + std::to_string(column) + "y" + std::to_string(row) + ".chunk";
}

HeightSurvey survey_from(const Json& json) {
  HeightSurvey survey{json.at("lowest_m").get<double>(),
                      json.at("highest_m").get<double>(),
                      json.at("posts").get<double>(),
                      json.at("voids").get<double>(),
                      json.at("implausible").get<double>(),
                      json.at("implausible_layers").get<std::vector<bool>>(),
                      json.at("steep").get<double>(),
                      json.at("steepest_m").get<double>(),
                      {}};
  for (const Json& voids : json.at("undeclared")) {
    survey.undeclared.push_back({voids.at("posts").get<double>(),
                                 voids.at("of_posts").get<double>(),
                                 voids.at("values").get<std::vector<float>>()});
  }
  return survey;
}

Json json_of(const HeightSurvey& survey) {
  Json json = {{"lowest_m", survey.lowest_m},
               {"highest_m", survey.highest_m},
               {"posts", survey.posts},
               {"voids", survey.voids},
               {"implausible", survey.implausible},
               {"implausible_layers", survey.implausible_layers},
               {"steep", survey.steep},
               {"steepest_m", survey.steepest_m},
               {"undeclared", Json::array()}};
  for (const UndeclaredVoids& voids : survey.undeclared) {
    json["undeclared"].push_back(
        {{"posts", voids.posts}, {"of_posts", voids.of_posts}, {"values", voids.values}});
  }
  return json;
}

CacheHeader header_from(const Json& json) {
  CacheHeader header;
  header.fields = json.at("fields").get<std::string>();
  for (const Json& source : json.at("sources")) {
    header.sources.push_back({source.at("file").get<std::string>(),
                              source.at("size_bytes").get<std::uint64_t>(),
                              source.at("modified_ns").get<std::int64_t>(),
                              source.at("digest").get<std::string>()});
  }
  header.layout = json.at("layout").get<std::string>();
  for (const Json& level : json.at("chunks")) {
    auto& chunks = header.chunks.emplace_back();
    for (const Json& chunk : level) chunks.insert({chunk.at(0).get<int>(), chunk.at(1).get<int>()});
  }
  header.levels = static_cast<int>(header.chunks.size());
  header.survey = survey_from(json.at("heights"));
  if (json.contains("far_heights")) header.far_survey = survey_from(json.at("far_heights"));
  for (const Json& masked : json.at("masked")) header.masked.push_back(masked.get<bool>());
  header.bytes = json.at("bytes").get<std::uint64_t>();
  return header;
}

std::string check_of(const Json& json) {
  const std::string text = json.dump();
  return sha256_hex({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
}

/// Empty if the file is incomplete or of another version.
std::optional<CacheHeader> read_header(const fs::path& file) {
  // Large worlds have one entry for each of tens of thousands of chunks.
  constexpr std::uint64_t kMaxBytes = std::uint64_t{64} << 20U;
  const Result<std::string> text = read_file_text(file, kMaxBytes);
  if (!text) return std::nullopt;
  Result<Json> json = json_from_outside<Json>(*text, file.string());
  if (!json) return std::nullopt;
  try {
    const auto check = json->at("check").get<std::string>();
    json->erase("check");
    if (check != check_of(*json)) return std::nullopt;
    CacheHeader header = header_from(*json);
    const Result<Json> fields = json_from_outside<Json>(header.fields, file.string());
    if (!fields || fields->at("version") != kCacheVersion) return std::nullopt;
    return header;
  } catch (const Json::exception&) {
    return std::nullopt;
  }
}

}  // namespace

fs::path tile_chunk_path(const fs::path& folder, int level, int column, int row) {
  return folder / "tiles" / std::to_string(level) / chunk_name(column, row);
}

fs::path height_chunk_path(
    const fs::path& folder, HeightReach reach, int level, int column, int row) {
  const char* const name = reach == HeightReach::kNear ? "heights" : "far_heights";
  return folder / name / std::to_string(level) / chunk_name(column, row);
}

fs::path validity_path(const fs::path& folder, int layer) {
  return folder / ("validity-" + std::to_string(layer));
}

Status write_header(const fs::path& folder, const CacheHeader& header) {
  Json json;
  json["fields"] = header.fields;
  json["sources"] = Json::array();
  for (const CacheSource& source : header.sources) {
    json["sources"].push_back({{"file", source.file},
                               {"size_bytes", source.size_bytes},
                               {"modified_ns", source.modified_ns},
                               {"digest", source.digest}});
  }
  json["layout"] = header.layout;
  json["chunks"] = Json::array();
  for (const auto& level : header.chunks) {
    Json list = Json::array();
    for (const auto& [column, row] : level) list.push_back({column, row});
    json["chunks"].push_back(std::move(list));
  }
  json["heights"] = json_of(header.survey);
  if (header.far_survey) json["far_heights"] = json_of(*header.far_survey);
  json["masked"] = header.masked;
  json["bytes"] = header.bytes;
  json["check"] = check_of(json);
  const std::string text = json.dump(1) + "\n";
  return write_whole(folder / "cache.json",
                     {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
}

WorldDiskCache::Found WorldDiskCache::find(const WorldSpec& spec) {
  Found found;
  std::error_code failed;
  if (spec.cache_folder.empty() || !fs::is_directory(spec.cache_folder, failed)) return found;
  std::vector<fs::path> folders;
  for (fs::directory_iterator entry(spec.cache_folder, failed), end; !failed && entry != end;
       entry.increment(failed)) {
    std::error_code none;
    if (fs::is_regular_file(entry->path() / "cache.json", none)) folders.push_back(entry->path());
  }
  std::sort(folders.begin(), folders.end());
  if (folders.empty()) return found;
  const auto now = cache_sources(spec);
  if (!now) return found;  // opening the world will report the error
  const std::string fields = cache_fields(spec);
  for (const fs::path& folder : folders) {
    auto header = read_header(folder / "cache.json");
    if (!header) {
      found.stale = "its cache.json is damaged or of another version";
      continue;
    }
    found.stale = header->fields != fields ? "the manifest has changed"
                                           : source_changes(spec, header->sources, *now);
    if (!found.stale.empty()) continue;
    found.cache = std::make_shared<const WorldDiskCache>(folder, std::move(*header));
    return found;
  }
  return found;
}

Result<Tile> WorldDiskCache::tile(const TileId& id) const {
  const int column = floor_div(id.col, kChunkTiles);
  const int row = floor_div(id.row, kChunkTiles);
  const auto& chunks = header_.chunks[static_cast<std::size_t>(id.level)];
  if (!chunks.contains({column, row})) return void_patch(kTileSide, kTileSide);
  const fs::path file = tile_chunk_path(folder_, id.level, column, row);
  const int index = (id.row - row * kChunkTiles) * kChunkTiles + (id.col - column * kChunkTiles);
  auto piece = read_piece(file, index);
  if (!piece) return piece.error();
  if (piece->empty()) return void_patch(kTileSide, kTileSide);
  auto tile = unpack_tile(*piece);
  if (!tile) return Error{ErrorCode::kIo, file.string() + ": contains a tile that cannot be read"};
  return std::move(*tile);
}

const HeightSurvey* WorldDiskCache::survey(HeightReach reach) const {
  if (reach == HeightReach::kNear) return &header_.survey;
  return header_.far_survey ? &*header_.far_survey : nullptr;
}

Result<HeightGrid> WorldDiskCache::block(HeightReach reach, int level, int column, int row) const {
  const fs::path file =
      height_chunk_path(folder_, reach, level, column / kChunkBlocks, row / kChunkBlocks);
  auto piece = read_piece(file, (row % kChunkBlocks) * kChunkBlocks + column % kChunkBlocks);
  if (!piece) return piece.error();
  auto grid = unpack_heights(*piece);
  if (!grid) {
    return Error{ErrorCode::kIo, file.string() + ": contains heights that cannot be read"};
  }
  return std::move(*grid);
}

Result<std::optional<ValidityGrid>> WorldDiskCache::validity(int layer,
                                                             int width_px,
                                                             int height_px) const {
  const auto index = static_cast<std::size_t>(layer);
  if (index >= header_.masked.size() || !header_.masked[index]) {
    return std::optional<ValidityGrid>();
  }
  const fs::path file = validity_path(folder_, layer);
  auto piece = read_piece(file, 0);
  if (!piece) return piece.error();
  const auto bytes = unpack_bytes(*piece);
  auto grid = bytes ? ValidityGrid::from_bytes(*bytes, width_px, height_px) : std::nullopt;
  if (!grid) return Error{ErrorCode::kIo, file.string() + ": is damaged"};
  return grid;
}

}  // namespace overfly::terrain
