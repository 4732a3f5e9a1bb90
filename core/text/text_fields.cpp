#include "core/text/text_fields.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <span>

#include "core/cancel.hpp"
#include "core/outside/file_text.hpp"

namespace overfly {
namespace {

constexpr std::string_view kBlank = " \t\r\f\v";

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(kBlank);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlank) - first + 1);
}

/// At most one field more than a line may have.
std::vector<std::string_view> fields_of(std::string_view line) {
  constexpr std::size_t kMost = FieldFile::kMaxLineFields;
  std::vector<std::string_view> fields;
  if (line.find(',') != std::string_view::npos) {
    std::size_t begin = 0;
    for (std::size_t comma = line.find(',');
         comma != std::string_view::npos && fields.size() < kMost;
         comma = line.find(',', begin)) {
      fields.push_back(trimmed(line.substr(begin, comma - begin)));
      begin = comma + 1;
    }
    fields.push_back(trimmed(line.substr(begin)));
    return fields;
  }
  while (!(line = trimmed(line)).empty() && fields.size() <= kMost) {
    const std::size_t end = std::min(line.find_first_of(kBlank), line.size());
    fields.push_back(line.substr(0, end));
    line.remove_prefix(end);
  }
  return fields;
}

/// A decimal number as digits * 10^exponent.
struct Decimal {
  bool negative = false;
  std::string digits;
  int exponent = 0;
};

std::optional<Decimal> decimal_from(std::string_view text) {
  Decimal decimal;
  std::size_t i = 0;
  if (i < text.size() && (text[i] == '+' || text[i] == '-')) decimal.negative = text[i++] == '-';
  bool point_seen = false;
  for (; i < text.size() && text[i] != 'e' && text[i] != 'E'; ++i) {
    if (text[i] == '.' && !point_seen) {
      point_seen = true;
      continue;
    }
    if (text[i] < '0' || text[i] > '9') return std::nullopt;
    decimal.digits += text[i];
    if (point_seen) --decimal.exponent;
  }
  if (decimal.digits.empty()) return std::nullopt;
  if (i == text.size()) return decimal;
  std::string_view power = text.substr(i + 1);
  if (power.size() > 1 && power[0] == '+' && power[1] != '-') power.remove_prefix(1);
  int exponent = 0;
  const auto [end, error] = std::from_chars(power.data(), power.data() + power.size(), exponent);
  if (error != std::errc() || end != power.data() + power.size()) return std::nullopt;
  if (std::abs(exponent) > 1000) return std::nullopt;
  decimal.exponent += exponent;
  return decimal;
}

struct UnitEntry {
  TimeUnit unit;
  int exponent;  ///< of ten, in nanoseconds
  const char* name;
  const char* limit;
};
constexpr std::array<UnitEntry, 4> kUnits{
    {{TimeUnit::kSeconds, 9, "seconds", "9.2e9 s"},
     {TimeUnit::kMilliseconds, 6, "milliseconds", "9.2e12 ms"},
     {TimeUnit::kMicroseconds, 3, "microseconds", "9.2e15 us"},
     {TimeUnit::kNanoseconds, 0, "nanoseconds", "9.2e18 ns"}}};

/// The decimal times a power of ten, rounded half away from zero; empty on overflow.
std::optional<std::int64_t> ns_from_decimal(Decimal decimal, int exponent) {
  decimal.exponent += exponent;
  const std::size_t nonzero =
      std::min(decimal.digits.find_first_not_of('0'), decimal.digits.size());
  decimal.digits.erase(0, nonzero);
  if (decimal.digits.empty()) return 0;
  bool round_up = false;
  if (decimal.exponent < 0) {
    const auto drop = static_cast<std::size_t>(-decimal.exponent);
    if (drop > decimal.digits.size()) return 0;
    const std::size_t kept = decimal.digits.size() - drop;
    round_up = decimal.digits[kept] >= '5';
    decimal.digits.resize(kept);
  } else {
    if (decimal.digits.size() + static_cast<std::size_t>(decimal.exponent) > 19)
      return std::nullopt;
    decimal.digits.append(static_cast<std::size_t>(decimal.exponent), '0');
  }
  std::uint64_t size_ns = 0;
  const char* const end = decimal.digits.data() + decimal.digits.size();
  if (!decimal.digits.empty() &&
      std::from_chars(decimal.digits.data(), end, size_ns).ec != std::errc()) {
    return std::nullopt;
  }
  const std::uint64_t extra_ns = round_up ? 1 : 0;
  if (size_ns > static_cast<std::uint64_t>(INT64_MAX) - extra_ns) return std::nullopt;
  const auto ns = static_cast<std::int64_t>(size_ns + extra_ns);
  return decimal.negative ? -ns : ns;
}

}  // namespace

Result<FieldFile> FieldFile::read(const std::filesystem::path& file,
                                  const std::atomic<bool>* cancel) {
  return read(file, cancel, Limits());
}

Result<FieldFile> FieldFile::read(const std::filesystem::path& file,
                                  const std::atomic<bool>* cancel,
                                  const Limits& limits) {
  Result<std::string> text = read_file_text(file, limits.max_bytes, cancel);
  if (!text) return text.error();
  return from_text(file, std::move(*text), cancel, limits);
}

Result<FieldFile> FieldFile::read_start(const std::filesystem::path& file, std::size_t bytes) {
  const Result<ReadableFile> open = ReadableFile::open(file);
  if (!open) return open.error();
  std::vector<std::uint8_t> start(bytes);
  std::size_t filled = 0;
  while (filled < start.size()) {
    const Result<std::size_t> read =
        open->read_some(filled, std::span(start).subspan(filled, start.size() - filled));
    if (!read) return read.error();
    if (*read == 0) break;
    filled += *read;
  }
  std::string text(start.begin(), start.begin() + static_cast<std::ptrdiff_t>(filled));
  // The last line may go on behind these bytes.
  if (filled == bytes) text.resize(text.rfind('\n') == std::string::npos ? 0 : text.rfind('\n'));
  return from_text(file, std::move(text), nullptr, Limits());
}

Result<FieldFile> FieldFile::from_text(const std::filesystem::path& file,
                                       std::string text,
                                       const std::atomic<bool>* cancel,
                                       const Limits& limits) {
  FieldFile result;
  result.file_ = file;
  result.text_ = std::make_shared<const std::string>(std::move(text));
  std::size_t fields = 0;

  std::string_view rest = *result.text_;
  if (rest.starts_with("\xEF\xBB\xBF")) rest.remove_prefix(3);  // UTF-8 byte order mark
  for (int number = 1; !rest.empty(); ++number) {
    const std::size_t end = std::min(rest.find('\n'), rest.size());
    const std::string_view line = trimmed(rest.substr(0, end));
    rest.remove_prefix(std::min(end + 1, rest.size()));
    if (is_cancelled(cancel)) {
      return Error{ErrorCode::kCancelled, file.string() + ": reading was cancelled"};
    }
    if (line.empty()) continue;
    if (!line.starts_with('#')) {
      if (result.lines_.size() == limits.max_lines) {
        return Error{
            ErrorCode::kUnreadable,
            file.string() + ": must have at most " + std::to_string(limits.max_lines) + " lines"};
      }
      result.lines_.push_back({number, line.find(',') != std::string_view::npos, fields_of(line)});
      const FieldLine& added = result.lines_.back();
      fields += added.fields.size();
      if (added.fields.size() > kMaxLineFields || fields / kMeanLineFields > limits.max_lines) {
        return result.bad_line(added,
                               "must have at most " + std::to_string(kMaxLineFields) +
                                   " columns, and on average " + std::to_string(kMeanLineFields));
      }
      continue;
    }
    const std::string_view comment = trimmed(line.substr(1));
    const std::size_t blank = comment.find_first_of(kBlank);
    if (blank == std::string_view::npos || result.comments_.size() >= kMaxComments) continue;
    result.comments_[std::string(comment.substr(0, blank))] = trimmed(comment.substr(blank));
  }
  return result;
}

Error FieldFile::bad_field(const FieldLine& line,
                           std::size_t column,
                           const std::string& what) const {
  constexpr std::size_t kShown = 100;
  return bad_line(line,
                  "column " + std::to_string(column) + " = '" +
                      std::string(line.fields.at(column - 1).substr(0, kShown)) + "': " + what);
}

Error FieldFile::bad_line(const FieldLine& line, const std::string& what) const {
  return {ErrorCode::kUnreadable, file_.string() + ":" + std::to_string(line.number) + ": " + what};
}

Status FieldFile::expect_fields(const FieldLine& line, std::size_t count) const {
  if (line.fields.size() == count) return {};
  return bad_line(
      line, std::to_string(line.fields.size()) + " columns: must be " + std::to_string(count));
}

Result<double> FieldFile::number(const FieldLine& line, std::size_t column) const {
  std::string_view text = line.fields.at(column - 1);
  if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (text.empty() || error != std::errc() || end != text.data() + text.size()) {
    return bad_field(line, column, "must be a number");
  }
  if (!std::isfinite(value)) return bad_field(line, column, "must be finite");
  return value;
}

Result<std::int64_t> FieldFile::time_s(const FieldLine& line, std::size_t column) const {
  return time(line, column, TimeUnit::kSeconds);
}

Result<std::int64_t> FieldFile::time(const FieldLine& line,
                                     std::size_t column,
                                     TimeUnit unit) const {
  const UnitEntry& entry = kUnits.at(static_cast<std::size_t>(unit));
  const std::optional<Decimal> decimal = decimal_from(line.fields.at(column - 1));
  if (!decimal) return bad_field(line, column, std::string("must be a time in ") + entry.name);
  const std::optional<std::int64_t> t_ns = ns_from_decimal(*decimal, entry.exponent);
  if (!t_ns) return bad_field(line, column, std::string("magnitude must be below ") + entry.limit);
  return *t_ns;
}

Result<std::int64_t> FieldFile::time_ns(const FieldLine& line, std::size_t column) const {
  const std::string_view text = line.fields.at(column - 1);
  std::int64_t t_ns = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), t_ns);
  if (text.empty() || error != std::errc() || end != text.data() + text.size()) {
    return bad_field(line, column, "must be a whole number of nanoseconds");
  }
  return t_ns;
}

}  // namespace overfly
