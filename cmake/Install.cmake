# `cmake --install` puts the command, the rooms as static libraries and their headers in place, and
# the package that `find_package(kestrel)` finds. The rooms cli, ros and ros1 belong to their programs alone.
include(CMakePackageConfigHelpers)

get_property(rooms GLOBAL PROPERTY KESTREL_ROOMS)
list(REMOVE_ITEM rooms kestrel_cli kestrel_ros kestrel_ros1)
set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/kestrel)

install(TARGETS ${rooms} EXPORT kestrel)
install(EXPORT kestrel NAMESPACE kestrel:: FILE kestrelTargets.cmake DESTINATION ${package_dir})
install(
  DIRECTORY src/kestrel
  DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}
  FILES_MATCHING
  PATTERN "*.h"
  PATTERN "test_*.h" EXCLUDE
  PATTERN "cli" EXCLUDE
  PATTERN "ros" EXCLUDE
  PATTERN "ros1" EXCLUDE)

# Configurations of boards and cameras, and the unit that flies from power-on.
install(DIRECTORY examples/ DESTINATION ${CMAKE_INSTALL_DATADIR}/kestrel)

configure_package_config_file(cmake/kestrelConfig.cmake.in kestrelConfig.cmake
                              INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(kestrelConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/kestrelConfig.cmake
              ${PROJECT_BINARY_DIR}/kestrelConfigVersion.cmake DESTINATION ${package_dir})
