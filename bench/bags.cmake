# What it costs to read a bag (scripts/bag_cost), beside rosbag's library, where
# `scripts/install-deps --bench` has brought it: in C++17, which its headers are for.
add_executable(bag_read bag_read.cc)
target_link_libraries(bag_read PRIVATE kestrel::bags)
target_compile_options(bag_read PRIVATE -Wall -Wextra -Werror)

find_path(ROSBAG_INCLUDE_DIR rosbag/bag.h)
find_library(ROSBAG_STORAGE_LIBRARY rosbag_storage)
if(ROSBAG_INCLUDE_DIR AND ROSBAG_STORAGE_LIBRARY)
  add_executable(rosbag_read rosbag_read.cc)
  set_target_properties(rosbag_read PROPERTIES CXX_STANDARD 17)
  foreach(package pluginlib class_loader rcpputils rcutils ament_index_cpp)
    target_include_directories(rosbag_read SYSTEM PRIVATE ${ROSBAG_INCLUDE_DIR}/${package})
  endforeach()
  target_link_libraries(
    rosbag_read PRIVATE ${ROSBAG_STORAGE_LIBRARY} roscpp_serialization rostime cpp_common
                        console_bridge class_loader boost_filesystem boost_system)
endif()
