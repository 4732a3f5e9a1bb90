#include "server/experiments/studies/study_result.hpp"

#include <algorithm>
#include <string_view>

#include "core/outside/file_text.hpp"
#include "server/experiments/explain/cause.hpp"
#include "server/files/file_stamp.hpp"
#include "server/files/whole_file.hpp"

namespace overfly::server::experiments {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

constexpr std::uint64_t kMaxResultBytes = std::uint64_t{64} << 20U;

/// "runs/RUN" becomes "STUDY.RUN".
void rename_runs(const std::string& study, Json& result) {
  constexpr std::string_view kFolder = "runs/";
  const auto flights = result.find("flights");
  if (flights == result.end() || !flights->is_array()) return;
  for (Json& flight : *flights) {
    const auto run = flight.is_object() ? flight.find("run") : flight.end();
    if (!flight.is_object() || run == flight.end() || !run->is_string()) continue;
    const std::string folder = run->get<std::string>();
    if (folder.starts_with(kFolder)) *run = study + "." + folder.substr(kFolder.size());
  }
}

/// Keeps only some fields of an object.
Json only(const Json& object, std::initializer_list<const char*> names) {
  Json kept = Json::object();
  for (const char* name : names) {
    if (object.is_object() && object.contains(name)) kept[name] = object.at(name);
  }
  return kept;
}

void shorten_prediction(Json& result) {
  const auto instants = result.find("instants");
  if (instants != result.end() && instants->is_array()) {
    for (Json& instant : *instants) {
      instant =
          only(instant, {"t_s", "east_m", "north_m", "height_agl_m", "risk_10_s", "risk_so_far"});
    }
  }
  const auto map = result.find("map");
  if (map != result.end() && map->is_object()) {
    *map = only(*map,
                {"west_m",
                 "south_m",
                 "cell_m",
                 "columns",
                 "rows",
                 "height_agl_m",
                 "speed_m_s",
                 "heading_deg"});
  }
}

Json cause_words() {
  Json words = Json::object();
  for (const Cause cause : all_causes()) words[to_string(cause)] = words_for(cause);
  return words;
}

const char* result_name(StudyKind kind) {
  switch (kind) {
    case StudyKind::kExplain:
      return "explanation.json";
    case StudyKind::kPredict:
      return "predict.json";
    case StudyKind::kHunt:
      return "hunt.json";
  }
  return "";
}

Error absent(const fs::path& folder, const std::string& what) {
  return {ErrorCode::kNotFound,
          "study \"" + folder.filename().string() + "\": it has no " + what + " yet"};
}

}  // namespace

Result<Json> study_result(StudyKind kind, const fs::path& folder) {
  const fs::path file = folder / result_name(kind);
  if (!FileStamp::of(file).exists) return Json(nullptr);
  Result<Json> result = read_json(file, kMaxResultBytes);
  if (!result) return result;
  if (!result->is_object()) {
    return Error{ErrorCode::kUnreadable, file.string() + ": is no JSON object"};
  }
  rename_runs(folder.filename().string(), *result);
  if (kind == StudyKind::kExplain) (*result)["words"] = cause_words();
  if (kind == StudyKind::kPredict) shorten_prediction(*result);
  // The absolute path of the study's input.
  if (kind == StudyKind::kHunt) result->erase("scenario");
  return result;
}

Result<std::string> study_page(StudyKind kind, const fs::path& folder) {
  const fs::path file =
      folder / (kind == StudyKind::kPredict ? "predict.html" : "explanation.html");
  if (kind == StudyKind::kHunt || !FileStamp::of(file).exists) return absent(folder, "page");
  return read_file_text(file, kMaxResultBytes);
}

Result<Json> worst_scenario(const fs::path& folder) {
  const fs::path file = folder / "worst.json";
  if (!FileStamp::of(file).exists) return absent(folder, "worst flight");
  return read_json(file, kMaxResultBytes);
}

}  // namespace overfly::server::experiments
