// Whether the lengths that a message announces fit into its bytes.
#pragma once

#include <cstdint>
#include <overfly_lcm/debug_t.hpp>
#include <overfly_lcm/pose_t.hpp>
#include <overfly_lcm/status_t.hpp>
#include <span>

namespace overfly {

/// lcm-gen's decoders make room for as many elements as a message announces before they look for
/// them: a message of 200 bytes may ask for 80 GB. These walk over the bytes without taking memory.
/// @param type  says which message it is; its value is not used
[[nodiscard]] bool lengths_fit(std::span<const std::uint8_t> bytes,
                               const overfly_lcm::pose_t& type);
[[nodiscard]] bool lengths_fit(std::span<const std::uint8_t> bytes,
                               const overfly_lcm::debug_t& type);
[[nodiscard]] bool lengths_fit(std::span<const std::uint8_t> bytes,
                               const overfly_lcm::status_t& type);

}  // namespace overfly
