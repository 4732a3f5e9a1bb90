// The file that keeps a server's token between starts.
#pragma once

#include <filesystem>
#include <string>

#include "core/result.hpp"

namespace overfly::app {

struct TokenFile {
  /// Every request must carry it (access_token.hpp); empty = no token, only on a loopback address.
  std::string token;
  std::string warning;  ///< set if other users of this machine can read the file; else empty
};

/// Reads the token, the file's only line. If the file is absent, creates it with a new token,
/// readable only by its owner.
/// Errors: kInvalidArgument if it is not a regular file, has more than one line, or is not a token
/// (net::check_token); kIo with the system's reason.
[[nodiscard]] Result<TokenFile> open_token_file(const std::filesystem::path& file);

}  // namespace overfly::app
