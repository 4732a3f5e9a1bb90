// Validates external names that become a part of a path.
#pragma once

#include <string>

namespace overfly::server {

/// True for a name that is a single path component: letters, digits, `_`, `-`, `.`, not beginning
/// with `.`; at most 200 characters.
[[nodiscard]] bool is_plain_name(const std::string& name);

/// True for a name that a client may give to what it makes: 1 to 64 letters, digits, `_` or `-`,
/// beginning with a letter or digit. Also a scenario's name (scenario.schema.json).
[[nodiscard]] bool is_given_name(const std::string& name);
/// "must be 1 to 64 letters, ..."
inline constexpr const char* kGivenNameRule =
    "must be 1 to 64 letters, digits, '_' or '-', beginning with a letter or digit";

}  // namespace overfly::server
