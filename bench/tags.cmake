# Accuracy and speed of the detector of tags.
add_executable(tag_accuracy tag_accuracy.cc)
target_link_libraries(tag_accuracy PRIVATE kestrel::tags CLI11::CLI11 apriltag::apriltag
                                           fmt::fmt ${KESTREL_ARUCO} opencv_imgproc)
