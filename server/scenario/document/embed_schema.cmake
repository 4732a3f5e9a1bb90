# Makes a C++ source of the scenario schema: -DINPUT= -DOUTPUT=
file(READ ${INPUT} text)
file(CONFIGURE OUTPUT ${OUTPUT} CONTENT [==[
// Generated from scenarios/scenario.schema.json.
#include "server/scenario/document/scenario_schema.hpp"

namespace overfly::server {

const std::string& scenario_schema_text() {
  static const std::string text = R"schema(@text@)schema";
  return text;
}

}  // namespace overfly::server
]==] @ONLY)
