# Flights beside what a person has marked, down on an object of a map, and over a pad without a
# position.
foreach(report follow_flight_accuracy go_accuracy no_position_accuracy)
  add_executable(${report} ${report}.cc)
  target_link_libraries(${report} PRIVATE kestrel::autopilots kestrel::guidance kestrel::pipeline kestrel::team
                                          kestrel::tracking CLI11::CLI11 fmt::fmt)
endforeach()
