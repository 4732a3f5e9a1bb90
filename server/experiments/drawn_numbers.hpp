// Random numbers that are the same with every standard library.
#pragma once

#include <cstddef>
#include <random>
#include <vector>

namespace overfly::server::experiments {

/// A number in [0, 1).
[[nodiscard]] double unit_number(std::mt19937_64& random);
/// 0 to count - 1 in a random order.
[[nodiscard]] std::vector<std::size_t> shuffled(std::size_t count, std::mt19937_64& random);

}  // namespace overfly::server::experiments
