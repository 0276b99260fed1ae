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
constexpr Duration kPatience = std::chrono::seconds(1);

}  // namespace

FlightMcap::FlightMcap(const std::string& path, bool replace, const CameraIntrinsics& camera,
                       std::variant<LandingView, HuntView> view, Tell tell)
    : FlightWriter(kSeenFrames),
      file_(path, replace, camera, std::move(view)),
      tell_(std::move(tell)),
      thread_([this] { Run(); }) {}

FlightMcap::~FlightMcap() {
  is_over_ = true;
  EndFrames();
  thread_.join();
}

void FlightMcap::Run() {
  SetUpThisThread("mcap", {});
  try {
    WriteAll();
  } catch (const InputError& error) {
    tell_(fmt::format("{}: the flight goes on without it", error.what()));
    EndFrames();  // the frames that wait go with it
    return;
  }
  if (dropped_frames() > 0) {
    tell_(fmt::format("--mcap: {} frames are left out: the disk is too slow", dropped_frames()));
  }
}

void FlightMcap::WriteAll() {
  for (;;) {
    const bool was_over = is_over_;
    if (WriteNext(&file_.writer(), kPatience)) continue;
    if (was_over) return file_.Close();
    file_.Flush();
  }
}

}  // namespace kestrel
