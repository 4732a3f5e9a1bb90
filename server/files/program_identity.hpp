// Identity of this program, for keys of what it has computed.
#pragma once

#include <string>

namespace overfly::server {

/// Version and commit. A build of changed sources is only known by its executable, so that size and
/// modification time of the file are added.
[[nodiscard]] std::string program_identity();

}  // namespace overfly::server
