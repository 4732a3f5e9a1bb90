// Checks that the lengths announced by a message fit into its bytes.
#pragma once

#include <cstdint>
#include <overfly_lcm/debug_t.hpp>
#include <overfly_lcm/pose_t.hpp>
#include <overfly_lcm/status_t.hpp>
#include <span>

namespace overfly::lcm {

/// The decoders of lcm-gen allocate as many elements as a message announces before they check that
/// the elements exist: a message of 200 bytes may request 80 GB. These functions walk over the
/// bytes without allocating memory.
/// @param type  selects the message type; its value is not used
[[nodiscard]] bool lengths_fit(std::span<const std::uint8_t> bytes,
                               const overfly_lcm::pose_t& type);
[[nodiscard]] bool lengths_fit(std::span<const std::uint8_t> bytes,
                               const overfly_lcm::debug_t& type);
[[nodiscard]] bool lengths_fit(std::span<const std::uint8_t> bytes,
                               const overfly_lcm::status_t& type);

}  // namespace overfly::lcm
