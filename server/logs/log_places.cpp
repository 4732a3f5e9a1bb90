#include "server/logs/log_places.hpp"

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include "core/text/lower_case.hpp"
#include "flight/logs/flight_log.hpp"

namespace overfly::server {
namespace {

namespace fs = std::filesystem;

constexpr std::array<std::string_view, 8> kExtensions = {
    ".tlog", ".bin", ".ulg", ".mcap", ".bag", ".active", ".lcm", ".log"};

bool may_be_log(const std::string& name) {
  const bool mapping = lower_case(name).ends_with(".json");
  return mapping || has_log_extension(name);
}

std::string format_of_log(const fs::path& file) {
  const auto format = flight::logs::detect_format(file);
  return format ? flight::logs::to_string(*format) : "";
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

LogPlaces::LogPlaces() : formats_(format_of_log) {}

LogList LogPlaces::list(const ServedFolders& folders) {
  LogList list;
  const auto take = [&](const DataFile& file) {
    if (list.logs.size() >= kMaxLogs) return false;
    const FileStamp stamp = FileStamp::of(file.path);
    std::string format = formats_.of(file.path, stamp);
    if (format.empty()) return true;
    list.logs.push_back({file.name,
                         file.path,
                         std::move(format),
                         static_cast<std::uint64_t>(stamp.size_bytes),
                         file.uploaded});
    return true;
  };
  list.complete = visit_data_files(folders, may_be_log, take);
  std::sort(list.logs.begin(), list.logs.end(), [](const LogEntry& a, const LogEntry& b) {
    return std::pair(!a.uploaded, a.name) < std::pair(!b.uploaded, b.name);
  });
  return list;
}

Result<fs::path> LogPlaces::find(const ServedFolders& folders, const std::string& name) {
  constexpr std::size_t kShown = 200;
  if (auto file = find_data_file(folders, name, may_be_log)) return *file;
  return Error{ErrorCode::kNotFound, "log \"" + name.substr(0, kShown) + "\": no such log"};
}

}  // namespace overfly::server
