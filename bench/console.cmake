add_executable(console_benchmark console_benchmark.cc)
target_link_libraries(console_benchmark PRIVATE kestrel_test_browser kestrel::console kestrel::pipeline kestrel::labelled_images
                                                nlohmann_json::nlohmann_json fmt::fmt)
