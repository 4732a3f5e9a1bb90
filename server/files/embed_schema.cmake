# Makes a C++ function that returns a JSON schema: -DINPUT= -DOUTPUT= -DHEADER= -DNAMESPACE= -DFUNCTION=
file(READ ${INPUT} text)
file(CONFIGURE OUTPUT ${OUTPUT} CONTENT [==[
// Generated from a file of scenarios/.
#include "@HEADER@"

namespace @NAMESPACE@ {

const std::string& @FUNCTION@() {
  static const std::string text = R"schema(@text@)schema";
  return text;
}

}  // namespace @NAMESPACE@
]==] @ONLY)
