// The flight logs that clients of a server may read, by name.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "server/files/data_files.hpp"
#include "server/logs/known_formats.hpp"

namespace overfly::server {

struct LogEntry {
  std::string name;  ///< a label of its folder, "/", and its path in it: "data/sitl/plane25.BIN"
  std::filesystem::path file;
  std::string format;  ///< as flight::logs::to_string
  std::uint64_t size_bytes = 0;
  bool uploaded = false;
};

struct LogList {
  std::vector<LogEntry> logs;  ///< uploads first, then by name
  bool complete = true;        ///< false: the folders hold too many files to look at all
};

inline constexpr std::size_t kMaxLogs = 2'000;  ///< in a list

/// Whether a file name has an extension of flight logs: .tlog, .bin, .ulg, .mcap, .bag, .active,
/// .lcm, .log, in lower or upper case.
[[nodiscard]] bool has_log_extension(const std::string& name);
/// "tlog, .bin, ..." for messages.
[[nodiscard]] std::string log_extensions_text();

/// Finds logs. Remembers the formats of files that have not changed. Thread-safe.
class LogPlaces {
 public:
  LogPlaces();

  /// All logs: files with an extension of logs, and mappings of CSV files (.json), whose first
  /// bytes have a known format. Hidden files and folders, and links to folders, are left out.
  [[nodiscard]] LogList list(const ServedFolders& folders);
  /// The file of a name, checked by `folders.sources`.
  /// Errors: kNotFound for every name that is no log's, whether the file exists or not.
  [[nodiscard]] static Result<std::filesystem::path> find(const ServedFolders& folders,
                                                          const std::string& name);

 private:
  KnownFormats formats_;
};

}  // namespace overfly::server
