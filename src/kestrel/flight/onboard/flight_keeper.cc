// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/onboard/flight_keeper.h"

#include <chrono>
#include <string_view>
#include <system_error>

#include <fmt/chrono.h>
#include <fmt/format.h>

#include "kestrel/core/base/error.h"
#include "kestrel/core/codec/image_codec.h"

namespace kestrel {
namespace {

namespace fs = std::filesystem;

// Returns 'name', or 'name' with the first number for which nothing exists yet.
fs::path FreeName(const fs::path& folder, const std::string& name, const std::string& ending) {
  fs::path path = folder / (name + ending);
  for (int i = 2; fs::exists(path); ++i) path = folder / fmt::format("{}-{}{}", name, i, ending);
  return path;
}

}  // namespace

fs::path PathOfNow(const fs::path& folder, const std::string& prefix) {
  const auto now =
      std::chrono::time_point_cast<std::chrono::seconds>(std::chrono::system_clock::now());
  return FreeName(folder, fmt::format("{}{:%Y-%m-%d_%H-%M-%S}", prefix, fmt::gmtime(now)), "");
}

void FlightKeeper::MakeFolder() const {
  std::error_code error;
  fs::create_directories(folder_, error);
  if (error) throw InputError(folder_.string() + ": cannot be made: " + error.message());
}

std::string FlightKeeper::StartRecording() {
  if (recording_->Get()) return "a recording is on already";
  MakeFolder();
  const fs::path path = PathOfNow(folder_);
  if (!recording_->Start(path, /*replace=*/false)) return "the flight ends: no recording begins";
  return "recording into " + path.string();
}

std::string FlightKeeper::StopRecording() {
  return recording_->Stop() ? "the recording is written" : "no recording is on";
}

std::string FlightKeeper::KeepSnapshot(const cv::Mat& image, Time captured) {
  MakeFolder();
  const fs::path path =
      FreeName(folder_, fmt::format("snapshot_{}", ToNanoseconds(captured)), ".png");
  WriteImage(path.string(), image);
  return "snapshot kept as " + path.string();
}

}  // namespace kestrel
