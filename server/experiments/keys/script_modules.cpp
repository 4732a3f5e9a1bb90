#include "server/experiments/keys/script_modules.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <deque>
#include <optional>
#include <set>
#include <string_view>
#include <system_error>

#include "core/outside/file_text.hpp"
#include "vo_bridges/process/child/program.hpp"

namespace overfly::server::experiments {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostModules = 2000;
constexpr std::size_t kMostModuleEntries = 20'000;  ///< looked at for one script

/// Programs and packages of the system: what is there changes with the system only.
constexpr std::array<const char*, 11> kSystemFolders{"/bin",
                                                     "/sbin",
                                                     "/lib",
                                                     "/etc",
                                                     "/usr/bin",
                                                     "/usr/sbin",
                                                     "/usr/lib",
                                                     "/usr/libexec",
                                                     "/usr/share",
                                                     "/usr/local/bin",
                                                     "/usr/local/sbin"};

/// Files of folders that hold no modules of a script: virtual environments, sweeps, runs, caches.
constexpr std::array<const char*, 4> kMarksOfOthers{
    "pyvenv.cfg", "sweep.json", "frames.jsonl", "CACHEDIR.TAG"};

bool lies_in(const fs::path& folder, const fs::path& outer) {
  return std::mismatch(outer.begin(), outer.end(), folder.begin(), folder.end()).first ==
         outer.end();
}

bool is_of_system(const fs::path& folder) {
  return folder == "/" || std::any_of(kSystemFolders.begin(),
                                      kSystemFolders.end(),
                                      [&](const char* outer) { return lies_in(folder, outer); });
}

/// Whether a folder holds much that no script in it needs.
bool holds_much_else(const fs::path& folder) {
  std::error_code ignored;
  const char* const home = std::getenv("HOME");
  return (home != nullptr && fs::equivalent(folder, home, ignored)) ||
         fs::equivalent(folder, fs::temp_directory_path(ignored), ignored);
}

bool is_script(const fs::path& file) {
  if (!check_regular_file(file).ok()) return false;
  if (file.extension() == ".py") return true;
  const Result<ReadableFile> opened = ReadableFile::open(file);
  std::array<std::uint8_t, 2> begin{};
  return opened && opened->read_at(0, begin).ok() && begin[0] == '#' && begin[1] == '!';
}

/// The script that a word of a command names, without links.
std::optional<fs::path> script_of(const std::string& word, bool program) {
  if (word.empty() || word.find('\0') != std::string::npos) return std::nullopt;
  std::error_code error;
  fs::path file = fs::absolute(word, error);
  if (program) {
    const Result<fs::path> found = process::find_program(word);
    if (!found) return std::nullopt;
    file = *found;
  }
  file = fs::canonical(file, error);
  if (error || !is_script(file)) return std::nullopt;
  return file;
}

bool is_searched(const fs::directory_entry& folder) {
  const std::string name = folder.path().filename().string();
  std::error_code ignored;
  return folder.is_directory(ignored) && !folder.is_symlink(ignored) && !name.starts_with('.') &&
         name != "__pycache__" &&
         std::none_of(kMarksOfOthers.begin(), kMarksOfOthers.end(), [&](const char* mark) {
           return fs::exists(folder.path() / mark, ignored);
         });
}

std::vector<fs::directory_entry> sorted_entries(const fs::path& folder, std::size_t most) {
  std::vector<fs::directory_entry> entries;
  std::error_code failure;
  for (fs::directory_iterator entry(folder, failure), end;
       !failure && entry != end && entries.size() < most;
       entry.increment(failure)) {
    entries.push_back(*entry);
  }
  std::sort(entries.begin(), entries.end());
  return entries;
}

/// The modules of a folder, those in folders next to the script first.
void add_modules(const fs::path& folder, std::vector<fs::path>& modules) {
  const bool own_only = holds_much_else(folder);
  std::deque<fs::path> folders{folder};
  std::size_t left = kMostModuleEntries;
  while (!folders.empty() && left > 0) {
    const std::vector<fs::directory_entry> entries = sorted_entries(folders.front(), left);
    folders.pop_front();
    left -= entries.size();
    for (const fs::directory_entry& entry : entries) {
      std::error_code ignored;
      if (modules.size() >= kMostModules) return;
      if (entry.path().extension() == ".py" && entry.is_regular_file(ignored)) {
        modules.push_back(entry.path());
      } else if (!own_only && is_searched(entry)) {
        folders.push_back(entry.path());
      }
    }
  }
}

}  // namespace

std::vector<fs::path> script_modules(const std::vector<std::string>& command) {
  std::set<fs::path> folders;
  for (std::size_t i = 0; i < command.size(); ++i) {
    const std::optional<fs::path> script = script_of(command[i], i == 0);
    if (script && !is_of_system(script->parent_path())) folders.insert(script->parent_path());
  }
  std::vector<fs::path> modules;
  for (const fs::path& folder : folders) add_modules(folder, modules);
  return modules;
}

}  // namespace overfly::server::experiments
