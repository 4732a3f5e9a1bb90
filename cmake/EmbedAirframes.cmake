# Generates a source file with the built-in airframes, ${overfly_airframes_source}, for the including
# target.
file(GLOB airframes CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/scenarios/airframes/*.json)
set(embed_airframes ${CMAKE_SOURCE_DIR}/flight/dynamics/embed_airframes.cmake)
set(overfly_airframes_source ${CMAKE_CURRENT_BINARY_DIR}/generated/builtin_airframes.cpp)
string(REPLACE ";" "," airframe_list "${airframes}")
add_custom_command(
  OUTPUT ${overfly_airframes_source}
  COMMAND ${CMAKE_COMMAND} -DINPUTS=${airframe_list} -DOUTPUT=${overfly_airframes_source}
          -P ${embed_airframes}
  DEPENDS ${airframes} ${embed_airframes}
  COMMENT "Embedding the airframes"
  VERBATIM)
