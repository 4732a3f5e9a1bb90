#include "server/experiments/keys/plain_numbers.hpp"

#include <cmath>
#include <cstdint>

namespace overfly::server::experiments {
namespace {

using Json = nlohmann::json;

constexpr double kFirstInexact = 9007199254740992.0;  // 2^53

// NOLINTNEXTLINE(misc-no-recursion): documents from outside are at most kMaxJsonDepth deep
void make_plain(Json& value) {
  if (value.is_structured()) {
    for (Json& child : value) make_plain(child);
  } else if (value.is_number_float()) {
    const auto number = value.get<double>();
    if (std::abs(number) < kFirstInexact && std::trunc(number) == number) {
      value = static_cast<std::int64_t>(number);
    }
  }
}

}  // namespace

Json with_plain_numbers(Json document) {
  make_plain(document);
  return document;
}

}  // namespace overfly::server::experiments
