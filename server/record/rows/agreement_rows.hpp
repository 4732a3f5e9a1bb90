// How the recorded images of a run agree with rendered ones: agreement.jsonl.
#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "evaluation/images/image_agreement.hpp"

namespace overfly::server {

struct AgreementRow {
  std::int64_t frame = 0;
  std::int64_t t_ns = 0;
  /// Empty if the recorded image is missing or cannot be decoded.
  std::optional<evaluation::ImageAgreement> agreement;
  std::string problem;  ///< why there is none
};

/// agreement.jsonl
[[nodiscard]] std::filesystem::path agreement_file(const std::filesystem::path& folder);

[[nodiscard]] nlohmann::json json_from(const AgreementRow& row);

/// The rows of a run; a last line that was cut off is left out.
/// Errors: kNotFound for a run without such a file; kUnreadable naming line and field.
[[nodiscard]] Result<std::vector<AgreementRow>> read_agreement(const std::filesystem::path& folder);

}  // namespace overfly::server
