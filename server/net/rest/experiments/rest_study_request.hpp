// The body of a request for a study.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "core/result.hpp"
#include "server/experiments/studies/study_request.hpp"

namespace overfly::net {

/// {"kind": "explain" | "predict" | "hunt", ...} with the fields of that kind (docs/PROTOCOL.md).
/// Errors: kInvalidArgument naming a field and its limit.
[[nodiscard]] Result<server::experiments::StudyRequest> parse_study_request(
    const std::string& text);

/// The limits of the fields, their defaults and the names of causes, for forms.
[[nodiscard]] nlohmann::json study_limits_json();

}  // namespace overfly::net
