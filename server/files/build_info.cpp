#include "server/files/build_info.hpp"

#include "server/files/build_info_values.hpp"

namespace overfly::server {

std::string version() { return kVersion; }
std::string git_commit() { return kGitCommit; }

}  // namespace overfly::server
