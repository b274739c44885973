# cmake --install: the library with its public headers as the CMake package `fovea`, and the data files that graphs name.
include(CMakePackageConfigHelpers)

install(TARGETS fovea_framework EXPORT fovea-targets LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
if(FOVEA_OPENIMAGEIO)
  install(TARGETS fovea_images LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
endif()
install(DIRECTORY ${PROJECT_SOURCE_DIR}/framework/include/fovea DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(DIRECTORY ${PROJECT_SOURCE_DIR}/shaders ${PROJECT_SOURCE_DIR}/graphs DESTINATION ${CMAKE_INSTALL_DATADIR}/fovea)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/samples/scenes DESTINATION ${CMAKE_INSTALL_DATADIR}/fovea
  FILES_MATCHING PATTERN "*.json" PATTERN "*.csv" PATTERN "*.md")
install(DIRECTORY ${PROJECT_SOURCE_DIR}/passes DESTINATION ${CMAKE_INSTALL_DATADIR}/fovea
  FILES_MATCHING PATTERN "*.pass.json" PATTERN "*.comp" PATTERN "*.frag" PATTERN "*.vert" PATTERN "*.glsl" PATTERN "records.h")
install(DIRECTORY ${PROJECT_SOURCE_DIR}/benchmarks/suites ${PROJECT_SOURCE_DIR}/benchmarks/page
  ${PROJECT_SOURCE_DIR}/benchmarks/suite_page
  DESTINATION ${CMAKE_INSTALL_DATADIR}/fovea/benchmarks
  FILES_MATCHING PATTERN "*.json" PATTERN "*.py" PATTERN "__pycache__" EXCLUDE)
install(FILES ${PROJECT_SOURCE_DIR}/benchmarks/paper.json ${PROJECT_SOURCE_DIR}/benchmarks/paper.py
  ${PROJECT_SOURCE_DIR}/benchmarks/report.py DESTINATION ${CMAKE_INSTALL_DATADIR}/fovea/benchmarks)
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})

set(FOVEA_PACKAGE_DIR ${CMAKE_INSTALL_LIBDIR}/cmake/fovea)
install(EXPORT fovea-targets NAMESPACE fovea:: DESTINATION ${FOVEA_PACKAGE_DIR})
configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/fovea-config.cmake.in ${CMAKE_CURRENT_BINARY_DIR}/fovea-config.cmake
  INSTALL_DESTINATION ${FOVEA_PACKAGE_DIR})
# Before 1.0 a minor version may change interfaces.
write_basic_package_version_file(${CMAKE_CURRENT_BINARY_DIR}/fovea-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/fovea-config.cmake ${CMAKE_CURRENT_BINARY_DIR}/fovea-config-version.cmake
  ${CMAKE_CURRENT_LIST_DIR}/fovea-plugins.cmake
  DESTINATION ${FOVEA_PACKAGE_DIR})
