#include "server/app/install_paths.hpp"

#include <initializer_list>
#include <system_error>

namespace overfly::app {
namespace {

namespace fs = std::filesystem;

fs::path program_folder() {
  std::error_code ignored;
  return fs::read_symlink("/proc/self/exe", ignored).parent_path();
}

fs::path first_folder_with(const char* file, std::initializer_list<fs::path> folders) {
  std::error_code ignored;
  for (const fs::path& folder : folders) {
    if (fs::exists(folder / file, ignored)) return folder.lexically_normal();
  }
  return {};
}

}  // namespace

fs::path web_folder() {
  const fs::path program = program_folder();
  return first_folder_with("index.html",
                           {program / "web",
                            program / ".." / "share" / "overfly" / "web",
                            program / ".." / ".." / "web" / "dist",
                            fs::path("web") / "dist"});
}

fs::path scenarios_folder() {
  const fs::path program = program_folder();
  fs::path found = first_folder_with("scenario.schema.json",
                                     {program / "scenarios",
                                      program / ".." / "share" / "overfly" / "scenarios",
                                      program / ".." / ".." / "scenarios",
                                      "scenarios"});
  return found.empty() ? fs::path("scenarios") : found;
}

}  // namespace overfly::app
