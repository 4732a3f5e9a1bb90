#include "flight/logs/csv/csv_rows.hpp"

#include <algorithm>
#include <utility>

namespace overfly::flight::logs {
namespace {

constexpr std::string_view kBlanks = " \t\r\f\v";

std::string_view bare_field(std::string_view text) {
  const std::size_t first = text.find_first_not_of(kBlanks);
  if (first == std::string_view::npos) return {};
  text = text.substr(first, text.find_last_not_of(kBlanks) - first + 1);
  if (text.size() >= 2 && text.front() == '"' && text.back() == '"') {
    return text.substr(1, text.size() - 2);
  }
  return text;
}

void split_row(std::string_view line, std::vector<std::string_view>& fields) {
  fields.clear();
  while (fields.size() <= CsvRows::kMaxColumns) {
    const std::size_t comma = line.find(',');
    fields.push_back(bare_field(line.substr(0, comma)));
    if (comma == std::string_view::npos) return;
    line.remove_prefix(comma + 1);
  }
}

}  // namespace

Result<CsvRows> CsvRows::open(const std::filesystem::path& file) {
  Result<ForwardReader> reader = ForwardReader::open(file);
  if (!reader) return reader.error();
  CsvRows rows(std::move(*reader), file.string());
  if (Status status = rows.read_header(); !status) return status.error();
  return rows;
}

Status CsvRows::skip_rest_of_line() {
  while (true) {
    const auto bytes = reader_.ahead(1);
    if (!bytes) return bytes.error();
    if (bytes->empty()) return {};
    const auto end = std::find(bytes->begin(), bytes->end(), '\n');
    reader_.skip(static_cast<std::size_t>(end - bytes->begin()) + (end == bytes->end() ? 0U : 1U));
    if (end != bytes->end()) return {};
  }
}

Result<std::optional<std::string_view>> CsvRows::line() {
  while (true) {
    reader_.skip(std::exchange(pending_skip_, 0));
    const auto bytes = reader_.ahead(kMaxLineBytes + 1);
    if (!bytes) return bytes.error();
    if (bytes->empty()) return std::optional<std::string_view>();
    const auto longest = bytes->first(std::min(bytes->size(), kMaxLineBytes + 1));
    const auto end = std::find(longest.begin(), longest.end(), '\n');
    if (end == longest.end() && longest.size() > kMaxLineBytes) {
      ++too_long_;
      if (Status status = skip_rest_of_line(); !status) return status.error();
      continue;
    }
    const auto size = static_cast<std::size_t>(end - longest.begin());
    pending_skip_ = size + (end == longest.end() ? 0U : 1U);
    const std::string_view text(reinterpret_cast<const char*>(longest.data()), size);
    if (text.find_first_not_of(kBlanks) != std::string_view::npos) return std::optional(text);
  }
}

Status CsvRows::read_header() {
  const Result<std::optional<std::string_view>> first = line();
  if (!first) return first.error();
  if (!*first) return Error{ErrorCode::kUnreadable, name_ + ": has no header line"};
  std::string_view text = **first;
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);  // UTF-8 byte order mark
  split_row(text, fields_);
  if (fields_.size() > kMaxColumns) {
    return Error{ErrorCode::kUnreadable,
                 name_ + ": must have at most " + std::to_string(kMaxColumns) + " columns"};
  }
  header_.assign(fields_.begin(), fields_.end());
  return {};
}

Result<std::size_t> CsvRows::column(const std::string& name) const {
  const auto found = std::find(header_.begin(), header_.end(), name);
  if (found == header_.end()) {
    std::string names;
    for (const std::string& column : header_) {
      if (names.size() > 300) {
        names += ", ...";
        break;
      }
      names += (names.empty() ? "" : ", ") + column;
    }
    return Error{ErrorCode::kUnreadable,
                 name_ + ": has no column '" + name + "': its header is " + names};
  }
  if (std::find(found + 1, header_.end(), name) != header_.end()) {
    return Error{ErrorCode::kUnreadable, name_ + ": has the column '" + name + "' twice"};
  }
  return static_cast<std::size_t>(found - header_.begin());
}

Result<bool> CsvRows::next() {
  const Result<std::optional<std::string_view>> text = line();
  if (!text) return text.error();
  fields_.clear();
  if (!*text) return false;
  split_row(**text, fields_);
  if (fields_.size() != header_.size()) {
    fields_.clear();
    ++uneven_;
  }
  return true;
}

}  // namespace overfly::flight::logs
