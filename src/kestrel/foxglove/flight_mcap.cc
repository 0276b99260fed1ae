// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/foxglove/flight_mcap.h"

#include <chrono>
#include <cstddef>
#include <utility>

#include <fmt/format.h>

#include "kestrel/base/error.h"
#include "kestrel/onboard/thread_setup.h"

namespace kestrel {
namespace {

constexpr std::size_t kSeenFrames = 32;  // that wait for the disk
constexpr std::size_t kSaid = 256;
constexpr Duration kPatience = std::chrono::seconds(1);

}  // namespace

FlightMcap::FlightMcap(const std::string& path, bool replace, const CameraIntrinsics& camera,
                       std::variant<LandingView, HuntView> view, Tell tell)
    : file_(path, replace, camera, std::move(view)),
      tell_(std::move(tell)),
      seen_(kSeenFrames),
      said_(kSaid),
      thread_([this] { Run(); }) {}

FlightMcap::~FlightMcap() {
  is_over_ = true;
  seen_.Close();
  thread_.join();
}

void FlightMcap::See(const Frame& frame, const LandingObservation& observation) {
  seen_.Push({frame, Now() - frame.time, observation});
}

void FlightMcap::See(const Frame& frame, const HuntObservation& observation) {
  seen_.Push({frame, Now() - frame.time, observation});
}

void FlightMcap::Run() {
  SetUpThisThread("mcap", {});
  try {
    WriteAll();
  } catch (const InputError& error) {
    tell_(fmt::format("{}: the flight goes on without it", error.what()));
    seen_.Close();  // the frames in it go with it
    return;
  }
  if (seen_.dropped() > 0) {
    tell_(fmt::format("--mcap: {} frames are left out: the disk is too slow", seen_.dropped()));
  }
}

void FlightMcap::WriteAll() {
  for (;;) {
    const bool was_over = is_over_;
    const auto seen = seen_.Pop(kPatience);
    while (const auto said = said_.TryPop()) file_.WriteLog(said->time, said->level, said->text);
    if (seen) {
      std::visit(
          [&](const auto& observation) { file_.Write(seen->frame, observation, seen->latency); },
          seen->observation);
    } else if (was_over) {
      return file_.Close();
    } else {
      file_.Flush();
    }
  }
}

}  // namespace kestrel
