#include "server/app/file_limits.hpp"

#include <CLI/CLI.hpp>

#include "terrain/files/network.hpp"

namespace overfly::app {

SourcePolicy FileLimits::policy() const {
  return folders.empty() ? SourcePolicy() : SourcePolicy::inside(folders, closed);
}

std::vector<std::string> FileLimits::options() const {
  std::vector<std::string> words;
  for (const std::filesystem::path& folder : folders) {
    words.insert(words.end(), {"--files-in", std::filesystem::absolute(folder).string()});
  }
  for (const std::filesystem::path& folder : closed) {
    words.insert(words.end(), {"--files-not-in", std::filesystem::absolute(folder).string()});
  }
  return words;
}

void add_file_limits(CLI::App& command, FileLimits& limits, const std::string& what) {
  CLI::Option* folders =
      command
          .add_option("--files-in",
                      limits.folders,
                      "Folder whose files " + what +
                          " may name; repeatable. Without it any file may be named; with it none "
                          "outside of these folders, and no network")
          ->allow_extra_args(false);
  command
      .add_option("--files-not-in",
                  limits.closed,
                  "Folder in those whose files may not be named; repeatable")
      ->allow_extra_args(false)
      ->needs(folders);
}

SourcePolicy apply(const FileLimits& limits) {
  if (!limits.folders.empty()) terrain::turn_network_off();
  return limits.policy();
}

}  // namespace overfly::app
