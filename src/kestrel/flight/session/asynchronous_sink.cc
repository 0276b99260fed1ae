// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/session/asynchronous_sink.h"

#include <exception>
#include <optional>
#include <sys/resource.h>
#include <utility>

#include "kestrel/core/base/thread_setup.h"

namespace kestrel {

AsynchronousSink::AsynchronousSink(AsynchronousSinkOptions options,
                                   std::unique_ptr<SinkWriter> writer)
    : options_(std::move(options)),
      writer_(std::move(writer)),
      observations_(options_.frames),
      thread_([this] { Run(); }) {}

void AsynchronousSink::Take(const Observation& observation) {
  if (IsWanted()) observations_.Push(observation);
}

void AsynchronousSink::Finish() {
  is_over_ = true;
  observations_.Close();
  if (thread_.joinable()) thread_.join();
}

void AsynchronousSink::Run() {
  SetUpThisThread(options_.thread_name, {});
  // Linux sets the niceness of this thread alone. Without permission it stays as it is.
  if (options_.niceness > 0) setpriority(PRIO_PROCESS, 0, options_.niceness);
  try {
    WriteAll();
    writer_->Finish(observations_.dropped() + DropWaiting());
  } catch (const std::exception& error) {
    has_failed_ = true;
    if (options_.notify) options_.notify(error.what());
  }
}

void AsynchronousSink::WriteAll() {
  std::optional<Time> end;
  for (;;) {
    const bool was_over = is_over_;
    if (was_over && !end) end = Now() + options_.last_patience;
    const bool has_written = WriteWaiting();
    if (was_over && (!has_written || Now() >= *end)) return;
  }
}

// Writes one frame at most and everything else; false when there was no frame.
bool AsynchronousSink::WriteWaiting() {
  const auto observation = observations_.Pop(options_.patience);
  while (const auto event = events_.TryPop()) writer_->Write(*event);
  while (const auto report = reports_.TryPop()) writer_->Write(*report);
  while (const auto report = team_reports_.TryPop()) writer_->Write(*report);
  if (observation) writer_->Write(*observation, observations_.size());
  writer_->Rest(observation.has_value());
  return observation.has_value();
}

// Returns the number of frames.
std::size_t AsynchronousSink::DropWaiting() {
  std::size_t frames = 0;
  while (observations_.TryPop()) ++frames;
  return frames;
}

}  // namespace kestrel
