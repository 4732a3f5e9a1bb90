// Version and commit of this build, for manifests and `--version`.
#pragma once

#include <string>

namespace overfly::server {

[[nodiscard]] std::string version();  ///< "0.1.0"
/// Abbreviated commit of the source, with "-dirty" if files were changed; "unknown" outside git.
[[nodiscard]] std::string git_commit();

}  // namespace overfly::server
