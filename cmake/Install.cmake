# `cmake --install` puts the command, the rooms as static libraries, or libkestrel in place of them, the public
# headers, the internal ones behind them, and the package that `find_package(kestrel COMPONENTS ...)` finds. A
# component is what a user wants, and asks only for the libraries that it needs: cmake/kestrelConfig.cmake.in.
include(CMakePackageConfigHelpers)

set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/kestrel)
# Component of each floor, but for these rooms.
set(component_core vision)
set(component_vision vision)
set(component_calibration calibration)
set(component_io io)
set(component_comms flight)
set(component_flight flight)
set(component_simulation simulation)
set(component_app console)
set(component_of_codec io)

add_dependencies(installed kestrel)
set(library_rooms)
get_property(paths GLOBAL PROPERTY KESTREL_ROOMS)
list(REMOVE_ITEM paths ${KESTREL_PROGRAM_ROOMS})
foreach(path IN LISTS paths)
  cmake_path(GET path PARENT_PATH floor)
  cmake_path(GET path FILENAME room)
  list(APPEND library_rooms ${room})
  set(component ${component_${floor}})
  if(component_of_${room})
    set(component ${component_of_${room}})
  endif()
  if(NOT KESTREL_SHARED_LIBRARY)
    install(TARGETS kestrel_${room} EXPORT kestrel_${component})
    add_dependencies(installed kestrel_${room})
  endif()
endforeach()
include(PublicHeaders)
list(TRANSFORM KESTREL_PUBLIC_HEADERS PREPEND include/kestrel/ OUTPUT_VARIABLE public_headers)
install(FILES ${public_headers} ${PROJECT_BINARY_DIR}/generated/kestrel/version.h
        DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/kestrel)
kestrel_exported_headers(exported_headers)
kestrel_included_headers(internal_headers ${exported_headers})
foreach(header IN LISTS internal_headers)
  cmake_path(GET header PARENT_PATH folder)
  install(FILES src/kestrel/${header} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/kestrel/${folder})
endforeach()
if(KESTREL_SHARED_LIBRARY)
  set(config_template cmake/kestrelSharedConfig.cmake.in)
  install(TARGETS kestrel_library EXPORT kestrel_library INCLUDES DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
  install(EXPORT kestrel_library NAMESPACE kestrel:: DESTINATION ${package_dir})
  list(GET OpenCV_INCLUDE_DIRS 0 opencv_includes)
  configure_file(cmake/kestrel.pc.in kestrel.pc @ONLY)
  install(FILES ${PROJECT_BINARY_DIR}/kestrel.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
else()
  set(config_template cmake/kestrelConfig.cmake.in)
  foreach(component vision calibration io flight simulation console)
    install(EXPORT kestrel_${component} NAMESPACE kestrel:: FILE kestrel_${component}.cmake
            DESTINATION ${package_dir})
  endforeach()
endif()

# Configurations of boards and cameras, and the unit that flies from power-on.
install(DIRECTORY examples/ DESTINATION ${CMAKE_INSTALL_DATADIR}/kestrel)

configure_package_config_file(${config_template} kestrelConfig.cmake
                              INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(kestrelConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/kestrelConfig.cmake
              ${PROJECT_BINARY_DIR}/kestrelConfigVersion.cmake DESTINATION ${package_dir})
