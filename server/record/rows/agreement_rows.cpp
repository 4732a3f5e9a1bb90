#include "server/record/rows/agreement_rows.hpp"

#include <utility>

#include "server/files/file_field.hpp"
#include "server/files/whole_file.hpp"

namespace overfly::server {
namespace {

using Json = nlohmann::json;
using evaluation::ImageAgreement;

Json number_or_null(const std::optional<double>& value) { return value ? Json(*value) : Json(); }

std::optional<double> number_if_any(const FileField& row, const char* name) {
  const FileField value = row.at(name);
  if (value.is_null()) return std::nullopt;
  return value.number();
}

AgreementRow read_row(const FileField& value) {
  constexpr std::int64_t kMostCorners = 1 << 30;
  AgreementRow row;
  row.frame = value.at("frame").integer();
  row.t_ns = value.at("t_ns").integer();
  if (const auto problem = value.find("problem")) {
    row.problem = problem->text();
    return row;
  }
  ImageAgreement agreement;
  if (const FileField field = value.at("offset_px"); !field.is_null()) {
    const std::vector<double> offset = field.numbers(2);
    agreement.offset_px = Eigen::Vector2d(offset[0], offset[1]);
  }
  agreement.peak = number_if_any(value, "peak");
  agreement.correlation = number_if_any(value, "correlation");
  agreement.correlation_aligned = number_if_any(value, "correlation_aligned");
  agreement.corners_real = static_cast<int>(value.at("corners_real").integer(0, kMostCorners));
  agreement.corners_virtual =
      static_cast<int>(value.at("corners_virtual").integer(0, kMostCorners));
  row.agreement = agreement;
  return row;
}

}  // namespace

std::filesystem::path agreement_file(const std::filesystem::path& folder) {
  return folder / "agreement.jsonl";
}

Json json_from(const AgreementRow& row) {
  Json value = {{"frame", row.frame}, {"t_ns", row.t_ns}};
  if (!row.agreement) {
    value["problem"] = row.problem;
    return value;
  }
  const ImageAgreement& agreement = *row.agreement;
  value["offset_px"] =
      agreement.offset_px ? Json{agreement.offset_px->x(), agreement.offset_px->y()} : Json();
  value["peak"] = number_or_null(agreement.peak);
  value["correlation"] = number_or_null(agreement.correlation);
  value["correlation_aligned"] = number_or_null(agreement.correlation_aligned);
  value["corners_real"] = agreement.corners_real;
  value["corners_virtual"] = agreement.corners_virtual;
  return value;
}

Result<std::vector<AgreementRow>> read_agreement(const std::filesystem::path& folder) {
  const std::filesystem::path file = agreement_file(folder);
  std::error_code ignored;
  if (!std::filesystem::exists(file, ignored)) {
    return Error{ErrorCode::kNotFound,
                 folder.string() + ": the run compared no recorded images with rendered ones"};
  }
  const Result<std::vector<Json>> lines = read_lines(file);
  if (!lines) return lines.error();
  std::vector<AgreementRow> rows;
  for (const Json& line : *lines) {
    Result<AgreementRow> row = guarded_fields([&] { return read_row(FileField(line)); });
    if (!row) {
      return row.error().in(file.string() + ", row " + std::to_string(rows.size() + 1));
    }
    rows.push_back(std::move(*row));
  }
  return rows;
}

}  // namespace overfly::server
