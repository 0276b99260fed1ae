# Accuracy and speed of the tracker of regions, beside those of OpenCV.
find_library(KESTREL_OPENCV_TRACKING opencv_tracking)
if(KESTREL_OPENCV_TRACKING)
  add_executable(region_accuracy region_accuracy.cc)
  target_link_libraries(region_accuracy PRIVATE kestrel::region kestrel::recording CLI11::CLI11
                                                fmt::fmt opencv_tracking opencv_video)
endif()
