#include "vo_bridges/lcm/lcm_option_check.hpp"

#include <algorithm>
#include <cctype>
#include <cstddef>

namespace overfly {
namespace {

/// Same limit as in scenarios; LCM limits a channel name to 63 characters.
constexpr std::size_t kLongestPrefix = 40;

Error invalid_argument(const std::string& field,
                       const std::string& value,
                       const std::string& limit) {
  return {ErrorCode::kInvalidArgument, field + " = " + value + ": must be " + limit};
}

Status check_timeout(const std::string& name, double time_s) {
  constexpr double kLongestS = 86400.0;
  if (time_s > 0.0 && time_s <= kLongestS) return {};
  return invalid_argument(name, std::to_string(time_s), "in (0, 86400]");
}

}  // namespace

Result<lcm::Url> check_lcm_options(const LcmEstimatorOptions& options) {
  Result<lcm::Url> url = lcm::parse_url(options.url);
  if (!url) return url;
  const bool plain = std::all_of(
      options.channel_prefix.begin(), options.channel_prefix.end(), [](unsigned char c) {
        return std::isalnum(c) != 0 || c == '_' || c == '-' || c == '/';
      });
  if (!plain || options.channel_prefix.size() > kLongestPrefix) {
    return invalid_argument(
        "channel_prefix",
        "\"" + options.channel_prefix + "\"",
        "at most " + std::to_string(kLongestPrefix) + " letters, digits, \"_\", \"-\" and \"/\"");
  }
  if (Status status = check_timeout("start_timeout_s", options.start_timeout_s); !status) {
    return status.error();
  }
  if (Status status = check_timeout("answer_timeout_s", options.answer_timeout_s); !status) {
    return status.error();
  }
  if (url->provider != "file") return url;
  const auto mode = url->options.find("mode");
  if (mode == url->options.end() || mode->second != "w") {
    return invalid_argument(
        "url", options.url, "file:///PATH?mode=w: a log that is read cannot record images");
  }
  if (options.lockstep) {
    return invalid_argument(
        "url", options.url, "another one in lockstep: a log returns no answers");
  }
  return url;
}

}  // namespace overfly
