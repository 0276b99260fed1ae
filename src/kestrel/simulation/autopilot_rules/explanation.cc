// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/simulation/autopilot_rules/explanation.h"

#include <array>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <string_view>
#include <type_traits>

#include <Eigen/Geometry>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "kestrel/comms/mavlink/ned.h"
#include "kestrel/core/geometry/angles.h"
#include "kestrel/simulation/autopilot_rules/ardupilot_target.h"
#include "kestrel/simulation/autopilot_rules/autopilot_parameters.h"
#include "kestrel/simulation/autopilot_rules/px4_target.h"
#include "kestrel/simulation/autopilot_rules/px4_time_sync.h"

namespace kestrel {
namespace {

using Eigen::Vector3d;

constexpr std::array kProfiles = {LinkProfile::kArduPilot, LinkProfile::kPx4, LinkProfile::kPx4Vte};
constexpr std::int64_t kBoot_us = 100'000'000;  // the autopilot's own clock at the beginning
constexpr Duration kStep = std::chrono::milliseconds(4);
constexpr Duration kSendTime = std::chrono::seconds(4);
constexpr int kStepsPerMessage = 12;  // 20 messages per second

RigidTransform BodyOf(const ExplainedScene& scene) {
  const Eigen::Quaterniond ned_from_frd(
      Eigen::AngleAxisd(Radians(scene.heading_deg), Vector3d::UnitZ()));
  return {EnuFluFromNedFrd(ned_from_frd), EnuFromNed(scene.uav_in_ned)};
}

TargetState ReportOf(const ExplainedScene& scene) {
  constexpr double kSigma_m = 0.03;
  TargetState report;
  report.world_from_body = BodyOf(scene);
  report.position_in_world = report.world_from_body * FluFromFrd(scene.pattern_in_body);
  report.covariance = kSigma_m * kSigma_m * Eigen::Matrix3d::Identity();
  report.size_m = scene.size_m;
  return report;
}

// Returns the autopilot's state while it hovers in the scene.
FlightState HoverOf(const ExplainedScene& scene, int step) {
  constexpr std::int64_t kNsPerUs = 1000;
  FlightState state;
  const Duration since = step * kStep;
  state.time = Time(std::chrono::seconds(1)) + since;
  state.boot_us = kBoot_us + since.count() / kNsPerUs;
  state.step_s = ToSeconds(kStep);
  state.pose = {state.time, BodyOf(scene), BodyMotion{}};
  return state;
}

// Runs 'target' on the scene for a while. 'notify' is called 20 times a second to send messages.
template <class Target, class Notify>
void SendFor(const ExplainedScene& scene, Target* target, const Notify& notify) {
  for (int step = 0; step * kStep < kSendTime; ++step) {
    const FlightState state = HoverOf(scene, step);
    if (step % kStepsPerMessage == 0) notify(state);
    target->Estimate(state);
  }
}

Announce KeepLast(std::string* text) {
  return [text](Severity /*severity*/, const std::string& reported) { *text = reported; };
}

void ObserveArduPilot(const ExplainedScene& scene, LinkProfile profile,
                      Understanding* understanding) {
  // ArduPilot does not use TARGET_RELATIVE.
  if (profile == LinkProfile::kPx4Vte) return;
  const AutopilotParameters parameters(AutopilotFirmware::kArduPilot);
  ArduPilotTarget target(parameters, KeepLast(&understanding->ardupilot_text));
  const TargetState report = ReportOf(scene);
  SendFor(scene, &target, [&](const FlightState& state) {
    const auto stamp_us = static_cast<std::uint64_t>(state.boot_us);
    target.Handle(profile == LinkProfile::kArduPilot ? LandingTargetForArduPilot(report, stamp_us)
                                                     : LandingTargetForPx4(report, stamp_us),
                  state);
  });
  if (!target.is_acquired()) return;
  const Vector3d from_body(target.position().x(), target.position().y(), -target.depth());
  understanding->ardupilot_in_ned = NedFromEnu(report.world_from_body.translation + from_body);
}

void ObservePx4(const ExplainedScene& scene, LinkProfile profile, Understanding* understanding) {
  AutopilotParameters parameters(AutopilotFirmware::kPx4);
  const bool is_vte = profile == LinkProfile::kPx4Vte;
  if (const auto estimator = parameters.Find("VTE_EN")) parameters.Set(*estimator, is_vte ? 1 : 0);
  const Px4TimeSync clock;
  Px4Target target(parameters, clock, KeepLast(&understanding->px4_text));
  const TargetState report = ReportOf(scene);
  SendFor(scene, &target, [&](const FlightState& state) {
    const auto stamp_us = static_cast<std::uint64_t>(state.boot_us);
    if (is_vte) {
      target.Handle(TargetRelativeForPx4(report, stamp_us), state);
    } else {
      target.Handle(profile == LinkProfile::kArduPilot ? LandingTargetForArduPilot(report, stamp_us)
                                                       : LandingTargetForPx4(report, stamp_us),
                    state);
    }
  });
  if (target.place()) understanding->px4_in_ned = NedFromEnu(target.place()->in_world);
}

// --- In words ---

// Writes every field of a message, one per line.
class FieldLines {
 public:
  template <class Value>
  void operator()(std::string_view name, const Value& value, std::string_view unit) {
    text_ += fmt::format("    {:14} {}{}{}\n", name, InWords(value), unit.empty() ? "" : " ", unit);
  }
  void Extensions() {}
  const std::string& text() const { return text_; }

 private:
  template <class Value>
  static std::string InWords(const Value& value) {
    if constexpr (std::is_floating_point_v<Value>) {
      return fmt::format("{:.4f}", value);
    } else if constexpr (std::is_integral_v<Value>) {
      return fmt::format("{}", +value);
    } else if constexpr (std::is_floating_point_v<typename Value::value_type>) {
      return fmt::format("({:.4f})", fmt::join(value, ", "));
    } else {
      return fmt::format("({})", fmt::join(value, ", "));
    }
  }

  std::string text_;
};

template <class Message>
std::string Fields(const Message& message) {
  FieldLines lines;
  Message::Visit(message, lines);
  return fmt::format("  {} ({})\n{}", Message::kName, Message::kId, lines.text());
}

std::string MessageOf(const ExplainedScene& scene, LinkProfile profile) {
  const TargetState report = ReportOf(scene);
  const auto stamp_us = static_cast<std::uint64_t>(kBoot_us);
  switch (profile) {
    case LinkProfile::kArduPilot:
      return Fields(LandingTargetForArduPilot(report, stamp_us));
    case LinkProfile::kPx4:
      return Fields(LandingTargetForPx4(report, stamp_us));
    case LinkProfile::kPx4Vte:
      return Fields(TargetRelativeForPx4(report, stamp_us));
  }
  return "";
}

std::string PlaceInWords(const ExplainedScene& scene, const Vector3d& in_ned) {
  const Vector3d body = FrdFromFlu(BodyOf(scene).Inverse() * EnuFromNed(in_ned));
  return fmt::format(
      "{:.2f} north, {:.2f} east, {:.2f} down, which is {:.2f} m ahead, {:.2f} right, {:.2f} below",
      in_ned.x(), in_ned.y(), in_ned.z() + 0.0, body.x(), body.y(), body.z());
}

std::string ThoughtOf(const ExplainedScene& scene, const char* who,
                      const std::optional<Vector3d>& in_ned, const std::string& text) {
  const std::string reported = text.empty() ? "" : fmt::format(" (\"{}\")", text);
  if (!in_ned) return fmt::format("  {} ignores it{}\n", who, reported);
  return fmt::format("  {} thinks: {}{}\n", who, PlaceInWords(scene, *in_ned), reported);
}

}  // namespace

Understanding UnderstandingOf(const ExplainedScene& scene, LinkProfile profile) {
  Understanding understanding;
  ObserveArduPilot(scene, profile, &understanding);
  ObservePx4(scene, profile, &understanding);
  return understanding;
}

std::string Explain(const ExplainedScene& scene) {
  const TargetState report = ReportOf(scene);
  std::string text = fmt::format(
      "A pattern {:g} m ahead, {:g} m right, {:g} m below a UAV that is {:g} m north, {:g} m east, "
      "{:g} m up\nof its origin, level, its nose {:g} deg clockwise from north. The pattern is "
      "{}.\n",
      scene.pattern_in_body.x(), scene.pattern_in_body.y(), scene.pattern_in_body.z(),
      scene.uav_in_ned.x(), scene.uav_in_ned.y(), -scene.uav_in_ned.z(), scene.heading_deg,
      PlaceInWords(scene, NedFromEnu(report.position_in_world)));
  for (const LinkProfile profile : kProfiles) {
    const Understanding understanding = UnderstandingOf(scene, profile);
    text += fmt::format("\n--profile {}\n", ToString(profile)) + MessageOf(scene, profile) +
            ThoughtOf(scene, "ArduPilot", understanding.ardupilot_in_ned,
                      understanding.ardupilot_text) +
            ThoughtOf(scene, profile == LinkProfile::kPx4Vte ? "PX4 (VTE_EN 1)" : "PX4 (VTE_EN 0)",
                      understanding.px4_in_ned, understanding.px4_text);
  }
  return text;
}

}  // namespace kestrel
