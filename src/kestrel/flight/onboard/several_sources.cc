// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/onboard/several_sources.h"

#include <algorithm>
#include <chrono>
#include <utility>
#include <variant>

#include <fmt/format.h>

#include "kestrel/core/base/thread_setup.h"

namespace kestrel {
namespace {

constexpr Duration kReadPatience = std::chrono::milliseconds(100);
constexpr std::size_t kEventsOfCamera = 16;  // that wait for the reader, who does not wait itself

}  // namespace

SeveralSources::SeveralSources(std::vector<Camera> cameras)
    : cameras_(std::move(cameras)),
      have_ended_(cameras_.size()),
      events_(cameras_.size() * kEventsOfCamera) {
  for (std::size_t i = 0; i < cameras_.size(); ++i) {
    threads_.emplace_back([this, i] { Read(i); });
  }
}

SeveralSources::~SeveralSources() {
  is_over_ = true;
  for (std::thread& thread : threads_) thread.join();
}

void SeveralSources::Read(std::size_t camera) {
  SetUpThisThread("camera", {});
  while (!is_over_) {
    std::optional<Event> event = cameras_[camera].source->Next(kReadPatience);
    if (!event) continue;
    if (std::holds_alternative<EndOfStream>(*event)) {
      have_ended_[camera] = true;
      return;
    }
    if (auto* frame = std::get_if<Frame>(&*event)) frame->camera = camera;
    events_.Push(std::move(*event));
  }
}

std::optional<Event> SeveralSources::Next(Duration timeout) {
  if (auto event = events_.Pop(timeout)) return event;
  const bool is_end =
      std::all_of(have_ended_.begin(), have_ended_.end(),
                  [](const std::atomic<bool>& has_ended) { return has_ended.load(); });
  if (!is_end) return std::nullopt;
  if (auto last = events_.TryPop()) return last;
  return Event(EndOfStream{});
}

std::string SeveralSources::error() const {
  std::string all;
  for (std::size_t i = 0; i < cameras_.size(); ++i) {
    std::string error = cameras_[i].source->error();
    if (error.empty() && have_ended_[i]) error = "has ended";
    if (error.empty()) continue;
    all += fmt::format("{}{}: {}", all.empty() ? "" : "; ", cameras_[i].name, error);
  }
  return all;
}

CaptureCounters SeveralSources::counters() const {
  CaptureCounters sum;
  for (const Camera& camera : cameras_) {
    const CaptureCounters own = camera.source->counters();
    sum.captured += own.captured;
    sum.missed += own.missed;
    sum.refused += own.refused;
    sum.untimed += own.untimed;
    sum.reopened += own.reopened;
  }
  return sum;
}

}  // namespace kestrel
