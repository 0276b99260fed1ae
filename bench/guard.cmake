# The way of a frame through the guard; started from the guard's folder.
add_executable(guard_benchmark guard_benchmark.cc)
target_link_libraries(guard_benchmark PRIVATE kestrel::guard benchmark::benchmark_main)
target_compile_definitions(guard_benchmark PRIVATE KESTREL_GUARD="$<TARGET_FILE:kestrel-guard>")
add_dependencies(guard_benchmark kestrel-guard)
