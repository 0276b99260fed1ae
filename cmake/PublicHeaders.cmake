# The public headers are those of include/kestrel, and version.h, which CMake makes. Each has a doc
# comment with an example, and exports the header of a room that has its name. That header and those
# that it includes are installed, too, but are internal, as everything below src/kestrel is.
file(GLOB KESTREL_PUBLIC_HEADERS CONFIGURE_DEPENDS RELATIVE ${PROJECT_SOURCE_DIR}/include/kestrel
     ${PROJECT_SOURCE_DIR}/include/kestrel/*.h)

# kestrel_exported_headers(RESULT): the headers below src/kestrel that the public headers export.
function(kestrel_exported_headers result)
  set(exported)
  foreach(header IN LISTS KESTREL_PUBLIC_HEADERS)
    file(STRINGS ${PROJECT_SOURCE_DIR}/include/kestrel/${header} include REGEX "^#include ")
    if(NOT include MATCHES "^#include \"kestrel/([a-z_0-9/]+/${header})\"  // IWYU pragma: export$")
      message(FATAL_ERROR "include/kestrel/${header}: expected one include, of a room's ${header}, with \"// IWYU pragma: export\"")
    endif()
    list(APPEND exported ${CMAKE_MATCH_1})
  endforeach()
  set(${result} ${exported} PARENT_SCOPE)
endfunction()

# kestrel_included_headers(RESULT HEADER...): the headers below src/kestrel and all that they include.
function(kestrel_included_headers result)
  set(found)
  set(open ${ARGN})
  while(open)
    list(POP_FRONT open header)
    if(header IN_LIST found)
      continue()
    endif()
    list(APPEND found ${header})
    file(STRINGS ${PROJECT_SOURCE_DIR}/src/kestrel/${header} includes REGEX "^#include \"kestrel/")
    list(TRANSFORM includes REPLACE "#include \"kestrel/([^\"]*)\".*" "\\1")
    list(APPEND open ${includes})
  endwhile()
  set(${result} ${found} PARENT_SCOPE)
endfunction()
