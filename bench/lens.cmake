# Lenses from views of the landing pattern.
add_executable(lens_accuracy lens_accuracy.cc landing_frames.cc landing_score.cc)
target_link_libraries(lens_accuracy PRIVATE kestrel::lens kestrel::landing
                                            kestrel::recording kestrel::labelled_images CLI11::CLI11
                                            fmt::fmt)
target_compile_definitions(lens_accuracy
                           PRIVATE KESTREL_DATA_DIR="${PROJECT_SOURCE_DIR}/../shared/data")
