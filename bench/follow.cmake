# Flights beside what a person has marked.
add_executable(follow_flight_accuracy follow_flight_accuracy.cc)
target_link_libraries(follow_flight_accuracy PRIVATE kestrel::autopilots kestrel::guidance
                                                     kestrel::pipeline kestrel::tracking
                                                     CLI11::CLI11 fmt::fmt)
