#include "server/experiments/service/sweep_files.hpp"

#include <algorithm>
#include <string>
#include <system_error>
#include <vector>

#include "server/experiments/sweep_document.hpp"
#include "server/files/plain_name.hpp"
#include "server/files/whole_file.hpp"

namespace overfly::server::experiments {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

constexpr std::size_t kMostFiles = 1000;

Json file_entry(const fs::path& file) {
  const std::string name = file.stem().string();
  const Result<Sweep> sweep = load_sweep(file);
  if (!sweep) {
    return {{"name", name}, {"title", name}, {"description", ""}, {"error", sweep.error().message}};
  }
  return {{"name", name},
          {"title", sweep->title.empty() ? name : sweep->title},
          {"description", sweep->document.at("description")},
          {"error", nullptr}};
}

/// By name.
std::vector<fs::path> json_files_in(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code failed;
  for (fs::directory_iterator entry(folder, failed), end;
       !failed && entry != end && files.size() < kMostFiles;
       entry.increment(failed)) {
    const fs::path& file = entry->path();
    if (file.extension() == ".json" && is_plain_name(file.filename().string())) {
      files.push_back(file);
    }
  }
  std::sort(files.begin(), files.end());
  return files;
}

}  // namespace

fs::path sweep_files_folder(const fs::path& scenarios_folder) {
  return fs::absolute(scenarios_folder / "sweeps").lexically_normal();
}

Json sweep_file_list(const fs::path& folder) {
  Json list = Json::array();
  for (const fs::path& file : json_files_in(folder)) list.push_back(file_entry(file));
  return list;
}

Json published_file_list(const fs::path& folder) {
  Json names = Json::array();
  for (const fs::path& file : json_files_in(folder / "published")) {
    names.push_back(file.stem().string());
  }
  return names;
}

Result<fs::path> published_file(const fs::path& folder, const std::string& name) {
  const fs::path file = folder / "published" / (name + ".json");
  std::error_code ignored;
  if (is_plain_name(name) && fs::is_regular_file(file, ignored)) return file;
  return Error{ErrorCode::kNotFound, "published errors \"" + name + "\": no such file"};
}

Result<Json> sweep_file_document(const fs::path& folder, const std::string& name) {
  const fs::path file = folder / (name + ".json");
  std::error_code ignored;
  if (!is_plain_name(name) || !fs::is_regular_file(file, ignored)) {
    return Error{ErrorCode::kNotFound, "sweep file \"" + name + "\": no such file"};
  }
  return read_json(file, kMaxSweepBytes);
}

}  // namespace overfly::server::experiments
