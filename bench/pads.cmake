# Errors of the poses of all kinds of pads, in units of their covariances.
add_executable(pad_pose_accuracy pad_pose_accuracy.cc)
target_link_libraries(pad_pose_accuracy PRIVATE kestrel::targets CLI11::CLI11 fmt::fmt opencv_imgproc)

# Extent in the image from which each kind of pad is found.
add_executable(sight_range sight_range.cc)
target_link_libraries(sight_range PRIVATE kestrel::targets CLI11::CLI11 fmt::fmt opencv_imgproc)

# Pads that are followed to the ground under the shadow of the UAV.
add_executable(follow_accuracy follow_accuracy.cc)
target_link_libraries(follow_accuracy PRIVATE kestrel::pipeline kestrel::rendering kestrel::labelled_images
                                              CLI11::CLI11 fmt::fmt opencv_core)
