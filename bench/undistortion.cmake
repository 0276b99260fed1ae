# Speed and accuracy of pixel to ray (paper, section 2.2 and Table 1).
add_executable(undistortion_benchmark undistortion_benchmark.cc)
target_link_libraries(
  undistortion_benchmark PRIVATE kestrel::camera opencv_calib3d benchmark::benchmark_main)

add_executable(undistortion_accuracy undistortion_accuracy.cc)
target_link_libraries(undistortion_accuracy PRIVATE kestrel::camera opencv_calib3d fmt::fmt)
