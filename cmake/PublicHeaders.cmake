# The headers that a user's program includes. They are installed, with those that they include; all
# other headers are internal. A component needs only headers of its own and of those it stands on.
set(KESTREL_PUBLIC_HEADERS
    core/base/error.h
    core/base/options.h
    core/base/random.h
    core/base/time.h
    core/geometry/cone.h
    core/geometry/ellipse.h
    core/geometry/rigid_transform.h
    core/codec/image_codec.h
    core/camera/calibration.h
    core/camera/calibration_reader.h
    core/camera/camera_model.h
    core/camera/exposure_controller.h
    core/camera/paper_camera.h
    core/camera/ray_table.h
    core/poses/pose_history.h
    vision/landing/landing_pattern.h
    vision/landing/landing_pattern_detector.h
    vision/objects/object_detector.h
    vision/objects/object_model.h
    vision/tracking/target_tracker.h
    vision/mapping/map_file.h
    vision/mapping/object_fusion.h
    vision/mapping/object_map.h
    vision/pipeline/hunt_pipeline.h
    vision/pipeline/landing_pipeline.h
    calibration/lens/lens_calibration.h
    calibration/mount/flight_calibration.h
    calibration/print/pattern_print.h
    io/recording/landing_csv.h
    io/recording/landing_overlay.h
    io/recording/object_csv.h
    io/recording/object_map_files.h
    io/recording/object_overlay.h
    io/recording/open_source.h
    io/recording/track_csv.h
    io/bags/recording_sink.h
    comms/mavlink/autopilot.h
    comms/mavlink/connection.h
    comms/team/team_member.h
    flight/guidance/landing_guidance.h
    flight/session/asynchronous_sink.h
    flight/session/observation_sink.h
    flight/onboard/gstreamer_camera.h
    flight/onboard/live_session.h
    flight/onboard/realtime_replay.h
    simulation/rendering/frame_renderer.h
    simulation/recordings/landing_simulation.h
    simulation/autopilots/simulated_autopilot.h
    simulation/autopilots/simulated_camera.h
    app/console/flight_console.h
    app/foxglove/flight_live.h
    app/foxglove/mcap_sink.h
    app/evaluation/evaluate_landing.h)

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
