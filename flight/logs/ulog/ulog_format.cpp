// After the ULog file format, version 1 (PX4 developer guide, "ULog File Format").
#include "flight/logs/ulog/ulog_format.hpp"

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <utility>

#include "core/time.hpp"

namespace overfly::flight::logs {
namespace {

static_assert(std::endian::native == std::endian::little, "ULog is little-endian");

/// Nesting of types; PX4's are at most three deep.
constexpr int kMaxTypeDepth = 16;
/// No message is longer than this: its length is a uint16_t.
constexpr std::size_t kMaxMessageBytes = 65535;

struct BasicType {
  std::string_view name;
  std::size_t size;
};

constexpr BasicType kBasicTypes[] = {{"int8_t", 1},
                                     {"uint8_t", 1},
                                     {"int16_t", 2},
                                     {"uint16_t", 2},
                                     {"int32_t", 4},
                                     {"uint32_t", 4},
                                     {"int64_t", 8},
                                     {"uint64_t", 8},
                                     {"float", 4},
                                     {"double", 8},
                                     {"bool", 1},
                                     {"char", 1}};

std::optional<std::size_t> basic_size(std::string_view type) {
  for (const BasicType& basic : kBasicTypes) {
    if (basic.name == type) return basic.size;
  }
  return std::nullopt;
}

/// Takes "[N]" off the end of a type or a part of a path. @return N; 1 without brackets; empty if
/// they are not understood
std::optional<std::size_t> take_index(std::string_view& text, std::size_t without) {
  const std::size_t bracket = text.find('[');
  if (bracket == std::string_view::npos) return without;
  std::size_t value = 0;
  const char* const end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data() + bracket + 1, end, value);
  if (error != std::errc() || rest + 1 != end || *rest != ']' || value > kMaxMessageBytes) {
    return std::nullopt;
  }
  text = text.substr(0, bracket);
  return value;
}

template <typename T>
double number_of(const std::uint8_t* bytes) {
  T value{};
  std::memcpy(&value, bytes, sizeof value);
  return static_cast<double>(value);
}

}  // namespace

std::optional<double> number_in(const UlogField& field,
                                std::span<const std::uint8_t> data,
                                std::size_t i) {
  const std::size_t size = basic_size(field.type).value_or(0);
  if (size == 0 || i >= field.count || field.offset + (i + 1) * size > data.size()) {
    return std::nullopt;
  }
  const std::uint8_t* const bytes = data.data() + field.offset + i * size;
  if (field.type == "float") return number_of<float>(bytes);
  if (field.type == "double") return number_of<double>(bytes);
  if (field.type == "int8_t" || field.type == "char") return number_of<std::int8_t>(bytes);
  if (field.type == "int16_t") return number_of<std::int16_t>(bytes);
  if (field.type == "uint16_t") return number_of<std::uint16_t>(bytes);
  if (field.type == "int32_t") return number_of<std::int32_t>(bytes);
  if (field.type == "uint32_t") return number_of<std::uint32_t>(bytes);
  if (field.type == "int64_t") return number_of<std::int64_t>(bytes);
  if (field.type == "uint64_t") return number_of<std::uint64_t>(bytes);
  return number_of<std::uint8_t>(bytes);
}

std::int64_t sampled_ns_in(const std::optional<UlogField>& sampled,
                           std::span<const std::uint8_t> data,
                           std::int64_t t_ns) {
  if (!sampled) return t_ns;
  const double sampled_us = number_in(*sampled, data).value_or(0.0);
  const double earliest_us = 1e-3 * static_cast<double>(t_ns - kNsPerS);
  if (!(sampled_us > 0.0 && sampled_us >= earliest_us)) return t_ns;
  return sampled_us * 1e3 < static_cast<double>(t_ns) ? std::llround(sampled_us) * 1000 : t_ns;
}

bool UlogFormats::declare(std::string_view text) {
  const std::size_t colon = text.find(':');
  if (colon == std::string_view::npos || colon == 0 || formats_.size() >= kMaxFormats) return false;
  std::vector<Member> members;
  std::string_view rest = text.substr(colon + 1);
  while (!rest.empty()) {
    const std::size_t semicolon = std::min(rest.find(';'), rest.size());
    const std::string_view item = rest.substr(0, semicolon);
    rest.remove_prefix(std::min(semicolon + 1, rest.size()));
    const std::size_t space = item.find(' ');
    if (item.empty()) continue;
    if (space == std::string_view::npos || space == 0 || space + 1 == item.size()) return false;
    std::string_view type = item.substr(0, space);
    const std::optional<std::size_t> count = take_index(type, 1);
    if (!count || type.empty()) return false;
    if (members.size() >= kMaxMembers || members_ >= kMaxMembersOfAll) return false;
    ++members_;
    members.push_back({std::string(type), *count, std::string(item.substr(space + 1))});
  }
  formats_[std::string(text.substr(0, colon))] = std::move(members);
  sizes_.clear();
  return true;
}

std::optional<std::size_t> UlogFormats::size_of(const std::string& type, int depth) const {
  if (const std::optional<std::size_t> basic = basic_size(type)) return basic;
  if (const auto known = sizes_.find(type); known != sizes_.end()) return known->second;
  const auto format = formats_.find(type);
  if (format == formats_.end() || depth >= kMaxTypeDepth) return std::nullopt;
  std::optional<std::size_t> size = 0;
  for (const Member& member : format->second) {
    const std::optional<std::size_t> one = size_of(member.type, depth + 1);
    size = one ? std::optional(*size + *one * member.count) : std::nullopt;
    if (!size || *size > kMaxMessageBytes) {
      size = std::nullopt;
      break;
    }
  }
  return sizes_[type] = size;
}

std::optional<UlogField> UlogFormats::find(const std::string& message,
                                           std::string_view path) const {
  std::string type = message;
  std::size_t offset = 0;
  for (int depth = 0; depth < kMaxTypeDepth; ++depth) {
    const auto format = formats_.find(type);
    if (format == formats_.end()) return std::nullopt;
    const std::size_t dot = std::min(path.find('.'), path.size());
    std::string_view name = path.substr(0, dot);
    path.remove_prefix(std::min(dot + 1, path.size()));
    const std::optional<std::size_t> index = take_index(name, 0);
    if (!index) return std::nullopt;
    const Member* found = nullptr;
    for (const Member& member : format->second) {
      const std::optional<std::size_t> size = size_of(member.type, 0);
      if (!size) return std::nullopt;
      if (member.name == name) {
        found = &member;
        offset += *size * *index;
        break;
      }
      offset += *size * member.count;
    }
    if (found == nullptr || *index >= found->count) return std::nullopt;
    if (path.empty()) {
      if (!basic_size(found->type)) return std::nullopt;
      return UlogField{found->type, offset, found->count - *index};
    }
    type = found->type;
  }
  return std::nullopt;
}

}  // namespace overfly::flight::logs
