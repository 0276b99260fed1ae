// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/simulation/autopilots/autopilot_model.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "kestrel/core/base/error.h"
#include "kestrel/core/base/options.h"
#include "kestrel/core/base/parse_number.h"
#include "kestrel/core/geometry/angles.h"
#include "kestrel/core/poses/gravity.h"
#include "kestrel/simulation/autopilots/ardupilot_guided.h"
#include "kestrel/simulation/autopilots/ardupilot_guided_no_gps.h"
#include "kestrel/simulation/autopilots/ardupilot_landing.h"
#include "kestrel/simulation/autopilots/px4_landing.h"
#include "kestrel/simulation/autopilots/px4_offboard.h"

namespace kestrel {
namespace {

using Eigen::Vector3d;

constexpr Duration kModelStep = std::chrono::milliseconds(4);
constexpr Duration kBootTime = std::chrono::seconds(3);  // silent after a reboot

// Parses "NAME=value,NAME=value".
void SetParameters(const std::string& list, AutopilotParameters* parameters) {
  for (std::size_t begin = 0; begin < list.size();) {
    const std::size_t end = std::min(list.find(',', begin), list.size());
    const std::string setting = list.substr(begin, end - begin);
    const std::size_t equals = setting.find('=');
    const auto index = parameters->Find(setting.substr(0, equals));
    const auto value = equals == std::string::npos
                           ? std::nullopt
                           : ParseNumber<double>(setting.substr(equals + 1));
    if (!index || !value) {
      throw InputError(fmt::format(
          "parameters has '{}', expected NAME=value of a parameter of this autopilot", setting));
    }
    parameters->Set(*index, *value);
    begin = end + 1;
  }
}

AutopilotParameters ParametersOf(AutopilotFirmware firmware, const AutopilotModelOptions& options) {
  AutopilotParameters parameters(firmware);
  if (options.has_gimbal) {
    SetParameters(
        firmware == AutopilotFirmware::kPx4
            ? "MNT_MODE_IN=4,MNT_MODE_OUT=2"
            : fmt::format("MNT1_TYPE=6,MNT1_PITCH_MIN={},MNT1_PITCH_MAX={},RC7_OPTION=213",
                          options.gimbal.pitch_min_deg, options.gimbal.pitch_max_deg),
        &parameters);
  }
  SetParameters(options.parameters, &parameters);
  return parameters;
}

// The autopilot keeps its own tilt limit, whatever the UAV could do.
SimulatedUavOptions WithTiltOf(AutopilotFirmware firmware, const AutopilotParameters& parameters,
                               SimulatedUavOptions uav) {
  const double tilt_deg =
      parameters[firmware == AutopilotFirmware::kPx4 ? "MPC_TILTMAX_AIR" : "ATC_ANGLE_MAX"];
  uav.multicopter.max_tilt_deg = std::min(uav.multicopter.max_tilt_deg, tilt_deg);
  return uav;
}

SimulatedUav MakeUav(const SimulatedUavOptions& options, const PilotOptions& pilot,
                     const VehicleWorld& world, Time start, Random* random) {
  const double heading = Radians(90 - pilot.heading_deg);
  if (pilot.start_altitude_m <= 0) {
    return {options, world, start, Vector3d::Zero(), Vector3d::Zero(), heading, random};
  }
  const Vector3d place = SimulatedPilot(pilot, world, start).PlaceAt(start);
  const Vector3d velocity =
      pilot.follows_vehicle ? world.VelocityAt(start) : Vector3d(Vector3d::Zero());
  return {options, world, start, place, velocity, heading, random};
}

}  // namespace

AutopilotModel::AutopilotModel(AutopilotFirmware firmware, const AutopilotModelOptions& options,
                               VehicleWorld* world, Time start, std::uint64_t seed, Send send)
    : firmware_(firmware),
      options_(Checked(options)),
      world_(*world),
      send_(std::move(send)),
      random_(seed),
      shakes_(~seed),
      parameters_(ParametersOf(firmware, options)),
      uav_(MakeUav(WithTiltOf(firmware, parameters_, options.uav), options.pilot, *world, start,
                   &random_)),
      navigation_(options.navigation, NavigationErrors(), Random(random_.Bits())),
      pilot_(options.pilot, *world, start),
      detector_(firmware, parameters_),
      return_(firmware, parameters_),
      streams_(firmware, options.has_gimbal, options.zoom.is_there(),
               options.estimate.has_range_finder),
      attitude_error_(options.estimate.tilt_memory_s),
      start_(start),
      stepped_to_(start),
      booted_at_(start),
      boot_uptime_s_(options.uptime_s) {
  const Announce announce = [this](Severity severity, const std::string& text) {
    SendText(severity, text);
  };
  if (is_px4()) {
    landing_ = std::make_unique<Px4Landing>(parameters_, px4_clock_, announce);
    guided_ = std::make_unique<Px4Offboard>(parameters_, options.estimate.hover_thrust_error,
                                            options.estimate.battery_sag / 60, announce);
    custom_mode_ = CustomModeOf(kind(), FlightMode::kHold);
  } else {
    landing_ = std::make_unique<ArduPilotLanding>(parameters_, announce);
    guided_ = std::make_unique<ArduPilotGuided>(parameters_);
    guided_by_lean_ = std::make_unique<ArduPilotGuidedNoGps>(parameters_);
    custom_mode_ = CustomModeOf(kind(), FlightMode::kPilot);
  }
  pilot_flies_ = options.pilot.start_altitude_m > 0;
  is_armed_ = pilot_flies_;
  has_origin_ = options.estimate.has_gnss;
  if (!options.estimate.has_gnss) external_.emplace(firmware, parameters_);
  ObserveFlight(start);
  hold_ = state_.position();
  if (options.has_gimbal) {
    mount_.emplace(firmware, options.gimbal, static_cast<std::uint8_t>(options.system_id), start,
                   Random(random_.Bits()));
  }
}

std::int64_t AutopilotModel::OwnTime(Time now) const {
  const double rate = 1 + 1e-6 * options_.drift_ppm;
  const auto since_boot = static_cast<double>((now - booted_at_).count());
  return std::llround(1e9 * boot_uptime_s_) + std::llround(rate * since_boot) + clock_jump_.count();
}

bool AutopilotModel::IsSilentAfterReboot(Time now) const {
  return now - booted_at_ < kBootTime && booted_at_ != start_;
}

bool AutopilotModel::IsWithin(Time now, double after_s, double for_s) const {
  const double since_s = ToSeconds(now - start_);
  return after_s >= 0 && since_s >= after_s && since_s < after_s + for_s;
}

bool AutopilotModel::HasPosition(Time now) const {
  if (external_) return external_->has_position() || options_.estimate.has_flow;
  return !IsWithin(now, options_.estimate.lost_after_s, std::numeric_limits<double>::infinity());
}

void AutopilotModel::Step(Time now) {
  while (stepped_to_ + kModelStep <= now) {
    stepped_to_ += kModelStep;
    StepOnce(stepped_to_);
  }
}

void AutopilotModel::StepOnce(Time now) {
  const FlightCommand command = Fly();
  uav_.Step(now, command, is_armed_);
  if (mount_) mount_->Step(now, uav_.pose().world_from_body);
  world_.ReportPose(uav_.pose(),
                    mount_ ? std::optional(mount_->world_from_platform()) : std::nullopt);
  ObserveFlight(now);
  MeasureAcceleration();
  landing_->Estimate(state_);
  detector_.Observe(state_, command);
  if (IsGuided()) result_.guided_s += state_.step_s;
  FollowPilot(now);
  WatchSetPoints(now);
  ObserveContact(now);
  const bool has_space = world_.options().room.HasSpaceAt(uav_.pose().world_from_body.translation);
  result_.has_left_room = result_.has_left_room || !has_space;
  DisarmAfterLanding(now);
  if (IsSilentAfterReboot(now)) return;
  streams_.SendDue(OwnMicroseconds(now), [&](std::uint32_t id) { SendMessage(id, now); });
}

void AutopilotModel::ObserveFlight(Time now) {
  const PoseSample& truth = uav_.pose();
  const EstimateFaultOptions& faults = options_.estimate;
  const bool jumps = IsWithin(now, faults.jump_after_s, std::numeric_limits<double>::infinity());
  state_.step_s = ToSeconds(now - state_.time);
  state_.time = now;
  state_.boot_us = OwnMicroseconds(now);
  state_.pose = navigation_.Report(world_.SceneTime(truth.time), truth.world_from_body);
  state_.pose.time = now;
  state_.pose.motion = truth.motion;
  if (jumps) state_.pose.world_from_body.translation.x() += faults.jump_m;
  // It knows when its estimate was reset: the held place moves along.
  if (jumps && !std::exchange(has_jumped_, true)) hold_.x() += faults.jump_m;
  if (!external_ &&
      IsWithin(now, faults.gnss_lost_after_s, std::numeric_limits<double>::infinity())) {
    external_.emplace(firmware_, parameters_).BeginKnown(state_.boot_us);
  }
  if (external_) {
    UseExternalNavigation();
    MistakeAttitude(now);
  }
  state_.is_standing = uav_.is_standing();
  DriftAtRest();
}

// The mean over some steps, as autopilots filter it.
void AutopilotModel::MeasureAcceleration() {
  constexpr double kFilter_s = 0.02;
  const PoseSample& truth = uav_.pose();
  const Vector3d velocity = truth.motion->velocity_in_world;
  const Vector3d change = (velocity - std::exchange(velocity_, velocity)) / state_.step_s;
  const Vector3d measured =
      truth.world_from_body.rotation.conjugate() * (change + kGravity * Vector3d::UnitZ());
  acceleration_ += std::min(state_.step_s / kFilter_s, 1.0) * (measured - acceleration_);
}

// The place that it holds moves along with a jump.
void AutopilotModel::UseExternalNavigation() {
  Vector3d& place = state_.pose.world_from_body.translation;
  external_->Observe(state_.boot_us, state_.step_s, place);
  hold_ += external_->TakeJump();
  place += external_->error();
}

void AutopilotModel::MistakeAttitude(Time now) {
  constexpr double kTurning_s = 2;
  const EstimateFaultOptions& faults = options_.estimate;
  const Vector3d velocity = uav_.pose().motion->velocity_in_world;
  if (state_.step_s > 0 && state_.step_s < 1) {
    attitude_error_.Step(state_.step_s, (velocity - velocity_) / state_.step_s, !LacksPosition());
  }
  if (faults.turn_after_s >= 0) {
    const double since_s = ToSeconds(now - start_) - faults.turn_after_s;
    attitude_error_.set_turn(Radians(faults.turn_deg) * std::clamp(since_s / kTurning_s, 0.0, 1.0));
  }
  Eigen::Quaterniond& rotation = state_.pose.world_from_body.rotation;
  rotation = attitude_error_.Estimate(rotation);
}

// Its vertical speed is wrong while it stands, and its height with it.
void AutopilotModel::DriftAtRest() {
  const bool drifts = state_.is_standing && is_armed_;
  const double error_mps = drifts ? options_.estimate.rest_climb_mps : 0;
  rest_drift_m_ = drifts ? rest_drift_m_ + state_.step_s * error_mps : 0;
  state_.pose.motion->velocity_in_world.z() += error_mps;
  state_.pose.world_from_body.translation.z() += rest_drift_m_;
}

void AutopilotModel::FollowPilot(Time now) {
  if (pilot_.LosesBattery(now)) EnterBatteryFailsafe(now);
  auto mode = pilot_.Switch(now, pilot_flies_);
  // Without a position there is another switch position for set-points.
  const bool has_place = !external_ || external_->has_position();
  if (mode == FlightMode::kGuided && !has_place) mode = FlightMode::kGuidedByLean;
  if (mode) EnterMode(*mode, Wish::kPilot, now);
}

// It returns unless its battery parameters choose a landing; other actions are not modelled.
void AutopilotModel::EnterBatteryFailsafe(Time now) {
  constexpr int kArduPilotLands = 1;
  constexpr int kPx4Lands = 2;
  const bool lands = is_px4() ? parameters_["COM_LOW_BAT_ACT"] == kPx4Lands
                              : parameters_["BATT_FS_LOW_ACT"] == kArduPilotLands;
  is_in_failsafe_ = true;
  SendText(Severity::kCritical, is_px4() ? "Critical battery" : "Battery 1 low: failsafe");
  // Like the pilot's, this mode is not left for set-points.
  EnterMode(lands ? FlightMode::kLand : FlightMode::kReturn, Wish::kPilot, now);
}

// Handles set-points that stop, and that come again after its own failsafe; and a lost position.
void AutopilotModel::WatchSetPoints(Time now) {
  if (!is_armed_) return;
  if (LacksPosition() && !pilot_flies_ && NeedsPosition(custom_mode_)) {
    SendText(Severity::kCritical, "Failsafe activated: no position");
    return EnterMode(FlightMode::kLand, Wish::kFailsafe, now);
  }
  if (IsGuided()) {
    if (const auto action = Guided().LossAction(state_)) {
      SendText(Severity::kCritical, "Failsafe activated: no offboard signal");
      EnterMode(*action, Wish::kFailsafe, now);
    }
  } else if (resumes_guided_ && guided_->IsAvailable(state_)) {
    EnterMode(FlightMode::kGuided, Wish::kResumption, now);
  }
}

FlightCommand AutopilotModel::Fly() {
  if (LacksPosition() && !pilot_flies_) {
    const bool is_by_lean = IsGuided() && !Guided().NeedsPosition();
    FlightCommand command = is_by_lean ? Guided().Fly(state_) : FlyLevel();
    attitude_error_.Apply(&command);
    return command;
  }
  FlightCommand command;
  if (LandsByTarget()) {
    command.set_point = landing_->Land(state_);
  } else if (IsGuided() && !is_taking_off_) {
    command = Guided().Fly(state_);
    // ArduPilot does not lift off by velocities.
    double& climb = command.set_point.velocity.z();
    if (!is_px4() && detector_.has_landed()) climb = std::min(climb, 0.0);
  } else if (IsIn(FlightMode::kReturn)) {
    command.set_point = return_.Fly(state_);
  } else if (pilot_flies_ && pilot_.follows_vehicle()) {
    command.set_point = pilot_.FollowVehicle(state_.time, truth().world_from_body.translation);
  } else {
    constexpr double kAtRest_mps = 0.02;
    const bool stops = IsIn(FlightMode::kHold) && stopping_.velocity().norm() > kAtRest_mps;
    command.set_point = stops ? Stop() : Hold();
  }
  return command;
}

// ArduPilot's BRAKE and PX4's Hold come to rest, and hold the place that they have reached.
SetPoint AutopilotModel::Stop() {
  constexpr StoppingLimits kPx4{.acceleration = 3, .horizontal_jerk = 4, .vertical_jerk = 4};
  constexpr double kBrakeAcceleration = 7.5;
  const StoppingLimits limits = is_px4()
                                    ? kPx4
                                    : StoppingLimits{kBrakeAcceleration, parameters_["PSC_JERK_NE"],
                                                     parameters_["PSC_JERK_D"]};
  stopping_.Step(limits, state_.step_s);
  hold_ = stopping_.position();
  SetPoint command = Hold();
  command.velocity += stopping_.velocity();
  return command;
}

SetPoint AutopilotModel::Hold() const {
  constexpr double kMax_mps = 5;
  const Vector3d way = hold_ - state_.position();
  SetPoint command;
  command.velocity.head<2>() = BrakingVelocity(way.head<2>(), 1, 2.5, kMax_mps);
  command.velocity.z() = std::clamp(way.z(), -1.5, 2.5);
  // PX4's plain LAND descends vertically.
  if (is_px4() && IsIn(FlightMode::kLand)) command.velocity.z() = -parameters_["MPC_LAND_SPEED"];
  return command;
}

// Drifts with the wind.
FlightCommand AutopilotModel::FlyLevel() const {
  constexpr double kGain = 2;  // as an acceleration per velocity error
  double climb_mps = 0;
  if (IsIn(FlightMode::kLand))
    climb_mps = -parameters_[is_px4() ? "MPC_LAND_SPEED" : "LAND_SPD_MS"];
  FlightCommand command;
  command.is_thrust = true;
  command.set_point.velocity << state_.velocity().head<2>(), climb_mps;
  command.set_point.acceleration.z() = kGain * (climb_mps - state_.velocity().z());
  return command;
}

// All but those that the sticks fly, and LAND.
bool AutopilotModel::NeedsPosition(std::uint32_t custom_mode) const {
  constexpr std::array kArduPilotModes = {0U, 1U, 2U, 9U, 20U};
  constexpr std::array kPx4Modes = {Px4CustomMode(1, 0), Px4CustomMode(2, 0), Px4CustomMode(4, 6),
                                    Px4CustomMode(5, 0), Px4CustomMode(7, 0)};
  if (is_px4() && custom_mode == CustomModeOf(kind(), FlightMode::kGuided)) {
    return guided_->NeedsPosition();
  }
  const auto is_one = [&](const auto& modes) { return std::ranges::count(modes, custom_mode) > 0; };
  return is_px4() ? !is_one(kPx4Modes) : !is_one(kArduPilotModes);
}

// False when it refuses the mode.
bool AutopilotModel::EnterMode(std::uint32_t custom_mode, Wish wish, Time now) {
  const bool is_guided = custom_mode == CustomModeOf(kind(), FlightMode::kGuided) ||
                         custom_mode == CustomModeOf(kind(), FlightMode::kGuidedByLean);
  if (is_guided && !guided_->IsAvailable(state_)) return false;
  if (LacksPosition() && NeedsPosition(custom_mode)) {
    if (wish != Wish::kFailsafe) return false;
    custom_mode = CustomModeOf(kind(), FlightMode::kLand);
  }
  if (wish == Wish::kLink) ++result_.modes_by_link;
  pilot_flies_ = false;
  resumes_guided_ = wish == Wish::kFailsafe;
  is_in_failsafe_ = pilot_.has_low_battery() || wish == Wish::kFailsafe;
  if (custom_mode == custom_mode_) return true;
  LeaveMode(now);
  custom_mode_ = custom_mode;
  hold_ = state_.position();
  stopping_.Start(state_);
  if (MayComeDown() && !landing_since_) {
    landing_since_ = now;
    result_.contact.reset();
    result_.is_disarmed = false;
  }
  if (LandsByTarget()) landing_->StartLanding(state_);
  if (IsIn(FlightMode::kReturn)) return_.Start(state_);
  if (is_guided) {
    Guided().Start(state_);
    ++result_.guided_entries;
  }
  // ArduPilot reports it at once, PX4 with the next heartbeat.
  if (!is_px4() && !IsSilentAfterReboot(now)) send_(HeartbeatOf());
  return true;
}

void AutopilotModel::LeaveMode(Time now) {
  is_taking_off_ = false;
  if (IsGuided()) {
    result_.left = now;
    result_.set_points_after_take_back = 0;
    result_.last_set_point_after_s = 0;
  }
  // A descent by the pilot's hand is not a landing.
  if (!result_.contact && !MayComeDown()) landing_since_.reset();
}

bool AutopilotModel::MayComeDown() const {
  return LandsByTarget() || IsGuided() || IsIn(FlightMode::kLand);
}

// The last contact counts: it may have gone around after an earlier one.
void AutopilotModel::ObserveContact(Time now) {
  if (!MayComeDown() || !landing_since_ || !is_armed_ || !uav_.is_standing()) return;
  const auto& contact = uav_.contact();
  if (!contact || contact->time < *landing_since_) return;
  if (result_.contact && result_.contact->time == contact->time) return;
  result_.contact = contact;
  result_.landing_s = ToSeconds(now - *landing_since_);
}

void AutopilotModel::DisarmAfterLanding(Time now) {
  if (!is_armed_ || detector_.landed_s() < 0) return;
  const bool lands = MayComeDown() && !IsGuided();
  // ArduPilot's landing modes do not wait.
  double wait_s = parameters_[is_px4() ? "COM_DISARM_LAND" : "DISARM_DELAY"];
  if (!is_px4() && (lands || IsIn(FlightMode::kReturn))) {
    wait_s = 0;
  } else if (wait_s <= 0) {
    return;
  }
  if (detector_.landed_s() < wait_s) return;
  is_armed_ = false;
  resumes_guided_ = false;
  result_.is_disarmed = true;
  if (result_.contact) result_.disarm_s = ToSeconds(now - result_.contact->time);
  SendText(Severity::kInfo, is_px4() ? "Disarmed by landing" : "Disarming motors");
}

void AutopilotModel::Reboot(Time now) {
  booted_at_ = now;
  boot_uptime_s_ = 0;
  clock_jump_ = Duration(0);
  streams_ = MessageStreams(firmware_, options_.has_gimbal, options_.zoom.is_there());
  px4_clock_ = Px4TimeSync();
  has_gcs_ = false;
}

void AutopilotModel::JumpClock(Duration change) { clock_jump_ += change; }

}  // namespace kestrel
