#include "core/text/pattern.hpp"

#include <map>
#include <mutex>
#include <utility>

namespace overfly {

const std::regex& compiled_pattern(const std::string& pattern, std::regex::flag_type flags) {
  static std::mutex mutex;
  static std::map<std::pair<std::string, unsigned>, std::regex> patterns;
  const std::scoped_lock lock(mutex);
  const auto key = std::pair(pattern, static_cast<unsigned>(flags));
  const auto found = patterns.find(key);
  return found != patterns.end() ? found->second
                                 : patterns.emplace(key, std::regex(pattern, flags)).first->second;
}

}  // namespace overfly
