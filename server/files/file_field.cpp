#include "server/files/file_field.hpp"

#include <cmath>
#include <utility>

#include "server/files/plain_name.hpp"

namespace overfly::server {
namespace {

using Json = nlohmann::json;

/// A value as shown in a message.
std::string value_text(const Json& value) {
  if (value.is_object()) return "an object";
  if (value.is_array()) return "an array";
  constexpr std::size_t kLongest = 60;
  std::string text = value.dump(-1, ' ', true, Json::error_handler_t::replace);
  if (text.size() > kLongest) text = text.substr(0, kLongest) + "...";
  return text;
}

}  // namespace

FileField::FileField(const Json& value, std::string path)
    : value_(&value), path_(std::move(path)) {}

void FileField::reject(const std::string& must) const {
  throw FieldViolation((path_.empty() ? "the document" : path_) + " = " + value_text(*value_) +
                       ": must " + must);
}

std::optional<FileField> FileField::find(const std::string& name) const {
  if (!value_->is_object()) reject("be an object");
  const auto found = value_->find(name);
  if (found == value_->end()) return std::nullopt;
  return FileField(*found, path_.empty() ? name : path_ + "." + name);
}

FileField FileField::at(const std::string& name) const {
  std::optional<FileField> found = find(name);
  if (!found) throw FieldViolation((path_.empty() ? name : path_ + "." + name) + ": is missing");
  return *std::move(found);
}

std::vector<FileField> FileField::items() const {
  if (!value_->is_array()) reject("be an array");
  std::vector<FileField> items;
  items.reserve(value_->size());
  for (const Json& item : *value_) {
    items.emplace_back(item, path_ + "." + std::to_string(items.size()));
  }
  return items;
}

std::vector<double> FileField::numbers(std::size_t count) const {
  if (!value_->is_array() || value_->size() != count) {
    reject("be an array of " + std::to_string(count) + " numbers");
  }
  std::vector<double> numbers;
  numbers.reserve(count);
  for (const FileField& item : items()) numbers.push_back(item.number());
  return numbers;
}

std::string FileField::text() const {
  if (!value_->is_string()) reject("be text");
  return value_->get<std::string>();
}

std::string FileField::plain_name() const {
  std::string name = text();
  if (!is_plain_name(name)) reject("be a name of letters, digits, _, - and .");
  return name;
}

bool FileField::boolean() const {
  if (!value_->is_boolean()) reject("be true or false");
  return value_->get<bool>();
}

double FileField::number() const {
  if (!value_->is_number()) reject("be a number");
  const double number = value_->get<double>();
  if (!std::isfinite(number)) reject("be finite");
  return number;
}

std::int64_t FileField::integer(std::int64_t min, std::int64_t max) const {
  const std::string must =
      "be a whole number in [" + std::to_string(min) + ", " + std::to_string(max) + "]";
  if (!value_->is_number_integer()) reject(must);
  if (value_->is_number_unsigned() &&
      value_->get<std::uint64_t>() > static_cast<std::uint64_t>(kLargestFileInteger)) {
    reject(must);
  }
  const auto integer = value_->get<std::int64_t>();
  if (integer < min || integer > max) reject(must);
  return integer;
}

}  // namespace overfly::server
