// Message formats that a ULog file declares. Private to ulog.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace overfly::flight::logs {

/// The place of a number, or of an array of numbers, in the data of a message.
struct UlogField {
  std::string type;        ///< basic type: "uint64_t", "float", ...
  std::size_t offset = 0;  ///< [bytes]
  std::size_t count = 1;   ///< elements of an array
};

/// Value of element `i`; empty if the data end before it (ULog leaves out padding at the end).
[[nodiscard]] std::optional<double> number_in(const UlogField& field,
                                              std::span<const std::uint8_t> data,
                                              std::size_t i = 0);

/// When a message was measured [ns]: its timestamp_sample, or `t_ns` where that is missing, 0,
/// later than `t_ns` or more than 1 s before it.
/// @param sampled  timestamp_sample [us]
/// @param t_ns     `timestamp`
[[nodiscard]] std::int64_t sampled_ns_in(const std::optional<UlogField>& sampled,
                                         std::span<const std::uint8_t> data,
                                         std::int64_t t_ns);

/// The formats of a file. Types may contain types that are declared later.
class UlogFormats {
 public:
  /// Takes the text of a format message: "name:type field;type[4] field;...".
  /// @return false if it cannot be understood, or exceeds one of the limits below
  bool declare(std::string_view text);

  /// The field of a message: "q", or "parts[1].x" of nested types.
  /// @return empty if the message, the field or a type in front of it is not declared
  [[nodiscard]] std::optional<UlogField> find(const std::string& message,
                                              std::string_view path) const;
  [[nodiscard]] bool has(const std::string& message) const { return formats_.contains(message); }

  /// PX4 declares about 200 formats with up to 100 members.
  static constexpr std::size_t kMaxFormats = 4096;
  static constexpr std::size_t kMaxMembers = 1024;
  static constexpr std::size_t kMaxMembersOfAll = 100'000;

 private:
  struct Member {
    std::string type;
    std::size_t count = 1;
    std::string name;
  };
  [[nodiscard]] std::optional<std::size_t> size_of(const std::string& type, int depth) const;

  std::map<std::string, std::vector<Member>, std::less<>> formats_;
  std::size_t members_ = 0;  ///< declared so far
  mutable std::map<std::string, std::optional<std::size_t>, std::less<>> sizes_;
};

}  // namespace overfly::flight::logs
