// Numbers as text: for files that must be read back exactly, and for messages.
#pragma once

#include <cstdint>
#include <string>

namespace overfly {

/// The shortest decimal that parses to the same double.
[[nodiscard]] std::string number_text(double value);
/// With at most six significant digits, for messages: "20.2".
[[nodiscard]] std::string short_text(double value);
/// Seconds with nine decimals, exact.
[[nodiscard]] std::string seconds_text(std::int64_t t_ns);
/// "1 gap", "2 gaps". @param noun  that forms its plural with an s
[[nodiscard]] std::string counted(std::uint64_t count, const std::string& noun);

}  // namespace overfly
