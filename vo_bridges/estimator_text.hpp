// Text that an estimator sends, made suitable for logs, errors and JSON files.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace overfly {

/// Maximum length of a log line.
inline constexpr std::size_t kLogLineLimitBytes = 4096;
/// Maximum length of a name.
inline constexpr std::size_t kNameLimitBytes = 128;

/// Removes the control sequences of a terminal (colours), replaces every other byte that is neither
/// printable nor part of valid UTF-8 by '?' and cuts the text to `limit` bytes.
[[nodiscard]] std::string printable(std::string_view text, std::size_t limit = kLogLineLimitBytes);

/// Whether a name of a parameter, counter or timing is valid: 1 to kNameLimitBytes printable ASCII
/// characters without spaces.
[[nodiscard]] bool is_figure_name(std::string_view name);

}  // namespace overfly
