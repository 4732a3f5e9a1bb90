#include "server/files/data_files.hpp"

#include <algorithm>
#include <set>
#include <string_view>
#include <utility>
#include <vector>

namespace overfly::server {
namespace {

namespace fs = std::filesystem;

struct Labelled {
  std::string label;
  fs::path folder;
};

fs::path plain_folder(const fs::path& folder) {
  std::error_code ignored;
  fs::path path = fs::absolute(folder, ignored).lexically_normal();
  return path.has_filename() ? path : path.parent_path();
}

/// The folders with labels that are unique: names of folders, numbered where they are equal.
std::vector<Labelled> labelled(const ServedFolders& folders) {
  std::vector<Labelled> result;
  std::set<std::string> labels{kUploadsLabel};
  std::set<fs::path> known;
  if (!folders.uploads.empty()) {
    result.push_back({kUploadsLabel, plain_folder(folders.uploads)});
    known.insert(result.back().folder);
  }
  for (const fs::path& folder : folders.folders) {
    const fs::path path = plain_folder(folder);
    if (folder.empty() || !known.insert(path).second) continue;
    const std::string name = path.has_filename() ? path.filename().string() : "root";
    std::string label = name;
    for (int i = 2; !labels.insert(label).second; ++i) label = name + "-" + std::to_string(i);
    result.push_back({label, path});
  }
  return result;
}

bool is_hidden(const fs::path& file) { return file.filename().string().starts_with('.'); }

/// Length of the UTF-8 sequence at the start of `text` (RFC 3629, section 4); 0 if there is none.
std::size_t utf8_bytes(std::string_view text) {
  const auto byte = [&](std::size_t i) {
    return i < text.size() ? static_cast<unsigned char>(text[i]) : 0U;
  };
  const auto tails = [&](std::size_t from, std::size_t to) {
    for (std::size_t i = from; i < to; ++i) {
      if (byte(i) < 0x80 || byte(i) > 0xBF) return false;
    }
    return true;
  };
  const unsigned first = byte(0);
  const unsigned second = byte(1);
  if (first < 0x80) return 1;
  if (first >= 0xC2 && first <= 0xDF) return tails(1, 2) ? 2 : 0;
  if (first >= 0xE0 && first <= 0xEF) {
    const bool overlong = first == 0xE0 && second < 0xA0;
    const bool surrogate = first == 0xED && second > 0x9F;
    return !overlong && !surrogate && tails(1, 3) ? 3 : 0;
  }
  if (first >= 0xF0 && first <= 0xF4) {
    const bool overlong = first == 0xF0 && second < 0x90;
    const bool beyond = first == 0xF4 && second > 0x8F;
    return !overlong && !beyond && tails(1, 4) ? 4 : 0;
  }
  return 0;
}

/// Without control characters, and without bytes that the JSON of an answer could not repeat.
bool is_clean(std::string_view name) {
  while (!name.empty()) {
    const std::size_t bytes = utf8_bytes(name);
    if (bytes == 0 || static_cast<unsigned char>(name.front()) < 0x20) return false;
    name.remove_prefix(bytes);
  }
  return true;
}

/// Whether clients may read a file of a folder.
bool is_served(const ServedFolders& folders,
               const fs::path& file,
               const std::function<bool(const std::string& name)>& candidate) {
  return candidate(file.filename().string()) && !is_hidden(file) && is_clean(file.string()) &&
         folders.sources.check(file, "file").ok();
}

/// The folder of a name. Empty if it is none, hidden, behind a link or outside.
std::optional<fs::path> find_folder(const ServedFolders& folders, const std::string& name) {
  const std::size_t slash = std::min(name.find('/'), name.size());
  for (const auto& [label, folder] : labelled(folders)) {
    if (label != name.substr(0, slash)) continue;
    fs::path path = folder;
    std::error_code ignored;
    for (const fs::path& part : fs::path(name.substr(std::min(slash + 1, name.size())))) {
      if (part.empty() || part.is_absolute() || is_hidden(part)) return std::nullopt;
      path /= part;
      if (fs::is_symlink(path, ignored)) return std::nullopt;
    }
    return fs::is_directory(path, ignored) ? std::optional(path) : std::nullopt;
  }
  return std::nullopt;
}

}  // namespace

bool visit_data_files(const ServedFolders& folders,
                      const std::function<bool(const std::string& name)>& candidate,
                      const std::function<bool(const DataFile&)>& take) {
  std::size_t visited = 0;
  std::set<fs::path> listed;
  for (const auto& [label, folder] : labelled(folders)) {
    std::error_code failed;
    fs::recursive_directory_iterator entry(
        folder, fs::directory_options::skip_permission_denied, failed);
    for (const fs::recursive_directory_iterator end; !failed && entry != end;
         entry.increment(failed)) {
      if (++visited > kMaxVisitedFiles) return false;
      const fs::path& file = entry->path();
      std::error_code ignored;
      if (entry->is_directory(ignored)) {
        if (is_hidden(file) || entry.depth() >= kMaxDataDepth) entry.disable_recursion_pending();
        continue;
      }
      if (!is_served(folders, file, candidate)) continue;
      // Data folders may lie in each other.
      if (!listed.insert(fs::weakly_canonical(file, ignored)).second) continue;
      const bool more = take({label + "/" + file.lexically_relative(folder).generic_string(),
                              file,
                              label == kUploadsLabel});
      if (!more) return false;
    }
  }
  return true;
}

void visit_data_folder(const ServedFolders& folders,
                       const std::string& name,
                       const std::function<bool(const std::string& name)>& candidate,
                       const std::function<bool(const DataFile&)>& take) {
  const std::optional<fs::path> folder = find_folder(folders, name);
  if (!folder) return;
  const bool uploaded = name.substr(0, name.find('/')) == kUploadsLabel;
  std::error_code failed;
  fs::directory_iterator entry(*folder, fs::directory_options::skip_permission_denied, failed);
  for (const fs::directory_iterator end; !failed && entry != end; entry.increment(failed)) {
    const fs::path& file = entry->path();
    std::error_code ignored;
    if (entry->is_directory(ignored) || !is_served(folders, file, candidate)) continue;
    if (!take({name + "/" + file.filename().string(), file, uploaded})) return;
  }
}

std::optional<fs::path> find_data_file(
    const ServedFolders& folders,
    const std::string& name,
    const std::function<bool(const std::string& name)>& candidate) {
  const std::size_t slash = name.find('/');
  if (slash == std::string::npos || slash + 1 == name.size()) return std::nullopt;
  const fs::path path = name.substr(slash + 1);
  if (path.is_absolute()) return std::nullopt;
  for (const fs::path& part : path) {
    if (is_hidden(part)) return std::nullopt;
  }
  if (!candidate(path.filename().string())) return std::nullopt;
  for (const auto& [label, folder] : labelled(folders)) {
    if (label != name.substr(0, slash)) continue;
    fs::path file = folder / path;
    if (!folders.sources.check(file, "file")) return std::nullopt;
    return file;
  }
  return std::nullopt;
}

}  // namespace overfly::server
