add_executable(console_benchmark console_benchmark.cc)
target_link_libraries(console_benchmark PRIVATE kestrel::console kestrel::pipeline kestrel::stills
                                                nlohmann_json::nlohmann_json fmt::fmt)
