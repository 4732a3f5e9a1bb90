// Text of binary files and messages.
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace overfly {

/// The bytes up to the first zero as text; bytes that are not printable ASCII become '?'.
[[nodiscard]] std::string printable_text(std::span<const std::uint8_t> bytes);

}  // namespace overfly
