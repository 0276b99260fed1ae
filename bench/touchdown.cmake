# Landings on a moving vehicle in closed loop (paper, section 4).
add_executable(touchdown_accuracy touchdown_accuracy.cc)
target_link_libraries(touchdown_accuracy PRIVATE kestrel::recordings kestrel::evaluation
                                                 CLI11::CLI11 fmt::fmt)

# Two cameras on one UAV.
add_executable(camera_pair_accuracy camera_pair_accuracy.cc)
target_link_libraries(camera_pair_accuracy PRIVATE kestrel::recordings kestrel::evaluation
                                                   CLI11::CLI11 fmt::fmt yaml-cpp)

# A camera that looks ahead.
add_executable(oblique_accuracy oblique_accuracy.cc)
target_link_libraries(oblique_accuracy PRIVATE kestrel::recordings CLI11::CLI11 fmt::fmt)

# Landings through a camera over a network.
add_executable(late_video_accuracy late_video_accuracy.cc)
target_link_libraries(late_video_accuracy PRIVATE kestrel::fly PkgConfig::GSTREAMER
                                                  PkgConfig::GSTREAMER_RTSP_SERVER CLI11::CLI11 fmt::fmt)

# The video of a flight.
add_executable(video_cost video_cost.cc)
target_link_libraries(video_cost PRIVATE kestrel::onboard opencv_imgproc PkgConfig::GSTREAMER fmt::fmt)
