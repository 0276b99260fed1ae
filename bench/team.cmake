# What a team's messages cost (paper, section 3.7).
add_executable(team_benchmark team_benchmark.cc)
target_link_libraries(team_benchmark PRIVATE kestrel::team benchmark::benchmark)
