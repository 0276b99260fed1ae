// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/fly/fly_session.h"

#include <optional>

namespace kestrel {

LiveSessionOptions SessionOptions(const KestrelOptions& options, const FlySource& source,
                                  const FlyAutopilot& autopilot) {
  const FlyOptions& fly = options.fly;
  LiveSessionOptions session{.flight = fly.flight,
                             .link = fly.link,
                             .autopilot = source.simulated.Asking(fly.autopilot),
                             .recorder = fly.recorder,
                             .exposure = {}};
  if (fly.control_exposure) session.exposure = fly.exposure;
  // A simulated autopilot ends with this process.
  if (autopilot.simulated) session.flight.guard.enabled = false;
  return session;
}

LiveSessionParts SessionParts(FlySource* source, const FlyAutopilot& autopilot) {
  LiveSessionParts parts;
  parts.source = source->live.source.get();
  parts.calibration = source->live.calibration;
  parts.rate_hz = source->live.rate_hz;
  parts.has_poses = source->live.has_poses;
  parts.camera = source->live.actuator;
  parts.autopilot = autopilot.url;
  SimulatedSource* const simulated = &source->simulated;
  parts.pose = [simulated](const PoseSample& pose) { simulated->TakePose(pose); };
  parts.true_pose = [simulated](const PoseSample& pose) { simulated->TakeTruePose(pose); };
  parts.truth = [simulated](const Frame& frame) { return simulated->Truth(frame); };
  if (const SimulatedAutopilot* const uav = autopilot.simulated.get()) {
    parts.true_offset_m = [uav]() -> std::optional<double> {
      const SitlResult result = uav->result();
      return result.contact ? std::optional(result.offset_m()) : std::nullopt;
    };
  }
  return parts;
}

}  // namespace kestrel
