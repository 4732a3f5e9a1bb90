#include "server/experiments/sweep_folders.hpp"

#include <algorithm>
#include <array>
#include <string>
#include <system_error>
#include <vector>

#include "server/experiments/sweep_document.hpp"
#include "server/experiments/sweep_progress.hpp"
#include "server/files/file_stamp.hpp"
#include "server/files/plain_name.hpp"
#include "server/files/whole_file.hpp"
#include "server/record/run_folder.hpp"
#include "server/record/run_lock.hpp"

namespace overfly::server::experiments {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

constexpr std::size_t kMostListed = 1000;

fs::path sweep_file(const fs::path& folder) { return folder / "sweep.json"; }

Json text_in(const Json& object, const char* name) {
  const auto found = object.find(name);
  return found != object.end() && found->is_string() ? *found : Json("");
}

/// Only the texts of a list.
Json texts_in(const Json& object, const char* name) {
  Json texts = Json::array();
  const auto found = object.find(name);
  if (found == object.end() || !found->is_array()) return texts;
  for (const Json& text : *found) {
    if (text.is_string()) texts.push_back(text);
  }
  return texts;
}

Json axes_with_values(const Json& sweep) {
  Json axes = Json::array();
  const auto found = sweep.find("axes");
  if (found == sweep.end() || !found->is_array()) return axes;
  const Json values = sweep.value("axis_values", Json::object());
  for (const Json& axis : *found) {
    if (!axis.is_object()) continue;
    Json name = text_in(axis, "path");
    if (name == "") name = text_in(axis, "name");
    Json label = text_in(axis, "label");
    if (label == "") label = name;
    const auto of_axis = values.is_object() ? values.find(name.get<std::string>()) : values.end();
    axes.push_back(
        {{"name", name},
         {"label", label},
         {"unit", text_in(axis, "unit")},
         {"values", of_axis != values.end() && of_axis->is_array() ? *of_axis : Json::array()}});
  }
  return axes;
}

/// Time of the last result; of the sweep itself before the first.
std::int64_t changed_ns(const fs::path& folder) {
  const FileStamp results = FileStamp::of(folder / "results.jsonl");
  return results.exists ? results.modified_ns : FileStamp::of(sweep_file(folder)).modified_ns;
}

/// Whether a sweep makes a file or folder of this name. Hidden ones are locks and files that are
/// being written.
bool is_of_sweep(const std::string& name) {
  constexpr std::array<const char*, 9> kNames{"runs",
                                              "scenarios",
                                              "output",
                                              "jobs",
                                              "frame_cache",
                                              "results.jsonl",
                                              "progress.json",
                                              "summary.md",
                                              "envelope.json"};
  return name.starts_with('.') || std::find(kNames.begin(), kNames.end(), name) != kNames.end();
}

/// Checks that a folder has nothing but what a sweep makes.
/// @param kind  what the folder is to become: "sweep"
/// @param mark  the file that each folder of that kind has
Status check_no_other_files(const fs::path& folder,
                            const std::string& kind,
                            const std::string& mark) {
  std::error_code failure;
  for (fs::directory_iterator entry(folder, failure), end; !failure && entry != end;
       entry.increment(failure)) {
    const std::string name = entry->path().filename().string();
    if (is_of_sweep(name)) continue;
    return Error{ErrorCode::kConflict,
                 folder.string() + ": is no folder of a " + kind + " (" + mark +
                     " is missing), and not empty: it has " + name};
  }
  return {};
}

bool has_file(const fs::path& folder, const char* name) {
  return FileStamp::of(folder / name).exists;
}

}  // namespace

Status check_sweep_folder(const fs::path& folder) {
  if (has_file(folder, "hunt.json")) {
    return Error{ErrorCode::kConflict,
                 folder.string() + ": is the folder of a hunt: it has hunt.json"};
  }
  if (has_file(folder, "sweep.json")) return {};
  return check_no_other_files(folder, "sweep", "sweep.json");
}

Status check_hunt_folder(const fs::path& folder) {
  if (has_file(folder, "hunt.json") || has_file(folder, "study.json")) return {};
  if (has_file(folder, "sweep.json")) {
    return Error{ErrorCode::kConflict,
                 folder.string() + ": is the folder of a sweep: it has sweep.json"};
  }
  return check_no_other_files(folder, "hunt", "hunt.json");
}

Result<Json> sweep_entry(const fs::path& sweeps_folder, const std::string& name) {
  const Error absent{ErrorCode::kNotFound, "sweep \"" + name + "\": no such sweep"};
  if (sweeps_folder.empty() || !is_plain_name(name)) return absent;
  const fs::path folder = sweeps_folder / name;
  if (!FileStamp::of(sweep_file(folder)).exists) return absent;
  const Result<Json> sweep = read_json(sweep_file(folder), kMaxSweepBytes);
  if (!sweep) return sweep.error();
  if (!sweep->is_object()) {
    return Error{ErrorCode::kUnreadable, sweep_file(folder).string() + ": is no JSON object"};
  }
  const Json repeats = sweep->value("repeats", Json::object());
  const Json most = repeats.is_object() ? repeats.value("most", Json(1)) : Json(1);
  return Json{{"name", name},
              {"title", text_in(*sweep, "title")},
              {"description", text_in(*sweep, "description")},
              {"version", text_in(*sweep, "version")},
              {"estimators", texts_in(*sweep, "estimator_names")},
              {"repeats", most.is_number_integer() ? most : Json(1)},
              {"axes", axes_with_values(*sweep)},
              {"flying", RunLock::held(folder)},
              {"progress", read_progress(folder)},
              {"changed_utc", utc_text(changed_ns(folder))}};
}

Json sweep_list(const fs::path& sweeps_folder) {
  std::vector<std::pair<std::int64_t, std::string>> found;
  std::error_code failure;
  for (fs::directory_iterator entry(sweeps_folder, failure), end; !failure && entry != end;
       entry.increment(failure)) {
    const std::string name = entry->path().filename().string();
    if (!is_plain_name(name) || !FileStamp::of(sweep_file(entry->path())).exists) continue;
    found.emplace_back(-changed_ns(entry->path()), name);
  }
  std::sort(found.begin(), found.end());
  Json sweeps = Json::array();
  for (const auto& [before_ns, name] : found) {
    if (sweeps.size() >= kMostListed) break;
    if (Result<Json> entry = sweep_entry(sweeps_folder, name)) sweeps.push_back(std::move(*entry));
  }
  return {{"sweeps", std::move(sweeps)}};
}

}  // namespace overfly::server::experiments
