# Makes a C++ source of airframe files: -DINPUTS= (separated by commas) -DOUTPUT=
string(REPLACE "," ";" inputs "${INPUTS}")
set(entries)
foreach(input ${inputs})
  get_filename_component(name ${input} NAME_WE)
  file(READ ${input} text)
  string(APPEND entries "      {\"${name}\", R\"airframe(${text})airframe\"},\n")
endforeach()
file(CONFIGURE OUTPUT ${OUTPUT} CONTENT [==[
// Generated from scenarios/airframes.
#include "flight/dynamics/builtin_airframes.hpp"

namespace overfly::dynamics {

std::span<const BuiltinAirframe> builtin_airframes() {
  static constexpr BuiltinAirframe kAirframes[] = {
@entries@  };
  return kAirframes;
}

}  // namespace overfly::dynamics
]==] @ONLY)
