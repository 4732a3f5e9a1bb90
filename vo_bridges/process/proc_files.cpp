#include "vo_bridges/process/proc_files.hpp"

#include <fstream>
#include <string>

namespace overfly::process {

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

}  // namespace overfly::process
