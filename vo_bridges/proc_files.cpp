#include "vo_bridges/proc_files.hpp"

#include <fstream>
#include <string>
#include <system_error>

namespace overfly {

namespace {

constexpr std::size_t kChildLimit = 65536;

}  // namespace

std::filesystem::path proc_folder(int pid) {
  return std::filesystem::path("/proc") / std::to_string(pid);
}

std::optional<std::istringstream> stat_after_name(int pid) {
  std::ifstream file(proc_folder(pid) / "stat");
  std::string text;
  if (!std::getline(file, text)) return std::nullopt;
  // The second field is the program's name in parentheses, which may contain any character.
  const std::size_t name_end = text.rfind(')');
  if (name_end == std::string::npos) return std::nullopt;
  return std::istringstream(text.substr(name_end + 1));
}

std::vector<int> children_of(int pid) {
  std::vector<int> pids;
  std::error_code failure;
  std::filesystem::directory_iterator tasks(proc_folder(pid) / "task", failure);
  for (; !failure && tasks != std::filesystem::directory_iterator(); tasks.increment(failure)) {
    std::ifstream file(tasks->path() / "children");
    for (int child = 0; file >> child && pids.size() < kChildLimit;) pids.push_back(child);
  }
  return pids;
}

}  // namespace overfly
