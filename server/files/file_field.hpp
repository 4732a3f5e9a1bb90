// Reads values of a run folder's JSON files, with checks of type and limits.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/result.hpp"

namespace overfly::server {

/// Describes an invalid field: `frames = "many": must be a whole number in [0, 1000]`.
class FieldViolation : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Larger than any stamp [ns], count or frame number of a run (31 years in nanoseconds), and small
/// enough that sums of a few of them do not overflow 64 bits.
inline constexpr std::int64_t kLargestFileInteger = 1'000'000'000'000'000'000;

/// One value of a document and its dotted path. A value that does not match throws FieldViolation;
/// guarded_fields() converts that to an Error. The document must outlive it.
class FileField {
 public:
  explicit FileField(const nlohmann::json& value, std::string path = "");

  /// A required field of an object.
  [[nodiscard]] FileField at(const std::string& name) const;
  /// An optional field of an object; empty if absent.
  [[nodiscard]] std::optional<FileField> find(const std::string& name) const;
  /// The elements of an array.
  [[nodiscard]] std::vector<FileField> items() const;
  /// The elements of an array of `count` numbers.
  [[nodiscard]] std::vector<double> numbers(std::size_t count) const;

  [[nodiscard]] std::string text() const;
  /// Text that may name a file in the folder: see is_plain_name().
  [[nodiscard]] std::string plain_name() const;
  [[nodiscard]] bool boolean() const;
  [[nodiscard]] double number() const;
  [[nodiscard]] std::int64_t integer(std::int64_t min = 0,
                                     std::int64_t max = kLargestFileInteger) const;
  [[nodiscard]] bool is_null() const { return value_->is_null(); }
  [[nodiscard]] const nlohmann::json& value() const { return *value_; }
  /// Throws FieldViolation "path = value: must `must`".
  [[noreturn]] void reject(const std::string& must) const;

 private:
  const nlohmann::json* value_;
  std::string path_;
};

/// Runs a reader of fields. Errors: kUnreadable naming the field.
template <typename Read>
auto guarded_fields(const Read& read) -> Result<decltype(read())> {
  try {
    return read();
  } catch (const FieldViolation& violation) {
    return Error{ErrorCode::kUnreadable, violation.what()};
  }
}

}  // namespace overfly::server
