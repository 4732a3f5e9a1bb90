#include "server/net/http/access_token.hpp"

#include <sys/random.h>

#include <array>
#include <cerrno>
#include <cstdint>
#include <cstring>

namespace overfly::net {
namespace {

constexpr const char* kBase64Url =
    "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-_";
constexpr std::size_t kRandomBytes = 24;

bool is_token_character(char c) {
  return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '-' ||
         c == '_' || c == '.' || c == '~';
}

}  // namespace

Result<std::string> make_token() {
  std::array<std::uint8_t, kRandomBytes> bytes{};
  if (::getentropy(bytes.data(), bytes.size()) != 0) {
    return Error{ErrorCode::kIo,
                 std::string("the system's random number source failed: ") + std::strerror(errno)};
  }
  std::string token;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::uint32_t group = (std::uint32_t{bytes[i]} << 16U) |
                                (std::uint32_t{bytes[i + 1]} << 8U) | std::uint32_t{bytes[i + 2]};
    for (const unsigned shift : {18U, 12U, 6U, 0U}) token += kBase64Url[(group >> shift) & 63U];
  }
  return token;
}

Status check_token(const std::string& token) {
  if (token.size() < kMinTokenCharacters || token.size() > kMaxTokenCharacters) {
    return Error{ErrorCode::kInvalidArgument,
                 "a token of " + std::to_string(token.size()) + " characters: must have " +
                     std::to_string(kMinTokenCharacters) + " to " +
                     std::to_string(kMaxTokenCharacters)};
  }
  for (std::size_t i = 0; i < token.size(); ++i) {
    if (is_token_character(token[i])) continue;
    return Error{
        ErrorCode::kInvalidArgument,
        "character " + std::to_string(i + 1) + " of the token: must be one of A-Z a-z 0-9 - _ . ~"};
  }
  return {};
}

bool same_token(std::string_view shown, std::string_view token) {
  if (shown.size() != token.size()) return false;
  unsigned difference = 0;
  for (std::size_t i = 0; i < token.size(); ++i) {
    difference |= static_cast<unsigned char>(shown[i]) ^ static_cast<unsigned char>(token[i]);
  }
  return difference == 0;
}

}  // namespace overfly::net
