#include "core/outside/source_policy.hpp"

#include <linux/magic.h>
#include <sys/stat.h>
#include <sys/statfs.h>

#include <algorithm>
#include <array>
#include <utility>

namespace overfly {
namespace {

namespace fs = std::filesystem;

/// Makes a path absolute and removes `.`, `..` and a trailing slash; links stay.
fs::path plain(const fs::path& file) {
  std::error_code ignored;
  fs::path path = fs::absolute(file, ignored).lexically_normal();
  return path.has_filename() ? path : path.parent_path();
}

bool lies_in(const fs::path& file, const fs::path& folder) {
  const auto [at_folder, at_file] =
      std::mismatch(folder.begin(), folder.end(), file.begin(), file.end());
  return at_folder == folder.end() && at_file != file.end();
}

/// Each folder as named and, if that differs, with its links resolved.
std::vector<fs::path> both_names(const std::vector<fs::path>& folders) {
  std::vector<fs::path> names;
  for (const fs::path& folder : folders) {
    if (folder.empty()) continue;
    names.push_back(plain(folder));
    std::error_code failed;
    const fs::path resolved = fs::canonical(folder, failed);
    if (!failed && resolved != names.back()) names.push_back(resolved);
  }
  return names;
}

/// Files there are interfaces of the kernel: some block on read, and most report 0 bytes.
bool is_kernels_own(const fs::path& file) {
  constexpr std::array<long, 9> kKinds = {PROC_SUPER_MAGIC,
                                          SYSFS_MAGIC,
                                          DEBUGFS_MAGIC,
                                          TRACEFS_MAGIC,
                                          SECURITYFS_MAGIC,
                                          CGROUP_SUPER_MAGIC,
                                          CGROUP2_SUPER_MAGIC,
                                          BPF_FS_MAGIC,
                                          DEVPTS_SUPER_MAGIC};
  struct statfs facts {};
  if (::statfs(file.c_str(), &facts) != 0) return false;
  return std::find(kKinds.begin(), kKinds.end(), static_cast<long>(facts.f_type)) != kKinds.end();
}

/// Whether the system resolves the path differently than its components suggest.
bool is_ambiguous(const fs::path& file) {
  return file.native().find('\0') != std::string::npos ||
         std::find(file.begin(), file.end(), "..") != file.end();
}

bool is_or_lies_behind_a_dead_link(fs::path file) {
  for (; file.has_relative_path(); file = file.parent_path()) {
    std::error_code ignored;
    if (fs::is_symlink(fs::symlink_status(file, ignored)) && !fs::exists(file, ignored))
      return true;
  }
  return false;
}

std::string named(const std::string& field, const fs::path& file) {
  constexpr std::size_t kLongest = 300;
  std::string text = file.string();
  if (text.size() > kLongest) text = text.substr(0, kLongest) + "...";
  return field + " = " + text;
}

Status check_regular(const fs::path& file, const std::string& name) {
  struct stat facts {};
  if (::stat(file.c_str(), &facts) != 0) {
    return Error{ErrorCode::kNotFound, name + ": no such file"};
  }
  if (!S_ISREG(facts.st_mode) || is_kernels_own(file)) {
    return Error{ErrorCode::kInvalidArgument, name + ": must be a regular file"};
  }
  return {};
}

}  // namespace

SourcePolicy SourcePolicy::inside(std::vector<fs::path> folders, std::vector<fs::path> excluded) {
  SourcePolicy policy;
  policy.confined_ = true;
  policy.folders_ = both_names(folders);
  policy.excluded_ = both_names(excluded);
  return policy;
}

bool SourcePolicy::holds(const fs::path& plain) const {
  const auto holds_it = [&](const fs::path& folder) { return lies_in(plain, folder); };
  return std::any_of(folders_.begin(), folders_.end(), holds_it) &&
         std::none_of(excluded_.begin(), excluded_.end(), holds_it);
}

Status SourcePolicy::check(const fs::path& file, const std::string& field) const {
  if (Status status = check_place(file, field); !status) return status;
  return check_regular(file, named(field, file));
}

Status SourcePolicy::check_place(const fs::path& file, const std::string& field) const {
  if (!confined_) return {};
  const Error outside{ErrorCode::kInvalidArgument,
                      named(field, file) + ": must be a file inside of the server's data folders"};
  // Check the path as named first: a path outside is never accessed, so the error cannot reveal
  // whether it exists.
  if (is_ambiguous(file)) return outside;
  const fs::path path = plain(file);
  if (!holds(path)) return outside;
  std::error_code failed;
  const fs::path resolved = fs::weakly_canonical(path, failed);
  if (failed || !holds(resolved) || is_or_lies_behind_a_dead_link(path)) return outside;
  return {};
}

}  // namespace overfly
