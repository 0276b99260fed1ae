// SPDX-License-Identifier: BSD-3-Clause
// What a team's messages cost a UAV: a map of 100 objects that it hears, a digest, and all maps
// made one, by the number of UAVs.
#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>

#include "kestrel/team/team_member.h"
#include "kestrel/team/team_view.h"

namespace kestrel {
namespace {

constexpr int kObjects = 100;

UavKey KeyOf(int uav) { return {"uav" + std::to_string(uav), 1}; }

// A hundred objects of five colours, five metres apart.
PartMessage PartOf(int uav, std::uint64_t version) {
  PartMessage part;
  part.uav = KeyOf(uav);
  part.contents.version = version;
  for (int i = 1; i <= kObjects; ++i) {
    MappedObject object;
    object.id = i;
    object.detections = 10;
    object.state.head<3>() << 5 * (i % 10), 5 * (i / 10), 0.001 * uav;
    object.covariance.diagonal().head<3>().setConstant(0.01);
    object.color_log_likelihoods[i * 7 % 5] = 5;
    part.contents.objects[i] = version;
    part.objects.push_back(object);
  }
  return part;
}

void HearAll(int uavs, std::uint64_t version, TeamMember* member) {
  for (int uav = 1; uav < uavs; ++uav) {
    member->Hear(EncodeMessage({KeyOf(uav), PartOf(uav, version)}), Time());
  }
}

void HearMap(benchmark::State& state) {
  const auto uavs = static_cast<int>(state.range(0));
  TeamMember member(KeyOf(0), {});
  HearAll(uavs, 1, &member);
  std::uint64_t version = 1;
  for (auto _ : state) {
    state.PauseTiming();
    const auto bytes = EncodeMessage({KeyOf(1), PartOf(1, ++version)});
    state.ResumeTiming();
    member.Hear(bytes, Time());
  }
}

void HearDigest(benchmark::State& state) {
  const auto uavs = static_cast<int>(state.range(0));
  TeamMember member(KeyOf(0), {});
  HearAll(uavs, 1, &member);
  Digest digest(uavs);
  for (int uav = 0; uav < uavs; ++uav) {
    digest[uav].uav = KeyOf(uav);
    digest[uav].version = 1;
  }
  const auto bytes = EncodeMessage({KeyOf(1), digest});
  for (auto _ : state) member.Hear(bytes, Time());
}

void View(benchmark::State& state) {
  TeamMember member(KeyOf(0), {});
  HearAll(static_cast<int>(state.range(0)), 1, &member);
  for (auto _ : state) benchmark::DoNotOptimize(ViewTeam(member, {}, Time()));
}

BENCHMARK(HearMap)->Arg(2)->Arg(10)->Arg(50)->Unit(benchmark::kMillisecond);
BENCHMARK(HearDigest)->Arg(2)->Arg(10)->Arg(50)->Unit(benchmark::kMillisecond);
BENCHMARK(View)->Arg(2)->Arg(10)->Arg(50)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace kestrel

BENCHMARK_MAIN();
