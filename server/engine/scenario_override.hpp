// Overrides put into a scenario document.
#pragma once

#include <nlohmann/json.hpp>

#include "core/result.hpp"
#include "server/engine/scenario.hpp"

namespace overfly::engine {

/// Sets the value at a dotted path, making the objects and arrays on the way. A number names an
/// element of an array, its length the place after the last. Setting `world.builtin...` in a
/// document whose world is of another kind replaces that world, and so with `flight`; setting the
/// whole of `camera` or `cameras` takes the other away. Errors: kInvalidArgument naming the part of
/// the path that does not fit the document.
[[nodiscard]] Status apply_override(const Override& change, nlohmann::json& document);

}  // namespace overfly::engine
