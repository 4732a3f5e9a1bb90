#include "vo_bridges/process/child/program.hpp"

#include <unistd.h>

#include <cstdlib>
#include <string_view>
#include <system_error>

namespace overfly::process {

namespace {

bool is_file(const std::filesystem::path& path) {
  std::error_code failure;
  return std::filesystem::is_regular_file(path, failure);
}

Result<std::filesystem::path> executable(const std::filesystem::path& path) {
  if (::access(path.c_str(), X_OK) == 0) return std::filesystem::absolute(path);
  return Error{ErrorCode::kInvalidArgument,
               "command[0] = '" + path.string() + "': is not executable (chmod +x)"};
}

}  // namespace

Result<std::filesystem::path> find_program(const std::string& program) {
  if (program.find('/') != std::string::npos) {
    if (is_file(program)) return executable(program);
    return Error{ErrorCode::kNotFound, "command[0] = '" + program + "': there is no such file"};
  }
  const char* const variable = std::getenv("PATH");
  std::string_view folders = variable != nullptr ? variable : "/usr/bin:/bin";
  while (!program.empty() && !folders.empty()) {
    const std::size_t colon = folders.find(':');
    const std::string_view folder = folders.substr(0, colon);
    folders = colon == std::string_view::npos ? std::string_view{} : folders.substr(colon + 1);
    const std::filesystem::path path = std::filesystem::path(folder) / program;
    if (!folder.empty() && is_file(path) && ::access(path.c_str(), X_OK) == 0) {
      return std::filesystem::absolute(path);
    }
  }
  return Error{ErrorCode::kNotFound,
               "command[0] = '" + program + "': there is no such program in $PATH"};
}

}  // namespace overfly::process
