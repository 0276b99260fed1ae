// SPDX-License-Identifier: BSD-3-Clause
// Measures the cost of a team's messages for a UAV, by the number of UAVs: receiving a map of 100
// objects, a digest, and fusing all maps (for the first time, after a change of one UAV's map,
// after a change of the map of the common world, and without a change).
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>

#include "kestrel/comms/team/team_member.h"
#include "kestrel/comms/team/team_view.h"
#include "kestrel/core/base/random.h"

namespace kestrel {
namespace {

constexpr std::size_t kObjects = 100;

UavKey KeyOf(int uav) { return {"uav" + std::to_string(uav), 1}; }

// A hundred objects of five colours within 100 m, as seen by a UAV whose navigation is off by one
// metre and one degree.
PartMessage PartOf(int uav, std::uint64_t version) {
  constexpr double kNoise_m = 0.05;
  Random field(1);
  Random own(1000 * static_cast<std::uint64_t>(uav) + version);
  WorldAlignment world;
  world.pivot = {50, 50, 0};
  world.translation = {std::cos(uav), std::sin(uav), 0};
  world.yaw = 0.017 * std::cos(3 * uav);
  PartMessage part;
  part.uav = KeyOf(uav);
  part.contents.version = version;
  for (std::size_t i = 1; i <= kObjects; ++i) {
    MappedObject object;
    object.id = static_cast<std::int64_t>(i);
    object.detections = 10;
    object.state.head<2>() << field.Uniform(0, 100), field.Uniform(0, 100);
    object.state.head<3>() = world * Eigen::Vector3d(object.position());
    object.state.head<2>() += kNoise_m * Eigen::Vector2d(own.Normal(), own.Normal());
    object.covariance.diagonal().head<3>().setConstant(kNoise_m * kNoise_m);
    object.color_log_likelihoods[i % 5] = 5;
    part.contents.objects[object.id] = version;
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

void FirstView(benchmark::State& state) {
  TeamMember member(KeyOf(0), {});
  HearAll(static_cast<int>(state.range(0)), 1, &member);
  for (auto _ : state) {
    TeamFusion fusion({}, {});
    benchmark::DoNotOptimize(ViewTeam(member, Time(), &fusion));
    state.counters["objects"] = static_cast<double>(fusion.standing().size());
  }
}

// Receives a new version of the map of 'changing'; 0: of none.
void ViewAgain(benchmark::State& state, int changing) {
  TeamMember member(KeyOf(0), {});
  HearAll(static_cast<int>(state.range(0)), 1, &member);
  TeamFusion fusion({}, {});
  std::uint64_t version = 1;
  for (auto _ : state) {
    if (changing != 0) {
      state.PauseTiming();
      const auto bytes = EncodeMessage({KeyOf(changing), PartOf(changing, ++version)});
      state.ResumeTiming();
      member.Hear(bytes, Time());
    }
    benchmark::DoNotOptimize(ViewTeam(member, Time(), &fusion));
  }
}

void ViewUnchanged(benchmark::State& state) { ViewAgain(state, 0); }
void ViewOneChanged(benchmark::State& state) { ViewAgain(state, 2); }
void ViewCommonChanged(benchmark::State& state) { ViewAgain(state, 1); }

BENCHMARK(HearMap)->Arg(2)->Arg(10)->Arg(50)->Unit(benchmark::kMillisecond);
BENCHMARK(HearDigest)->Arg(2)->Arg(10)->Arg(50)->Unit(benchmark::kMillisecond);
BENCHMARK(FirstView)->Arg(3)->Arg(10)->Arg(50)->Unit(benchmark::kMillisecond);
BENCHMARK(ViewUnchanged)->Arg(3)->Arg(10)->Arg(50)->Unit(benchmark::kMillisecond);
BENCHMARK(ViewOneChanged)->Arg(3)->Arg(10)->Arg(50)->Unit(benchmark::kMillisecond);
BENCHMARK(ViewCommonChanged)->Arg(3)->Arg(10)->Arg(50)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace kestrel

BENCHMARK_MAIN();
