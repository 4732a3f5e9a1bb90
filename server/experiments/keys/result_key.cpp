#include "server/experiments/keys/result_key.hpp"

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <memory>
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

/// The files that may be read, and the text that they are added to.
struct NamedFiles {
  SourcePolicy sources;
  std::string text;
};

void add_named_files(const Json& value, const fs::path& folder, bool follow, NamedFiles& files);

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
  std::error_code ignored;
  if (follow && fs::is_directory(file, ignored)) return add_folder(file, files);
  if (!check_regular_file(file).ok()) return;
  std::string& text = files.text;
  text += "\n" + file.string() + " ";
  const Result<std::string> content = read_file_text(file, kMostHashedBytes);
  if (!content) {
    text += stamp_text(FileStamp::of(file));
    return;
  }
  text += digest_of(*content);
  if (!follow || file.extension() != ".json") return;
  const auto document = json_from_outside<Json>(*content, file.string());
  if (document) add_named_files(*document, file.parent_path(), false, files);
}

/// @param follow  as for add_file
// NOLINTNEXTLINE(misc-no-recursion): documents from outside are at most kMaxJsonDepth deep
void add_named_files(const Json& value, const fs::path& folder, bool follow, NamedFiles& files) {
  constexpr std::size_t kLongestName = 4096;
  if (value.is_structured()) {
    for (const Json& child : value) add_named_files(child, folder, follow, files);
    return;
  }
  if (!value.is_string()) return;
  const auto& name = value.get_ref<const std::string&>();
  if (name.empty() || name.size() > kLongestName || name.find('\0') != std::string::npos) return;
  // A text such as "auto" is no folder of the root.
  add_file((folder / name).lexically_normal(), follow && name.front() == '/', files);
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

/// Digest of the contents of modules. Those that have not changed are not read again: a sweep has a
/// key for each of its flights.
std::string digest_of_modules(const std::vector<fs::path>& modules) {
  static RecentValues<std::string> known(16);
  const std::string stamps = content_key(modules);
  if (const auto digest = known.find(stamps)) return *digest;
  NamedFiles files;
  for (const fs::path& module : modules) add_file(module, false, files);
  std::string digest = digest_of(files.text);
  const std::int64_t now_ns = utc_now_ns();
  const bool settled = std::all_of(modules.begin(), modules.end(), [&](const fs::path& module) {
    return FileStamp::of(module).settled(now_ns);
  });
  if (settled) known.keep(stamps, std::make_shared<const std::string>(digest));
  return digest;
}

}  // namespace

std::string flight_key(const Scenario& scenario) {
  Json document = with_plain_numbers(scenario.resolved);
  for (const char* name : {"$schema", "name", "title", "description", "estimators"}) {
    document.erase(name);
  }
  NamedFiles files{scenario.sources, program_identity() + "\n" + document.dump()};
  add_named_files(document, "/", true, files);
  return digest_of(files.text);
}

std::string result_key(const std::string& flight, const Json& estimator) {
  NamedFiles files{{}, flight + "\n" + with_plain_numbers(estimator).dump()};
  add_named_files(estimator, "/", false, files);
  const std::vector<std::string> command = command_of(estimator);
  if (!command.empty()) {
    for (const fs::path& file : program_files(command.front())) add_file(file, false, files);
    const std::vector<fs::path> modules = script_modules(command);
    if (!modules.empty()) files.text += "\nmodules " + digest_of_modules(modules);
  }
  return digest_of(files.text);
}

}  // namespace overfly::server::experiments
