// Names from outside that become a part of a path.
#pragma once

#include <string>

namespace overfly::engine {

/// True for a name that is one plain part of a path: letters, digits, `_`, `-`, `.`, not first `.`;
/// 200 characters at most.
[[nodiscard]] bool is_plain_name(const std::string& name);

}  // namespace overfly::engine
