// The options that limit which files of the machine a scenario may name.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/outside/source_policy.hpp"

namespace CLI {
class App;
}

namespace overfly::app {

/// --files-in and --files-not-in. A server gives them to the processes that it starts for clients.
struct FileLimits {
  std::vector<std::filesystem::path> folders;  ///< whose files may be named; empty = any file may
  std::vector<std::filesystem::path> closed;   ///< in them, but may not be named

  [[nodiscard]] SourcePolicy policy() const;
  /// The same options for a process that this one starts.
  [[nodiscard]] std::vector<std::string> options() const;
};

/// @param what  names the files: "the scenario"
void add_file_limits(CLI::App& command, FileLimits& limits, const std::string& what);

/// The policy of the limits; with limits the network is turned off too.
[[nodiscard]] SourcePolicy apply(const FileLimits& limits);

}  // namespace overfly::app
