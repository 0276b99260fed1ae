// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/foxglove/flight_writer.h"

namespace kestrel {
namespace {

constexpr std::size_t kSaid = 256;

}  // namespace

FlightWriter::FlightWriter(std::size_t capacity) : seen_(capacity), said_(kSaid) {}

void FlightWriter::See(const Frame& frame, const LandingObservation& observation) {
  if (IsWanted()) seen_.Push({frame, Now() - frame.time, observation});
}

void FlightWriter::See(const Frame& frame, const HuntObservation& observation) {
  if (IsWanted()) seen_.Push({frame, Now() - frame.time, observation});
}

bool FlightWriter::WriteNext(ObservationWriter* writer, Duration patience) {
  const auto seen = seen_.Pop(patience);
  while (const auto said = said_.TryPop()) writer->WriteLog(said->time, said->level, said->text);
  if (!seen) return false;
  std::visit(
      [&](const auto& observation) { writer->Write(seen->frame, observation, seen->latency); },
      seen->observation);
  return true;
}

}  // namespace kestrel
