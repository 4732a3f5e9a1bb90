// The page for a browser without the token.
#pragma once

#include <string>

namespace overfly::net {

/// Self-contained HTML that says where to find the token and accepts it.
/// @param wrong  a token was given, but it is not the server's
[[nodiscard]] std::string locked_page(bool wrong);

}  // namespace overfly::net
