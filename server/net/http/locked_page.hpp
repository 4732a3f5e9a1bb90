// The page for a browser that has not shown the token.
#pragma once

#include <string>

namespace overfly::net {

/// HTML that needs nothing else of the server: says where the token is found and takes it.
/// @param wrong  a token was shown, and it was not the server's
[[nodiscard]] std::string locked_page(bool wrong);

}  // namespace overfly::net
