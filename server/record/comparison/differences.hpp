// What differs between documents, for people. Pure functions of their arguments.
#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace overfly::server {

/// Every value of a document that is neither an object nor an array, with its dotted path; empty
/// objects and arrays as values too. Elements of an array count from 0; if all are objects with
/// different texts in `name`, as cameras and estimators, that name stands for the number.
/// Texts are values as they are, others as JSON.
[[nodiscard]] std::vector<std::pair<std::string, std::string>> leaves_of(
    const nlohmann::json& document);

struct Difference {
  std::string field;
  std::vector<std::optional<std::string>> values;  ///< one for each document; empty = absent
};

struct Differences {
  std::vector<Difference> fields;  ///< in alphabetical order of each object's keys
  std::size_t left_out = 0;        ///< fields beyond the limit
};

inline constexpr std::size_t kMaxDifferences = 200;

/// The fields whose values are not the same in all documents, at the deepest level that all of them
/// have: an object that some lack is one field, with its JSON as the value. None for fewer than two
/// documents.
[[nodiscard]] Differences differences_between(const std::vector<nlohmann::json>& documents,
                                              std::size_t most = kMaxDifferences);

}  // namespace overfly::server
