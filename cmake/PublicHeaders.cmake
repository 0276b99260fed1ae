# The headers that a user's program includes. They are installed, with those that they include; all
# other headers are internal. A component needs only headers of its own and of those it stands on.
set(KESTREL_PUBLIC_HEADERS
    core/base/error.h
    core/base/options.h
    core/base/time.h
    core/geometry/rigid_transform.h
    core/camera/calibration.h
    core/camera/calibration_reader.h
    core/camera/camera_model.h
    core/camera/exposure_controller.h
    core/camera/paper_camera.h
    core/poses/pose_history.h
    vision/landing/landing_pattern.h
    vision/landing/landing_pattern_detector.h
    vision/objects/object_detection.h
    vision/objects/object_detector.h
    vision/objects/object_model.h
    vision/tracking/target_tracker.h
    vision/mapping/map_file.h
    vision/mapping/mapped_object.h
    vision/mapping/object_map.h
    vision/pipeline/hunt_pipeline.h
    vision/pipeline/landing_pipeline.h
    calibration/lens/lens_calibration.h
    calibration/mount/flight_calibration.h
    io/recording/event_source.h
    io/recording/frame.h
    io/recording/frame_source.h
    io/recording/landing_overlay.h
    io/recording/object_overlay.h
    io/recording/open_source.h
    io/bags/open_recording.h
    flight/session/asynchronous_sink.h
    flight/session/flight_end.h
    flight/session/flight_report.h
    flight/session/hunt_run.h
    flight/session/landing_run.h
    flight/session/live_source.h
    flight/session/observation.h
    flight/session/observation_sink.h
    flight/session/observation_sinks.h
    flight/session/recorded_session.h
    flight/session/vision.h
    flight/onboard/gstreamer_camera.h
    flight/onboard/live_session.h
    flight/onboard/open_live_source.h
    flight/onboard/realtime_replay.h
    simulation/recordings/recording_plan.h
    app/foxglove/mcap_sink.h)

# kestrel_included_headers(RESULT HEADER...): the headers below src/kestrel and all that they include.
function(kestrel_included_headers result)
  set(found)
  set(open ${ARGN})
  while(open)
    list(POP_FRONT open header)
    if(header IN_LIST found)
      continue()
    endif()
    list(APPEND found ${header})
    file(STRINGS ${PROJECT_SOURCE_DIR}/src/kestrel/${header} includes REGEX "^#include \"kestrel/")
    list(TRANSFORM includes REPLACE "#include \"kestrel/([^\"]*)\".*" "\\1")
    list(APPEND open ${includes})
  endwhile()
  set(${result} ${found} PARENT_SCOPE)
endfunction()
