#include "odometry/shell/parameter_table.hpp"

#include <cmath>
#include <sstream>

namespace overfly::odometry {

Error parameter_error(const std::string& field, double value, const std::string& limit) {
  std::ostringstream text;
  text << "parameters." << field << " = " << value << ": must be " << limit;
  return {ErrorCode::kInvalidArgument, text.str()};
}

bool is_whole(double value) { return std::isfinite(value) && value == std::floor(value); }

}  // namespace overfly::odometry
