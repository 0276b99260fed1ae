# kestrel_room(NAME SOURCES ... [HEAVY ...] [ALONE ...] [TESTS ...] [PUBLIC ...] [PRIVATE ...] [TEST_LINKS ...])
#
# One library per room of src/kestrel, `kestrel_<name>` (alias `kestrel::<name>`). PUBLIC names the
# rooms and libraries that its headers use: these links are the arrows between the rooms, and
# scripts/check-layers holds the includes to them. In a unity build SOURCES are one unit, and HEAVY,
# which share headers that take long to compile, another. ALONE are not joined with others: sources
# that Highway compiles for one instruction set after the other, and those that have names in common
# with another source. TESTS become one test binary per room.
function(kestrel_room name)
  cmake_parse_arguments(ARG "" "" "SOURCES;HEAVY;ALONE;TESTS;PUBLIC;PRIVATE;TEST_LINKS" ${ARGN})
  set(target kestrel_${name})
  if(ARG_SOURCES)
    add_library(${target} STATIC ${ARG_SOURCES} ${ARG_HEAVY} ${ARG_ALONE})
    if(ARG_HEAVY)
      set_target_properties(${target} PROPERTIES UNITY_BUILD_MODE GROUP)
      set_source_files_properties(${ARG_SOURCES} PROPERTIES UNITY_GROUP light)
      set_source_files_properties(${ARG_HEAVY} PROPERTIES UNITY_GROUP heavy)
    endif()
    set_source_files_properties(${ARG_ALONE} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
    set(scope PUBLIC)
    target_link_libraries(${target} PUBLIC ${ARG_PUBLIC} PRIVATE ${ARG_PRIVATE})
    # Clang's -Wshadow also refuses a local name that is a constant of another file of the unit.
    target_compile_options(${target} PRIVATE -Wall -Wextra $<$<CXX_COMPILER_ID:GNU>:-Wshadow> -Werror)
    # Eigen's blocked product is for larger matrices than a state's, and takes seconds to compile.
    target_compile_definitions(${target} PRIVATE EIGEN_CACHEFRIENDLY_PRODUCT_THRESHOLD=16)
  else()
    add_library(${target} INTERFACE)
    set(scope INTERFACE)
    target_link_libraries(${target} INTERFACE ${ARG_PUBLIC})
  endif()
  add_library(kestrel::${name} ALIAS ${target})
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${name} POSITION_INDEPENDENT_CODE ON)
  target_compile_features(${target} ${scope} cxx_std_20)
  target_include_directories(
    ${target} ${scope} $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/src> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  if(KESTREL_BUILD_TESTS AND ARG_TESTS)
    add_executable(${target}_test ${ARG_TESTS})
    target_link_libraries(${target}_test PRIVATE ${target} ${ARG_TEST_LINKS})
    kestrel_test(${target}_test ${name})
  endif()
endfunction()

# kestrel_test(TARGET PREFIX): TARGET is a binary of tests, which ctest knows as PREFIX/<name>. The
# target `tests` builds all of them.
function(kestrel_test target prefix)
  target_link_libraries(${target} PRIVATE GTest::gmock GTest::gtest_main)
  target_compile_options(${target} PRIVATE -Wall -Wextra -Werror)
  # More optimisation of a test takes longer than it saves. With less, GCC cannot follow some initialisations.
  target_compile_options(
    ${target} PRIVATE "$<$<AND:$<CONFIG:Release>,$<CXX_COMPILER_ID:GNU>>:-O1;-Wno-maybe-uninitialized>")
  gtest_discover_tests(${target} TEST_PREFIX ${prefix}/ DISCOVERY_MODE PRE_TEST
                       PROPERTIES TIMEOUT 600)
  add_dependencies(tests ${target})
endfunction()
