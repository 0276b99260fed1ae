# Accuracy and speed of the landing pattern detector (paper, sections 2.1 to 2.5).

add_executable(kestrel_accuracy kestrel_accuracy.cc landing_frames.cc landing_score.cc
                                landing_variants.cc)
target_link_libraries(
  kestrel_accuracy PRIVATE kestrel::codec kestrel::landing kestrel::recording kestrel::labelled_images
                           CLI11::CLI11 fmt::fmt opencv_imgproc)
target_compile_definitions(kestrel_accuracy
                           PRIVATE KESTREL_DATA_DIR="${PROJECT_SOURCE_DIR}/../shared/data")

add_executable(robustness_accuracy robustness_accuracy.cc landing_falsehoods.cc landing_frames.cc
                                   landing_score.cc)
target_link_libraries(robustness_accuracy
                      PRIVATE kestrel::landing kestrel::recording kestrel::labelled_images CLI11::CLI11
                              fmt::fmt)
target_compile_definitions(robustness_accuracy
                           PRIVATE KESTREL_DATA_DIR="${PROJECT_SOURCE_DIR}/../shared/data")

add_executable(light_accuracy light_accuracy.cc landing_frames.cc landing_score.cc)
target_link_libraries(light_accuracy PRIVATE kestrel::codec kestrel::landing kestrel::recording kestrel::labelled_images
                                             CLI11::CLI11 fmt::fmt)
target_compile_definitions(light_accuracy
                           PRIVATE KESTREL_DATA_DIR="${PROJECT_SOURCE_DIR}/../shared/data")

add_executable(step_ablation step_ablation.cc landing_frames.cc landing_score.cc)
target_link_libraries(step_ablation PRIVATE kestrel::landing kestrel::recording kestrel::labelled_images CLI11::CLI11
                                            fmt::fmt)
target_compile_definitions(step_ablation
                           PRIVATE KESTREL_DATA_DIR="${PROJECT_SOURCE_DIR}/../shared/data")
add_executable(sign_accuracy sign_accuracy.cc landing_frames.cc landing_score.cc landing_signs.cc)
target_link_libraries(sign_accuracy PRIVATE kestrel::codec kestrel::landing kestrel::recording
                                            kestrel::labelled_images CLI11::CLI11 fmt::fmt)

add_executable(landing_benchmark landing_benchmark.cc apriltag_peer.cc landing_frames.cc
                                 landing_peers.cc landing_score.cc)
add_executable(landing_speed landing_speed.cc apriltag_peer.cc landing_frames.cc landing_peers.cc
                             landing_score.cc)
target_link_libraries(landing_benchmark PRIVATE benchmark::benchmark)
foreach(program landing_benchmark landing_speed)
  target_link_libraries(
    ${program} PRIVATE kestrel::landing kestrel::recording kestrel::labelled_images kestrel::tags
                       CLI11::CLI11 apriltag::apriltag fmt::fmt ${KESTREL_ARUCO} opencv_imgproc)
  target_compile_definitions(${program}
                             PRIVATE KESTREL_DATA_DIR="${PROJECT_SOURCE_DIR}/../shared/data")
endforeach()

add_executable(train_print_score train_print_score.cc print_score_training.cc landing_falsehoods.cc landing_signs.cc
                                 landing_frames.cc landing_hardships.cc landing_score.cc
                                 landing_variants.cc)
target_link_libraries(train_print_score PRIVATE kestrel::codec kestrel::landing kestrel::recording
                                                kestrel::labelled_images CLI11::CLI11 fmt::fmt
                                                opencv_imgproc)
target_compile_definitions(train_print_score
                           PRIVATE KESTREL_DATA_DIR="${PROJECT_SOURCE_DIR}/../shared/data")

add_executable(landing_cost landing_cost.cc landing_frames.cc)
target_link_libraries(landing_cost PRIVATE kestrel::landing kestrel::recording
                                           kestrel::labelled_images CLI11::CLI11 fmt::fmt)
target_compile_definitions(landing_cost PRIVATE KESTREL_DATA_DIR="${PROJECT_SOURCE_DIR}/../shared/data")
