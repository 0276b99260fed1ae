// SPDX-License-Identifier: BSD-3-Clause
// One flight of `kestrel fly --guide` over UDP to a simulated autopilot, with one death on the way:
//
//   death_flight KESTREL AUTOPILOT SOURCE DEATH HEIGHT SEED [ARGUMENT OF FLY...]
//
// AUTOPILOT: ardupilot, px4. SOURCE: sim:standing, sim:figure8. DEATH: killed, crashed, stopped,
// interrupted (Ctrl-C), guard-killed, guard-stopped, restarted (the autopilot), none. It
// happens when the UAV has come down to HEIGHT metres above the ground after it was given the mode.
// Prints one line: what the UAV did in the 6 s after it; its status says whether the flight came as
// far as the death. What Kestrel says goes to the file DEATH_FLIGHT_LOG, if the environment has it.
#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <map>
#include <signal.h>
#include <string>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>
#include <vector>

#include <fmt/format.h>

#include "kestrel/comms/mavlink/autopilot_kind.h"
#include "kestrel/comms/mavlink/socket_address.h"
#include "kestrel/simulation/autopilots/simulated_autopilot.h"

namespace kestrel {
namespace {

constexpr double kLeg_m = 0.35;
constexpr double kDown_m =
    0.02;  // the feet are as low as the ground and the board, which are level
constexpr double kPatience_s = 60;
constexpr double kAftermath_s = 6;

struct Arguments {
  std::string kestrel, autopilot, source, death;
  double height_m;
  std::uint64_t seed;
  std::vector<std::string> more;
};

class DeathFlight {
 public:
  explicit DeathFlight(const Arguments& arguments)
      : arguments_(arguments),
        port_(FreeLoopbackPort()),
        start_s_(ToSeconds(Now().time_since_epoch())),
        world_(World(arguments.source, start_s_), Now(), arguments.seed),
        autopilot_(Options(arguments), fmt::format("udpout://127.0.0.1:{}", port_), &world_,
                   arguments.seed) {
    autopilot_.Start();
    StartKestrel();
  }
  ~DeathFlight() {
    kill(kestrel_, SIGKILL);
    waitpid(kestrel_, nullptr, 0);
    autopilot_.Stop();
  }
  DeathFlight(const DeathFlight&) = delete;
  DeathFlight& operator=(const DeathFlight&) = delete;

  // False when it did not come down to the height in the mode.
  bool Run() {
    const Time end = Now() + DurationFromSeconds(kPatience_s);
    while (Now() < end && !IsThere()) std::this_thread::sleep_for(std::chrono::milliseconds(2));
    if (!IsThere()) {
      fmt::print("did not come down to {:g} m in the mode\n", arguments_.height_m);
      return false;
    }
    Die();
    Watch();
    return true;
  }

 private:
  static VehicleWorldOptions World(const std::string& source, double start_s) {
    VehicleWorldOptions world = ReadVehicleWorld(source.substr(source.find(':') + 1), {});
    world.start_s = start_s;
    world.ground.map_px = 64;  // this world is not rendered
    return world;
  }

  static SimulatedAutopilotOptions Options(const Arguments& arguments) {
    SimulatedAutopilotOptions options;
    options.firmware = arguments.autopilot;
    options.model.pilot.land_after_s = -1;
    options.model.pilot.guide_after_s = 10;  // Kestrel is there by then, on a loaded machine too
    // As doctor asks for. Without these PX4 refuses, or flies on for good; and ArduPilot's BRAKE
    // takes up to 12 m from the speed at which the UAV catches up with the car.
    options.model.parameters = arguments.autopilot == "px4"
                                   ? "LNDMC_XY_VEL_MAX=12,COM_OBL_RC_ACT=5,NAV_RCL_ACT=1"
                                   : "WP_ACC=6,PSC_JERK_NE=20";
    return options;
  }

  void StartKestrel() {
    const std::string url = fmt::format("udpin://127.0.0.1:{}", port_);
    const std::string seed = fmt::format("fly.sim_seed={}", arguments_.seed);
    const std::string source = fmt::format("{},start_s={:.6f}", arguments_.source, start_s_);
    const char* const log = std::getenv("DEATH_FLIGHT_LOG");
    kestrel_ = fork();
    if (kestrel_ != 0) return;
    if (freopen(log != nullptr ? log : "/dev/null", "w", stderr) == nullptr) _exit(1);
    std::vector<std::string> words = {
        "kestrel", "fly",   source, "--autopilot", url,
        "--guide", "--set", seed,   "--set",       "fly.sim_camera.scale=0.4"};
    words.insert(words.end(), arguments_.more.begin(), arguments_.more.end());
    std::vector<char*> pointers;
    for (std::string& word : words) pointers.push_back(word.data());
    pointers.push_back(nullptr);
    execv(arguments_.kestrel.c_str(), pointers.data());
    _exit(127);
  }

  AutopilotKind Kind() const {
    return arguments_.autopilot == "px4" ? AutopilotKind::kPx4 : AutopilotKind::kArduPilot;
  }
  Eigen::Vector3d Place() const { return autopilot_.truth().world_from_body.translation; }
  Eigen::Vector3d Velocity() const { return autopilot_.truth().motion->velocity_in_world; }
  double Height() const { return Place().z() - kLeg_m; }
  bool IsThere() const {
    return IsGuidedMode(Kind(), autopilot_.custom_mode()) && Height() < arguments_.height_m;
  }

  pid_t Guard() const {
    std::ifstream children(fmt::format("/proc/{}/task/{}/children", kestrel_, kestrel_));
    pid_t guard = -1;
    children >> guard;
    return guard > 0 ? guard : 0;
  }
  void SignalGuard(int number) const {
    if (const pid_t guard = Guard(); guard > 0) kill(guard, number);
  }

  // The deaths: a new one is a line here, and one in scripts/deaths.
  void Die() {
    const std::map<std::string, std::function<void()>> deaths = {
        {"none", [] {}},
        {"killed", [this] { kill(kestrel_, SIGKILL); }},
        {"crashed", [this] { kill(kestrel_, SIGSEGV); }},
        {"stopped", [this] { kill(kestrel_, SIGSTOP); }},
        {"interrupted", [this] { kill(kestrel_, SIGINT); }},
        {"guard-killed", [this] { SignalGuard(SIGKILL); }},
        {"guard-stopped", [this] { SignalGuard(SIGSTOP); }},
        {"restarted", [this] { autopilot_.Reboot(); }},
    };
    deaths.at(arguments_.death)();
  }

  void Watch() const {
    const Eigen::Vector3d place = Place();
    const double speed_mps = Velocity().norm();
    const Time died = Now();
    double farthest_m = 0, lowest_m = Height(), impact_mps = 0;
    double before_mps = speed_mps;
    while (Now() < died + DurationFromSeconds(kAftermath_s)) {
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
      farthest_m = std::max(farthest_m, (Place() - place).head<2>().norm());
      const bool is_down = Height() < kDown_m;
      if (is_down && lowest_m >= kDown_m) impact_mps = before_mps;
      lowest_m = std::min(lowest_m, Height());
      before_mps = Velocity().norm();
    }
    const auto contact = autopilot_.result().contact;
    const char* const surface = contact && contact->on_board ? "board" : "ground";
    fmt::print("farthest {:.2f} lowest {:.2f} impact {:.2f} {} speed {:.2f} to {:.2f} mode {}\n",
               farthest_m, lowest_m, impact_mps, lowest_m < kDown_m ? surface : "none", speed_mps,
               Velocity().norm(), ModeName(Kind(), autopilot_.custom_mode()));
  }

  Arguments arguments_;
  int port_;
  double start_s_;  // of the world, which the camera and the autopilot share
  VehicleWorld world_;
  SimulatedAutopilot autopilot_;
  pid_t kestrel_ = 0;
};

}  // namespace
}  // namespace kestrel

int main(int argc, char** argv) {
  constexpr int kLeast = 7;
  if (argc < kLeast) {
    fmt::print(stderr, "death_flight KESTREL AUTOPILOT SOURCE DEATH HEIGHT SEED [ARGUMENT...]\n");
    return 2;
  }
  const kestrel::Arguments arguments{argv[1],
                                     argv[2],
                                     argv[3],
                                     argv[4],
                                     std::atof(argv[5]),
                                     std::strtoull(argv[6], nullptr, 10),
                                     {argv + kLeast, argv + argc}};
  return kestrel::DeathFlight(arguments).Run() ? 0 : 1;
}
