#include "server/files/plain_name.hpp"

#include <algorithm>

namespace overfly::server {

bool is_plain_name(const std::string& name) {
  const auto allowed = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
           c == '-' || c == '.';
  };
  return !name.empty() && name.size() <= 200 && name.front() != '.' &&
         std::all_of(name.begin(), name.end(), allowed);
}

bool is_given_name(const std::string& name) {
  constexpr std::size_t kLongest = 64;
  return is_plain_name(name) && name.size() <= kLongest && name.find('.') == std::string::npos &&
         name.front() != '_' && name.front() != '-';
}

}  // namespace overfly::server
