# With KESTREL_SHARED_LIBRARY, as packages are built, programs and users link one library, libkestrel, that has all
# rooms but that of the command. What needs DDS is an extension: a library of its own that takes the place of a
# stand-in when it is installed, for the loader looks into the folders of extensions first.
option(KESTREL_SHARED_LIBRARY "Programs link one shared library, libkestrel; what needs DDS extends it" OFF)
# Rooms of the programs alone.
set(KESTREL_PROGRAM_ROOMS app/cli)

if(KESTREL_SHARED_LIBRARY)
  set(KESTREL_EXTENDED dds)
  # Programs use what can be extended themselves, too.
  set(KESTREL_LIBRARY kestrel_library)
  foreach(folder IN LISTS KESTREL_EXTENDED)
    list(APPEND KESTREL_LIBRARY kestrel_${folder}_stand_in)
  endforeach()
  set(KESTREL_EXTENSION_DIR ${CMAKE_INSTALL_FULL_LIBDIR}/kestrel)
  list(TRANSFORM KESTREL_EXTENDED PREPEND ${KESTREL_EXTENSION_DIR}/ OUTPUT_VARIABLE CMAKE_INSTALL_RPATH)
  list(APPEND CMAKE_INSTALL_RPATH ${KESTREL_EXTENSION_DIR}/stand_in)
  set(empty ${PROJECT_BINARY_DIR}/generated/empty.cc)
  file(WRITE ${empty} "")
  add_library(kestrel_library SHARED ${empty})
  add_library(kestrel::kestrel ALIAS kestrel_library)
  set_target_properties(kestrel_library PROPERTIES OUTPUT_NAME kestrel EXPORT_NAME kestrel VERSION ${PROJECT_VERSION}
                                                   SOVERSION ${PROJECT_VERSION_MAJOR})
  target_compile_features(kestrel_library PUBLIC cxx_std_20)
endif()

# kestrel_loaded_library(ROOM FOLDER SOURCE...): libkestrel_ROOM.so, in FOLDER of the extensions.
function(kestrel_loaded_library room folder)
  set(target kestrel_${room}_${folder})
  add_library(${target} SHARED ${ARGN})
  target_compile_options(${target} PRIVATE -Wall -Wextra $<$<CXX_COMPILER_ID:GNU>:-Wshadow> -Werror)
  target_include_directories(
    ${target} PRIVATE ${PROJECT_SOURCE_DIR}/src ${OpenCV_INCLUDE_DIRS}
                      $<TARGET_PROPERTY:Eigen3::Eigen,INTERFACE_INCLUDE_DIRECTORIES>)
  # A stand-in says which package the user wants.
  target_compile_definitions(${target} PRIVATE KESTREL_EXTENSION="kestrel-${room}")
  target_link_libraries(${target} PRIVATE fmt::fmt)
  set_target_properties(${target} PROPERTIES OUTPUT_NAME kestrel_${room} LIBRARY_OUTPUT_DIRECTORY ${folder}
                                             INSTALL_RPATH "")
  add_dependencies(installed ${target})
  # The package for CMake tells the linker about the stand-ins.
  if("${folder}" STREQUAL "stand_in")
    set(export EXPORT kestrel_library)
  endif()
  install(TARGETS ${target} ${export} DESTINATION ${KESTREL_EXTENSION_DIR}/${folder})
endfunction()

# kestrel_extension(ROOM STAND_IN source [SOURCES ...] [LIBRARIES ...]): the extension is made from SOURCES, where
# there are any.
function(kestrel_extension room)
  cmake_parse_arguments(ARG "" "STAND_IN" "SOURCES;LIBRARIES" ${ARGN})
  kestrel_loaded_library(${room} stand_in ${ARG_STAND_IN})
  target_link_libraries(kestrel_library PRIVATE kestrel_${room}_stand_in)
  if(ARG_SOURCES)
    kestrel_loaded_library(${room} ${room} ${ARG_SOURCES})
    target_link_libraries(kestrel_${room}_${room} PRIVATE kestrel_library ${ARG_LIBRARIES})
  endif()
endfunction()

# kestrel_fill_library(): puts the rooms into libkestrel.
function(kestrel_fill_library)
  set(rooms)
  get_property(paths GLOBAL PROPERTY KESTREL_ROOMS)
  list(REMOVE_ITEM paths ${KESTREL_PROGRAM_ROOMS})
  foreach(path IN LISTS paths)
    cmake_path(GET path FILENAME name)
    get_target_property(type kestrel_${name} TYPE)
    if(type STREQUAL STATIC_LIBRARY)
      list(APPEND rooms kestrel_${name})
    endif()
  endforeach()
  list(TRANSFORM rooms REPLACE "(.+)" "$<TARGET_FILE:\\1>" OUTPUT_VARIABLE archives)
  list(JOIN archives "," archives)
  target_link_options(kestrel_library PRIVATE -Wl,--whole-archive,${archives},--no-whole-archive -Wl,--as-needed)
  # Once more, for what they link themselves.
  target_link_libraries(kestrel_library PRIVATE ${rooms} PUBLIC Eigen3::Eigen opencv_core opencv_imgproc)
endfunction()
