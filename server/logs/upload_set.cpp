#include "server/logs/upload_set.hpp"

#include <set>

#include "core/text/lower_case.hpp"
#include "core/text/shown_path.hpp"
#include "flight/logs/flight_log.hpp"
#include "server/files/plain_name.hpp"

namespace overfly::server {

namespace fs = std::filesystem;

Status check_upload_set(const std::vector<UploadFile>& files, std::uint64_t max_bytes) {
  const auto invalid = [](const std::string& what) {
    return Error{ErrorCode::kInvalidArgument, "files: " + what};
  };
  if (files.size() < 2 || files.size() > kMaxUploadFiles) {
    return invalid("must be a mapping (.json) and 1 to " + std::to_string(kMaxUploadFiles - 1) +
                   " CSV files");
  }
  std::set<std::string> names;
  for (const UploadFile& file : files) {
    const std::string shown = "\"" + file.name.substr(0, 200) + "\"";
    const std::string lower = lower_case(file.name);
    const bool mapping = &file == &files.front();
    const bool right_kind =
        mapping ? lower.ends_with(".json") : lower.ends_with(".csv") || lower.ends_with(".txt");
    if (!is_plain_name(file.name) || !right_kind) {
      return invalid(shown + ": must be letters, digits, '_', '-' and '.', at most 200, and end " +
                     "with " + (mapping ? ".json" : ".csv or .txt"));
    }
    if (!names.insert(file.name).second) return invalid(shown + ": is there twice");
    if (file.size_bytes > max_bytes) {
      return invalid(shown + " has " + std::to_string(file.size_bytes) + " bytes: must have at " +
                     "most " + std::to_string(max_bytes));
    }
  }
  return {};
}

Status check_uploaded_mapping(const fs::path& folder, const std::vector<UploadFile>& files) {
  const std::string& name = files.front().name;
  const fs::path mapping = folder / name;
  const auto unreadable = [&](const std::string& what) {
    return Error{ErrorCode::kUnreadable, shown_without(folder, "", what)};
  };
  const auto format = flight::logs::detect_format(mapping);
  if (!format) return unreadable(format.error().message);
  if (*format != flight::logs::LogFormat::kCsv) {
    return unreadable(name + ": is no mapping of CSV files");
  }
  const auto named = flight::logs::files_of_log(mapping);
  if (!named) return unreadable(named.error().message);
  std::set<fs::path> uploaded;
  for (const UploadFile& file : files) uploaded.insert(folder / file.name);
  std::set<fs::path> unused = uploaded;
  for (const fs::path& file : *named) {
    if (!uploaded.contains(file)) {
      return unreadable(name + ": names \"" + file.filename().string() +
                        "\", which was not uploaded with it: each \"file\" must be only the name " +
                        "of a CSV file next to the mapping, without \"data\"");
    }
    unused.erase(file);
  }
  if (unused.empty()) return {};
  return unreadable(name + ": does not name " + unused.begin()->filename().string() +
                    ", which was uploaded with it");
}

}  // namespace overfly::server
