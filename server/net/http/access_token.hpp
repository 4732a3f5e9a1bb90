// The access token of clients.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "core/result.hpp"

namespace overfly::net {

/// 128 bits as base64url.
constexpr std::size_t kMinTokenCharacters = 22;
constexpr std::size_t kMaxTokenCharacters = 256;

/// 192 bits from the system's random source as 32 characters of base64url (RFC 4648, section 5).
/// Errors: kIo if that source fails.
[[nodiscard]] Result<std::string> make_token();

/// A token has 22 to 256 of the characters A-Z a-z 0-9 - _ . ~, which need no escaping in a URL, a
/// header or a cookie. Errors: kInvalidArgument; the message does not repeat the token.
[[nodiscard]] Status check_token(const std::string& token);

/// Compares in time that depends only on the lengths.
[[nodiscard]] bool same_token(std::string_view shown, std::string_view token);

}  // namespace overfly::net
