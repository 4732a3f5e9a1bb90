# overfly_embed_schema(OUTPUT SCHEMA HEADER NAMESPACE FUNCTION)
#
# Generates the source file OUTPUT with FUNCTION of HEADER, which returns the text of scenarios/SCHEMA.
function(overfly_embed_schema output schema header namespace function)
  set(input ${CMAKE_SOURCE_DIR}/scenarios/${schema})
  set(script ${CMAKE_SOURCE_DIR}/server/files/embed_schema.cmake)
  add_custom_command(
    OUTPUT ${output}
    COMMAND ${CMAKE_COMMAND} -DINPUT=${input} -DOUTPUT=${output} -DHEADER=${header}
            -DNAMESPACE=${namespace} -DFUNCTION=${function} -P ${script}
    DEPENDS ${input} ${script}
    COMMENT "Embedding ${schema}")
endfunction()

set(overfly_schema_source ${CMAKE_CURRENT_BINARY_DIR}/generated/scenario_schema_text.cpp)
overfly_embed_schema(${overfly_schema_source} scenario.schema.json
  server/scenario/document/scenario_schema.hpp overfly::server scenario_schema_text)
