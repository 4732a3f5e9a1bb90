#include <algorithm>

#include "core/text/text_fields.hpp"
#include "flight/mavlink/vehicle/parameters.hpp"

namespace overfly::flight::mavlink {

Result<std::vector<Parameter>> read_parameter_file(const std::filesystem::path& file) {
  const Result<FieldFile> fields = FieldFile::read(file);
  if (!fields) return fields.error();
  std::vector<Parameter> parameters;
  for (const FieldLine& line : fields->lines()) {
    if (Status status = fields->expect_fields(line, 2); !status) return status.error();
    Parameter parameter;
    parameter.name = line.fields[0];
    if (!is_parameter_name(parameter.name)) {
      return fields->bad_field(
          line, 1, "must be 1 to 16 letters, digits or underscores: the name of a parameter");
    }
    const Result<double> value = fields->number(line, 2);
    if (!value) return value.error();
    parameter.value = *value;
    const auto same = std::find_if(parameters.begin(), parameters.end(), [&](const auto& each) {
      return each.name == parameter.name;
    });
    if (same != parameters.end()) {
      *same = parameter;
      continue;
    }
    constexpr std::size_t kMaxParameters = 10000;
    if (parameters.size() >= kMaxParameters) {
      return fields->bad_line(line, "a vehicle has at most 10000 parameters");
    }
    parameters.push_back(parameter);
  }
  return parameters;
}

}  // namespace overfly::flight::mavlink
