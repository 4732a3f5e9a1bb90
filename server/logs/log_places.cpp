#include "server/logs/log_places.hpp"

#include <algorithm>
#include <array>
#include <set>
#include <string_view>
#include <utility>

#include "core/text/lower_case.hpp"
#include "flight/logs/flight_log.hpp"

namespace overfly::server {
namespace {

namespace fs = std::filesystem;

constexpr std::array<std::string_view, 8> kExtensions = {
    ".tlog", ".bin", ".ulg", ".mcap", ".bag", ".active", ".lcm", ".log"};

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
std::vector<Labelled> labelled(const LogFolders& folders) {
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

bool may_be_mapping(const std::string& name) { return lower_case(name).ends_with(".json"); }

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

}  // namespace

bool has_log_extension(const std::string& name) {
  const std::string lower = lower_case(name);
  return std::any_of(kExtensions.begin(), kExtensions.end(), [&](std::string_view extension) {
    return lower.size() > extension.size() && lower.ends_with(extension);
  });
}

std::string log_extensions_text() {
  std::string text;
  for (const std::string_view extension : kExtensions) {
    text += (text.empty() ? "" : ", ") + std::string(extension);
  }
  return text;
}

std::string LogPlaces::format_of(const fs::path& file, const FileStamp& stamp) {
  {
    const std::lock_guard lock(mutex_);
    const auto known = known_.find(file);
    if (known != known_.end() && known->second.stamp == stamp) return known->second.format;
  }
  const auto format = flight::logs::detect_format(file);
  std::string text = format ? flight::logs::to_string(*format) : "";
  const std::lock_guard lock(mutex_);
  if (known_.size() >= kMaxVisitedFiles) known_.clear();
  known_[file] = {stamp, text};
  return text;
}

LogList LogPlaces::list(const LogFolders& folders) {
  LogList list;
  std::size_t visited = 0;
  std::set<fs::path> listed;
  for (const auto& [label, folder] : labelled(folders)) {
    std::error_code failed;
    fs::recursive_directory_iterator entry(
        folder, fs::directory_options::skip_permission_denied, failed);
    for (const fs::recursive_directory_iterator end; !failed && entry != end;
         entry.increment(failed)) {
      if (++visited > kMaxVisitedFiles || list.logs.size() >= kMaxLogs) {
        list.complete = false;
        break;
      }
      const fs::path& file = entry->path();
      std::error_code ignored;
      if (entry->is_directory(ignored)) {
        if (is_hidden(file) || entry.depth() >= kMaxLogDepth) entry.disable_recursion_pending();
        continue;
      }
      const std::string name = file.filename().string();
      const bool candidate = has_log_extension(name) || may_be_mapping(name);
      if (!candidate || is_hidden(file) || !is_clean(file.string())) continue;
      if (!folders.sources.check(file, "log")) continue;
      // Data folders may lie in each other.
      if (!listed.insert(fs::weakly_canonical(file, ignored)).second) continue;
      const FileStamp stamp = FileStamp::of(file);
      std::string format = format_of(file, stamp);
      if (format.empty()) continue;
      list.logs.push_back({label + "/" + file.lexically_relative(folder).generic_string(),
                           file,
                           std::move(format),
                           static_cast<std::uint64_t>(stamp.size_bytes),
                           label == kUploadsLabel});
    }
  }
  std::sort(list.logs.begin(), list.logs.end(), [](const LogEntry& a, const LogEntry& b) {
    return std::pair(!a.uploaded, a.name) < std::pair(!b.uploaded, b.name);
  });
  return list;
}

Result<fs::path> LogPlaces::find(const LogFolders& folders, const std::string& name) {
  constexpr std::size_t kShown = 200;
  const Error none{ErrorCode::kNotFound, "log \"" + name.substr(0, kShown) + "\": no such log"};
  const std::size_t slash = name.find('/');
  if (slash == std::string::npos || slash + 1 == name.size()) return none;
  const fs::path path = name.substr(slash + 1);
  if (path.is_absolute()) return none;
  for (const fs::path& part : path) {
    if (is_hidden(part)) return none;
  }
  const std::string file_name = path.filename().string();
  if (!has_log_extension(file_name) && !may_be_mapping(file_name)) return none;
  for (const auto& [label, folder] : labelled(folders)) {
    if (label != name.substr(0, slash)) continue;
    fs::path file = folder / path;
    if (!folders.sources.check(file, "log")) return none;
    return file;
  }
  return none;
}

}  // namespace overfly::server
