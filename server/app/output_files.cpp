#include "server/app/output_files.hpp"

#include <filesystem>
#include <system_error>

namespace overfly::app {

namespace fs = std::filesystem;

Status check_other_output(const std::string& option,
                          const std::string& out,
                          const std::string& other_option,
                          const std::string& other) {
  if (out.empty() || other.empty()) return {};
  std::error_code failure;
  const bool is_same = fs::equivalent(out, other, failure) ||
                       fs::weakly_canonical(fs::absolute(out, failure), failure) ==
                           fs::weakly_canonical(fs::absolute(other, failure), failure);
  if (!is_same) return {};
  return Error{
      ErrorCode::kInvalidArgument,
      option + " " + out + ": is the file of " + other_option + " " + other + ": must be another"};
}

Status check_not_written(const std::string& option,
                         const std::string& file,
                         const std::string& folder,
                         std::initializer_list<const char*> names) {
  for (const char* name : names) {
    const std::string written = (fs::path(folder) / name).string();
    if (Status status = check_other_output("--out", written, option, file); !status) return status;
  }
  return {};
}

}  // namespace overfly::app
