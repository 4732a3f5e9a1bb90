// Reads the rows of a CSV file of any size.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/outside/forward_reader.hpp"
#include "core/result.hpp"

namespace overfly::flight::logs {

/// The rows below a header, split at commas; blanks around fields and quotes around a whole field
/// are removed, empty lines are skipped. A quoted field cannot hold a comma.
class CsvRows {
 public:
  static constexpr std::size_t kMaxLineBytes = std::size_t{1} << 16U;
  static constexpr std::size_t kMaxColumns = 1000;

  /// Errors: as ForwardReader::open; kUnreadable without a header or with too many columns.
  [[nodiscard]] static Result<CsvRows> open(const std::filesystem::path& file);

  /// Index of a column. Errors: kUnreadable naming file and columns, also for a name that stands
  /// twice in the header.
  [[nodiscard]] Result<std::size_t> column(const std::string& name) const;

  /// Moves to the next row. @return false at the end of the file
  /// Errors: kIo.
  [[nodiscard]] Result<bool> next();
  /// The fields of the row, valid until the next call of next(). Empty if the row has another
  /// number of them than the header.
  [[nodiscard]] const std::vector<std::string_view>& fields() const { return fields_; }

  /// Rows with another number of fields than the header.
  [[nodiscard]] std::uint64_t uneven() const { return uneven_; }
  /// Lines left out: longer than kMaxLineBytes.
  [[nodiscard]] std::uint64_t too_long() const { return too_long_; }
  [[nodiscard]] std::uint64_t position() const { return reader_.position(); }

 private:
  CsvRows(ForwardReader reader, std::string name)
      : reader_(std::move(reader)), name_(std::move(name)) {}
  [[nodiscard]] Result<std::optional<std::string_view>> line();
  [[nodiscard]] Status skip_rest_of_line();
  [[nodiscard]] Status read_header();

  ForwardReader reader_;
  std::string name_;  ///< of the file
  std::size_t pending_skip_ = 0;
  std::vector<std::string> header_;
  std::vector<std::string_view> fields_;
  std::uint64_t uneven_ = 0;
  std::uint64_t too_long_ = 0;
};

}  // namespace overfly::flight::logs
