#include "server/experiments/drawn_numbers.hpp"

#include <numeric>
#include <utility>

namespace overfly::server::experiments {

double unit_number(std::mt19937_64& random) {
  constexpr double kPerStep = 1.0 / 9007199254740992.0;  // 2^-53
  return static_cast<double>(random() >> 11U) * kPerStep;
}

std::vector<std::size_t> shuffled(std::size_t count, std::mt19937_64& random) {
  std::vector<std::size_t> order(count);
  std::iota(order.begin(), order.end(), std::size_t{0});
  for (std::size_t i = count; i > 1; --i) {
    const auto other = static_cast<std::size_t>(unit_number(random) * static_cast<double>(i));
    std::swap(order[i - 1], order[other]);
  }
  return order;
}

}  // namespace overfly::server::experiments
