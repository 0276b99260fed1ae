# Accuracy and speed of the coloured-object pipeline (paper, section 3).
add_executable(hunt_accuracy hunt_accuracy.cc hunt_score.cc)
target_link_libraries(hunt_accuracy PRIVATE kestrel::pipeline kestrel::recording kestrel::evaluation
                                            CLI11::CLI11 fmt::fmt opencv_imgproc)
target_compile_definitions(hunt_accuracy
                           PRIVATE KESTREL_DATA_DIR="${PROJECT_SOURCE_DIR}/../shared/data")

add_executable(hunt_benchmark hunt_benchmark.cc)
target_link_libraries(hunt_benchmark PRIVATE kestrel::objects benchmark::benchmark opencv_imgproc)

add_executable(mover_accuracy mover_accuracy.cc)
target_link_libraries(mover_accuracy PRIVATE kestrel::pipeline kestrel::recording kestrel::recordings
                                             kestrel::evaluation CLI11::CLI11 fmt::fmt)
