# Generates a source file with the scenario schema, ${overfly_schema_source}, for the including target.
set(schema ${CMAKE_SOURCE_DIR}/scenarios/scenario.schema.json)
set(embed_schema ${CMAKE_SOURCE_DIR}/server/scenario/document/embed_schema.cmake)
set(overfly_schema_source ${CMAKE_CURRENT_BINARY_DIR}/generated/scenario_schema_text.cpp)
add_custom_command(
  OUTPUT ${overfly_schema_source}
  COMMAND ${CMAKE_COMMAND} -DINPUT=${schema} -DOUTPUT=${overfly_schema_source} -P ${embed_schema}
  DEPENDS ${schema} ${embed_schema}
  COMMENT "Embedding the scenario schema")
