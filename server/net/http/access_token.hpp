// The token that lets a client in.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "core/result.hpp"

namespace overfly::net {

/// 128 bits as base64url.
constexpr std::size_t kMinTokenCharacters = 22;
constexpr std::size_t kMaxTokenCharacters = 256;

/// 192 bits of the system's random source as 32 characters of base64url (RFC 4648, section 5).
/// Errors: kIo when that source fails.
[[nodiscard]] Result<std::string> make_token();

/// A token has 22 to 256 of the characters A-Z a-z 0-9 - _ . ~, which mean nothing special in a
/// URL, a header or a cookie. Errors: kInvalidArgument; the message does not repeat the token.
[[nodiscard]] Status check_token(const std::string& token);

/// Compares in a time that depends on the lengths only.
[[nodiscard]] bool same_token(std::string_view shown, std::string_view token);

}  // namespace overfly::net
