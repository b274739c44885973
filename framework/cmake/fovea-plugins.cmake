# How plug-ins and their tests are built: part of the installed package, and used by the tests of the project.

# fovea_add_pass_plugin(<name> <sources>...): a shared library <name>.so for `fovea --plugin`. A folder `shaders` beside
# the CMakeLists.txt is copied beside the library, where the program looks for the passes' shaders.
function(fovea_add_pass_plugin name)
  if(NOT ARGN)
    message(FATAL_ERROR "fovea_add_pass_plugin(${name}) names no source file.")
  endif()
  add_library(${name} MODULE ${ARGN})
  # Passes of two plug-ins may have classes of the same name, and nothing is looked up in a plug-in by name.
  set_target_properties(${name} PROPERTIES PREFIX "" CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON)
  target_link_libraries(${name} PRIVATE fovea::fovea)
  if(IS_DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR}/shaders)
    add_custom_target(${name}_shaders ALL COMMAND ${CMAKE_COMMAND} -E copy_directory
      ${CMAKE_CURRENT_SOURCE_DIR}/shaders $<TARGET_FILE_DIR:${name}>/shaders)
  endif()
endfunction()

# fovea_add_pass_test(<name> <plugin> <sources>...): a GoogleTest program, known to CTest, that runs passes of the plug-in
# alone (fovea/test.h). FOVEA_PLUGIN is the plug-in's file, for fovea::graph::loadPlugin(). CTest knows the test only if
# enable_testing() was called.
function(fovea_add_pass_test name plugin)
  if(NOT ARGN)
    message(FATAL_ERROR "fovea_add_pass_test(${name} ${plugin}) names no source file.")
  endif()
  if(NOT TARGET ${plugin})
    message(FATAL_ERROR "fovea_add_pass_test(${name} ${plugin}): fovea_add_pass_plugin() has made no plug-in `${plugin}`.")
  endif()
  find_package(GTest REQUIRED)
  add_executable(${name} ${ARGN})
  target_link_libraries(${name} PRIVATE fovea::fovea GTest::gtest_main)
  target_compile_definitions(${name} PRIVATE FOVEA_PLUGIN="$<TARGET_FILE:${plugin}>")
  add_dependencies(${name} ${plugin})
  if(TARGET ${plugin}_shaders)
    add_dependencies(${name} ${plugin}_shaders)
  endif()
  add_test(NAME ${name} COMMAND ${name})
endfunction()
