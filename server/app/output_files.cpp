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

Status check_outputs(const std::vector<NamedFile>& written, const std::vector<NamedFile>& read) {
  for (std::size_t i = 0; i < written.size(); ++i) {
    std::vector<NamedFile> others(written.begin() + static_cast<std::ptrdiff_t>(i) + 1,
                                  written.end());
    others.insert(others.end(), read.begin(), read.end());
    for (const NamedFile& other : others) {
      Status status =
          check_other_output(written[i].option, written[i].file, other.option, other.file);
      if (!status) return status;
    }
  }
  return {};
}

std::vector<NamedFile> files_of_sweep(const std::string& folder) {
  std::vector<NamedFile> files;
  for (const char* name : {"sweep.json", "results.jsonl"}) {
    files.push_back({"sweep", (fs::path(folder) / name).string()});
  }
  return files;
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
