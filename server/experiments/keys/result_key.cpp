#include "server/experiments/keys/result_key.hpp"

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <vector>

#include "core/measure/sha256.hpp"
#include "core/outside/file_text.hpp"
#include "core/outside/outside_json.hpp"
#include "server/experiments/keys/plain_numbers.hpp"
#include "server/experiments/keys/program_files.hpp"
#include "server/experiments/keys/script_modules.hpp"
#include "server/files/file_stamp.hpp"
#include "server/files/program_identity.hpp"
#include "server/files/recent_values.hpp"
#include "server/record/run_folder.hpp"
#include "server/worlds/scenario_world.hpp"

namespace overfly::server::experiments {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

/// Larger files are compared by size and time: imagery of gigabytes is not read for each flight.
constexpr std::uint64_t kMostHashedBytes = std::uint64_t{1} << 20U;
/// Enough for the images of an hour.
constexpr std::size_t kMostFolderFiles = 200'000;

std::string digest_of(const std::string& text) {
  return sha256_hex({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
}

std::string stamp_text(const FileStamp& stamp) {
  return std::to_string(stamp.size_bytes) + " bytes of " + std::to_string(stamp.modified_ns);
}

/// Whether no further change of the files could have their present stamps.
bool are_settled(const std::vector<fs::path>& files) {
  const std::int64_t now_ns = utc_now_ns();
  return std::all_of(files.begin(), files.end(), [&](const fs::path& file) {
    return FileStamp::of(file).settled(now_ns);
  });
}

/// What identifies a file's content. That of a file that has not changed is not read again: a sweep
/// has a key for each of its flights.
std::string content_text(const fs::path& file) {
  static RecentValues<std::string> known(64);
  const std::string stamp = content_key({file});
  if (const auto text = known.find(stamp)) return *text;
  const Result<std::string> content = read_file_text(file, kMostHashedBytes);
  if (!content) return stamp_text(FileStamp::of(file));
  std::string digest = digest_of(*content);
  if (are_settled({file})) known.keep(stamp, std::make_shared<const std::string>(digest));
  return digest;
}

/// The files that may be read, and the text that they are added to.
struct NamedFiles {
  SourcePolicy sources;
  std::string text;
  std::set<fs::path> added;
};

/// Where the files that a document names lie.
struct NameFolders {
  fs::path own;                  ///< of names that begin with "./" or "../"
  std::optional<fs::path> data;  ///< of others, if the document names such a folder

  [[nodiscard]] fs::path file(const std::string& name) const {
    const bool is_own = name.starts_with("./") || name.starts_with("../");
    return ((is_own || !data ? own : *data) / name).lexically_normal();
  }
};

/// Of a scenario, or of a mapping of logs: as FileResolver, and as flight/logs/csv does.
/// @param own  the document's folder
NameFolders name_folders(const Json& document, const fs::path& own) {
  const auto data = document.find("data");
  if (data == document.end() || !data->is_string()) return {own, std::nullopt};
  const char* const replaced = std::getenv("OVERFLY_DATA");
  if (replaced != nullptr && *replaced != '\0') return {own, fs::absolute(replaced)};
  return {own, own / data->get<std::string>()};
}

bool is_below(const fs::path& file, const fs::path& folder) {
  const fs::path relative = file.lexically_relative(folder.lexically_normal());
  return !relative.empty() && *relative.begin() != "." && *relative.begin() != "..";
}

void add_named_files(const Json& value, const NameFolders& folders, bool follow, NamedFiles& files);

/// The names, sizes and times of a folder's files: images of a data set, records of a run.
void add_folder(const fs::path& folder, NamedFiles& files) {
  std::vector<std::string> entries;
  std::error_code error;
  for (fs::recursive_directory_iterator entry(folder, error), end;
       !error && entry != end && entries.size() < kMostFolderFiles;
       entry.increment(error)) {
    std::error_code ignored;
    if (!entry->is_regular_file(ignored)) continue;
    entries.push_back(entry->path().string() + " " + stamp_text(FileStamp::of(entry->path())));
  }
  std::sort(entries.begin(), entries.end());
  for (const std::string& entry : entries) files.text += "\n" + entry;
}

/// @param follow  whether folders, and the files named by JSON files, count too
void add_file(const fs::path& file, bool follow, NamedFiles& files) {
  if (!files.sources.check_place(file, "file")) return;
  if (!files.added.insert(file).second) return;
  std::error_code ignored;
  if (follow && fs::is_directory(file, ignored)) return add_folder(file, files);
  if (!check_regular_file(file).ok()) return;
  std::string& text = files.text;
  text += "\n" + file.string() + " ";
  text += content_text(file);
  if (!follow || file.extension() != ".json") return;
  const Result<std::string> content = read_file_text(file, kMostHashedBytes);
  if (!content) return;
  const auto document = json_from_outside<Json>(*content, file.string());
  if (!document) return;
  add_named_files(*document, name_folders(*document, file.parent_path()), false, files);
}

/// @param follow  as for add_file
// NOLINTNEXTLINE(misc-no-recursion): documents from outside are at most kMaxJsonDepth deep
void add_named_files(const Json& value,
                     const NameFolders& folders,
                     bool follow,
                     NamedFiles& files) {
  constexpr std::size_t kLongestName = 4096;
  if (value.is_structured()) {
    for (const Json& child : value) add_named_files(child, folders, follow, files);
    return;
  }
  if (!value.is_string()) return;
  const auto& name = value.get_ref<const std::string&>();
  if (name.empty() || name.size() > kLongestName || name.find('\0') != std::string::npos) return;
  const fs::path file = folders.file(name);
  // A text such as "auto" is no folder of the root, and "." not the data.
  const bool is_of_data = folders.data && is_below(file, *folders.data);
  add_file(file, follow && (name.front() == '/' || is_of_data), files);
}

/// The words of a command; those before the first that is no text.
std::vector<std::string> command_of(const Json& estimator) {
  std::vector<std::string> command;
  const auto found = estimator.find("command");
  if (found == estimator.end() || !found->is_array()) return command;
  for (const Json& word : *found) {
    if (!word.is_string()) break;
    command.push_back(word.get<std::string>());
  }
  return command;
}

/// Digest of the contents of modules, which may be many.
std::string digest_of_modules(const std::vector<fs::path>& modules) {
  static RecentValues<std::string> known(16);
  const std::string stamps = content_key(modules);
  if (const auto digest = known.find(stamps)) return *digest;
  NamedFiles files;
  for (const fs::path& module : modules) add_file(module, false, files);
  std::string digest = digest_of(files.text);
  if (are_settled(modules)) known.keep(stamps, std::make_shared<const std::string>(digest));
  return digest;
}

/// The files of a world as long as they do not change: GDAL takes milliseconds to list them.
struct WorldFiles {
  std::vector<fs::path> names;
  std::string stamps;
  std::string digest;
};

/// Digest of the files of a scenario's world.
std::string digest_of_world(const Scenario& scenario) {
  static RecentValues<WorldFiles> recent(16);
  const std::string key = world_key(scenario) + (scenario.sources.confined() ? "|confined" : "");
  const auto known = recent.find(key);
  if (known && content_key(known->names) == known->stamps) return known->digest;
  WorldFiles world;
  for (const terrain::WorldFile& file : scenario_world_files(scenario)) {
    world.names.push_back(file.file);
  }
  world.stamps = content_key(world.names);
  NamedFiles files{scenario.sources, "", {}};
  for (const fs::path& name : world.names) add_file(name, false, files);
  world.digest = digest_of(files.text);
  std::string digest = world.digest;
  if (are_settled(world.names)) {
    recent.keep(key, std::make_shared<const WorldFiles>(std::move(world)));
  }
  return digest;
}

}  // namespace

std::string flight_key(const Scenario& scenario) {
  Json document = with_plain_numbers(scenario.resolved);
  for (const char* name : {"$schema", "name", "title", "description", "estimators"}) {
    document.erase(name);
  }
  NamedFiles files{scenario.sources, program_identity() + "\n" + document.dump(), {}};
  const NameFolders folders = name_folders(document, "/");
  // Only the files in it that the flight reads decide: it may also have the results of a sweep.
  document.erase("data");
  add_named_files(document, folders, true, files);
  files.text += "\nworld " + digest_of_world(scenario);
  return digest_of(files.text);
}

std::string result_key(const std::string& flight, const Json& estimator) {
  NamedFiles files{{}, flight + "\n" + with_plain_numbers(estimator).dump(), {}};
  add_named_files(estimator, {"/", std::nullopt}, false, files);
  const std::vector<std::string> command = command_of(estimator);
  if (!command.empty()) {
    for (const fs::path& file : program_files(command.front())) add_file(file, false, files);
    const std::vector<fs::path> modules = script_modules(command);
    if (!modules.empty()) files.text += "\nmodules " + digest_of_modules(modules);
  }
  return digest_of(files.text);
}

}  // namespace overfly::server::experiments
