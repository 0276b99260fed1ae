# Accuracy and speed of the detector of tags.
add_executable(tag_accuracy tag_accuracy.cc apriltag_peer.cc)
target_link_libraries(tag_accuracy PRIVATE kestrel::tags CLI11::CLI11 apriltag::apriltag
                                           fmt::fmt ${KESTREL_ARUCO} opencv_imgproc)

add_executable(tag_photograph_accuracy tag_photograph_accuracy.cc apriltag_peer.cc)
target_link_libraries(tag_photograph_accuracy PRIVATE kestrel::tags kestrel::recording CLI11::CLI11
                                              apriltag::apriltag fmt::fmt)

add_executable(tag_lookalike_accuracy tag_lookalike_accuracy.cc)
target_link_libraries(tag_lookalike_accuracy PRIVATE kestrel::tags CLI11::CLI11 fmt::fmt opencv_imgproc)

add_executable(tag_phantom_accuracy tag_phantom_accuracy.cc)
target_link_libraries(tag_phantom_accuracy PRIVATE kestrel::tags kestrel::recording CLI11::CLI11 fmt::fmt
                                           opencv_imgproc)
