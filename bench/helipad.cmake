# Accuracy and speed of the detector of helipads.
add_executable(helipad_accuracy helipad_accuracy.cc)
target_link_libraries(helipad_accuracy PRIVATE kestrel::helipad CLI11::CLI11 fmt::fmt opencv_imgproc)
