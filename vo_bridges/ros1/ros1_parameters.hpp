// Reads and writes parameters of estimators on the ROS parameter server.
#pragma once

#include <map>
#include <string>

#include "core/result.hpp"
#include "vo_bridges/parameter.hpp"

namespace overfly::ros1 {

/// Sets parameters below a namespace. Whole numbers are set as integers: nodes distinguish the
/// types. Errors: kInternal naming the parameter.
[[nodiscard]] Status write_parameters(const std::string& name_space,
                                      const VoParameters& parameters);

/// All parameters below a namespace as text, by relative name ("tracker/levels").
[[nodiscard]] std::map<std::string, std::string> read_parameters(const std::string& name_space);

}  // namespace overfly::ros1
