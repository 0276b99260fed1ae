// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "kestrel/simulation/autopilots/test_pointed_flight.h"

namespace kestrel {

// What a flight without a position is like.
struct NoPositionSetup {
  AutopilotFirmware firmware = AutopilotFirmware::kArduPilot;
  RelativeJob job;
  double altitude_m = 3;
  double wind_mps = 3;
  double gusts = 0.25;  // spread, as a part of the wind
  double pad_mps = 0;   // straight on
  // The pad drives off 'after' seconds, so fast at most and with this acceleration; 0: see above.
  double drive_after_s = 0, drive_acceleration = 1;
  double hover_thrust_error = 0;
  double vibration = 0.3;    // of the accelerometer, m/s^2
  double battery_sag = 0;    // part of the thrust, in a minute
  double turn_after_s = -1;  // of the compass, by 40 degrees
  bool has_sticks = false;
  bool has_flow = false;
  double silent_after_s = -1;      // no attitude comes any more, but heartbeats
  double gnss_lost_after_s = -1;   // in a landing by position; negative: see below
  double gnss_jumps_after_s = -1;  // the same, by 5 m; both negative: there is none from the first
  const char* touchdown_heading = "any";
  double quarters_beyond_m = std::numeric_limits<double>::infinity();  // see TestEye
  std::string parameters;  // besides those that doctor demands
  std::uint64_t seed = 1;
};

constexpr double kNoPositionStart_s = 8;  // the pilot gives the mode

inline PointedFlight NoPositionFlightOf(const NoPositionSetup& setup) {
  AutopilotModelOptions options;
  const bool is_normal = setup.gnss_lost_after_s >= 0 || setup.gnss_jumps_after_s >= 0;
  options.estimate.has_gnss = is_normal;
  options.estimate.gnss_lost_after_s = setup.gnss_lost_after_s;
  options.estimate.jump_after_s = setup.gnss_jumps_after_s;
  options.estimate.has_flow = setup.has_flow;
  options.estimate.silent_after_s = setup.silent_after_s;
  options.estimate.silent_for_s = 1000;
  options.estimate.hover_thrust_error = setup.hover_thrust_error;
  options.estimate.battery_sag = setup.battery_sag;
  options.estimate.vibration = setup.vibration;
  options.estimate.turn_after_s = setup.turn_after_s;
  if (setup.firmware == AutopilotFirmware::kPx4) {
    options.parameters =
        is_normal ? "COM_OBL_RC_ACT=5,LNDMC_XY_VEL_MAX=12" : "COM_OBL_RC_ACT=4,LNDMC_XY_VEL_MAX=12";
  }
  if (!setup.parameters.empty()) {
    options.parameters += (options.parameters.empty() ? "" : ",") + setup.parameters;
  }
  options.uav.wind.min_mps = options.uav.wind.max_mps = setup.wind_mps;
  options.uav.wind.gusts = setup.gusts;
  options.pilot.start_altitude_m = setup.altitude_m;
  options.pilot.offset_east_m = 0.1 * setup.altitude_m;
  options.pilot.offset_north_m = -0.06 * setup.altitude_m;
  options.pilot.land_after_s = -1;
  options.pilot.guide_after_s = kNoPositionStart_s;
  options.pilot.has_sticks = setup.has_sticks;
  VehicleWorldOptions vehicle =
      TestVehicle(setup.pad_mps > 0 ? "straight" : "standing", setup.pad_mps);
  if (setup.drive_after_s > 0) {
    vehicle.drive_altitude_m = 0.01;
    vehicle.drive_delay_s = setup.drive_after_s;
    vehicle.drive_acceleration = setup.drive_acceleration;
  }
  constexpr double kHalfView_deg = 38;
  FlightOptions flight;
  flight.guidance.touchdown_heading = setup.touchdown_heading;
  RelativeJob job = setup.job;
  job.is_reserve = is_normal;
  return {setup.firmware,
          options,
          vehicle,
          {.has_gimbal = false,
           .half_view_deg = kHalfView_deg,
           .cameras = {{.quarters_beyond_m = setup.quarters_beyond_m}},
           .guides = is_normal,
           .without_position = job,
           .flight = flight,
           .seed = setup.seed}};
}

// Distances from the pad during a hover, m.
struct HoverErrors {
  double largest = 0, within_95 = 0;  // horizontal
  double height_95 = 0;               // against 'height_m'
  double fastest_sink_mps = 0;
};

inline HoverErrors MeasureHover(PointedFlight* flight, double seconds, double height_m) {
  std::vector<double> errors, heights;
  HoverErrors result;
  for (double s = 0; s < seconds; s += TestAutopilot::kStep_s) {
    flight->Fly(TestAutopilot::kStep_s);
    errors.push_back(flight->HorizontalError());
    const PoseSample& truth = flight->model.truth();
    const double height = truth.world_from_body.translation.z() -
                          flight->world.PatternAt(flight->now).translation.z();
    heights.push_back(std::abs(height - height_m));
    result.fastest_sink_mps =
        std::max(result.fastest_sink_mps, -truth.motion->velocity_in_world.z());
  }
  std::ranges::sort(errors);
  std::ranges::sort(heights);
  result.largest = errors.back();
  result.within_95 = errors[errors.size() * 95 / 100];
  result.height_95 = heights[heights.size() * 95 / 100];
  return result;
}

}  // namespace kestrel
