// Numbers of documents that may be written in two ways: 50 and 50.0 are the same value.
#pragma once

#include <nlohmann/json.hpp>

namespace overfly::server::experiments {

/// The document with whole numbers as integers, at any depth, so that equal values have equal text.
/// Numbers from 2^53 on stay as they are.
[[nodiscard]] nlohmann::json with_plain_numbers(nlohmann::json document);

}  // namespace overfly::server::experiments
