// The file that keeps a server's token from one start to the next.
#pragma once

#include <filesystem>
#include <string>

#include "core/result.hpp"

namespace overfly::app {

struct TokenFile {
  std::string token;
  std::string warning;  ///< that others of this machine can read the file; else empty
};

/// Reads the token, the file's one line; makes the file with a new token where there is none, for
/// its owner only. Errors: kInvalidArgument for what is no regular file, more than one line or no
/// token (net::check_token); kIo with the system's reason.
[[nodiscard]] Result<TokenFile> open_token_file(const std::filesystem::path& file);

}  // namespace overfly::app
