# Writes OUTPUT, a C++ source that holds the text of INPUT: cmake -DINPUT=F -DOUTPUT=F -P this.
# Pieces of 8 kB, since a string literal must not be longer than compilers take.
file(READ ${INPUT} text)
string(LENGTH "${text}" length)
set(literals "")
set(at 0)
while(at LESS length)
  string(SUBSTRING "${text}" ${at} 8000 piece)
  string(APPEND literals "    R\"openapi(${piece})openapi\"\n")
  math(EXPR at "${at} + 8000")
endwhile()
file(WRITE ${OUTPUT}
"#include \"server/net/rest/openapi.hpp\"

namespace overfly::net {

const std::string& openapi_text() {
  static const std::string text =
${literals}      ;
  return text;
}

}  // namespace overfly::net
")
