#include "server/app/version.hpp"

#include "server/files/build_info.hpp"

namespace overfly::app {

std::string version_text() {
  return "overfly " + server::version() + " (commit " + server::git_commit() + ")";
}

}  // namespace overfly::app
