// Validates external names that become a part of a path.
#pragma once

#include <string>

namespace overfly::server {

/// True for a name that is a single path component: letters, digits, `_`, `-`, `.`, not beginning
/// with `.`; at most 200 characters.
[[nodiscard]] bool is_plain_name(const std::string& name);

}  // namespace overfly::server
