// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/cli/fly_arguments.h"

#include <algorithm>
#include <string>
#include <string_view>

#include <fmt/format.h>

#include "kestrel/core/base/error.h"
#include "kestrel/core/base/options.h"
#include "kestrel/core/base/parse_number.h"

namespace kestrel {
namespace {

// Throws InputError for the arguments of `land` that a flight does not support.
void RequireFlyable(const SourceArguments& source) {
  const std::size_t sources = std::max<std::size_t>(source.sources.size(), 1);
  const std::size_t files = source.cameras.size();
  if (files > 1 && files != sources) {
    throw InputError(fmt::format(
        "--camera: expected one FILE for each SOURCE, or one with an entry for each, got {} for {}",
        files, sources));
  }
  if (sources > 1 && source.clock_offset) {
    throw InputError(
        "--clock-offset is of one camera, expected time_offset_s in the calibration of each");
  }
  if (source.still) throw InputError("--still: the frames of a flight follow each other");
  if (!source.annotate.empty()) {
    throw InputError("--annotate: record the flight, then kestrel land DIR --annotate");
  }
  if (source.fov_deg) {
    throw InputError("--fov: a flight needs a calibration (--camera): kestrel calibrate lens");
  }
  if (source.altitude_m) throw InputError("--altitude: a flight has the autopilot's poses");
}

double ParseLinkDelay(const std::string& text) {
  const auto delay_s = ParseNumber<double>(text);
  if (!delay_s || !(*delay_s >= 0)) {
    throw InputError(fmt::format("--link-delay '{}': expected seconds or auto", text));
  }
  return *delay_s;
}

}  // namespace

void FlyArguments::AddTo(CLI::App* command) {
  source.AddTo(command);
  command->get_option("SOURCE")->required(false)->description(
      "A camera (/dev/video0, rtsp://...) or several, with a --camera FILE each, a GStreamer "
      "pipeline, a topic of ROS 2 (dds:TOPIC) or several, a "
      "simulated camera (sim:SCENARIO, as sim:standing or sim:figure8), or a recording, which is "
      "played in real time (default: fly.source of --config)");
  source.options.target.AddTo(command);
  command
      ->add_option("--autopilot", autopilot,
                   "Connection to the autopilot: serial:///dev/ttyAMA0:921600, "
                   "udpin://0.0.0.0:14550, udpout://HOST:PORT, tcpout://HOST:PORT, "
                   "tcpin://HOST:PORT; sim:ardupilot, sim:px4: a simulated one")
      ->type_name("URL");
  command
      ->add_option("--profile", profile,
                   "Messages for the autopilot: auto (by its heartbeat), ardupilot, px4, px4-vte")
      ->type_name("NAME")
      ->check(CLI::IsMember({"auto", "ardupilot", "px4", "px4-vte"}));
  command->add_option("--rate", rate_hz, "Landing targets or set-points per second (50)")
      ->type_name("HZ")
      ->check(InRange(0.999, 400.001, "1 to 400 per second"));
  command
      ->add_option("--link-delay", link_delay,
                   "Delay from sending to the autopilot's use; auto: half of the round trip")
      ->type_name("S");
  command
      ->add_option("--signing-key", signing_key,
                   "Key for MAVLink 2 signing: packets are signed, and unsigned ones refused")
      ->type_name("FILE");
  command
      ->add_option("--record", record,
                   "Folder for a recording of the flight: EuRoC images and poses, and mavlink.tlog")
      ->type_name("DIR");
  command
      ->add_option_function<std::string>(
          "--console", [this](const std::string& address) { console = address; },
          "Serve the web page (default address 127.0.0.1:8080)")
      ->type_name("[ADDRESS:PORT]")
      ->expected(0, 1);
  command
      ->add_option("--video", video,
                   "Serve the images with the results drawn in as a video (H.264): "
                   "rtsp://ADDRESS:PORT/PATH")
      ->type_name("URL");
  CLI::Option* guide_flag = command->add_flag(
      "--guide", guide, "Fly the UAV by set-points when the pilot gives it GUIDED or OFFBOARD");
  command
      ->add_flag("--no-guard", no_guard,
                 "No guard: if Kestrel dies in flight, only the autopilot's own time-out acts")
      ->needs(guide_flag);
  CLI::Option* point_flag = command->add_flag(
      "--point", point,
      "Point the camera's gimbal at the pattern, or at what is marked, as --guide does, too");
  CLI::Option* position_flag = command->add_flag(
      "--pad-position", pad_position,
      "Send the place over the pad, which stands, to the autopilot as its position: no GNSS");
  CLI::Option* no_position_flag =
      command
          ->add_flag(
              "--no-position", no_position,
              "Fly over the pad and land on it by lean and climb alone, when the pilot gives "
              "GUIDED_NOGPS or OFFBOARD: the autopilot has no position; needs --floor and "
              "--ceiling")
          ->needs(guide_flag)
          ->excludes(position_flag);
  command->add_flag("--hover", hover, "Stay above the pad, at the height of the beginning")
      ->needs(no_position_flag);
  command
      ->add_option(
          "--floor", floor,
          "Without a position, also one that is lost in a --guide landing: still, or moves: "
          "the pad, or what is below, may move")
      ->type_name("WORD")
      ->check(CLI::IsMember({"still", "moves"}))
      ->needs(guide_flag)
      ->excludes(position_flag);
  command
      ->add_option("--ceiling", ceiling,
                   "As --floor: yes, or no: a pad that is lost is looked for from higher up")
      ->type_name("WORD")
      ->check(CLI::IsMember({"yes", "no"}))
      ->needs(guide_flag)
      ->excludes(position_flag);
  task.AddTo(command, [](std::string_view) { return true; });
  CLI::Option* hunt_flag = command->get_option("--hunt");
  command->add_option("--model", model, "Objects and their colours (YAML), with --hunt")
      ->type_name("FILE")
      ->needs(hunt_flag);
  CLI::Option* follow_flag = command->get_option("--follow");
  CLI::Option* go_flag =
      command
          ->add_option(
              "--go", go,
              "Fly to the best object of this class in the map (--hunt) and down on it, to "
              "what is marked (--follow), or to a place")
          ->type_name("CLASS|marked|LAT,LON")
          ->needs(guide_flag)
          ->excludes(position_flag)
          ->excludes(no_position_flag)
          ->excludes("--floor")
          ->excludes("--ceiling");
  command
      ->add_option("--then", then,
                   "There: hover, look (keeps pictures), drop or pick (the gripper), also with the "
                   "height in m and the time in s, as hover,3,20 (hover)")
      ->type_name("JOB")
      ->needs(go_flag);
  command
      ->add_option("--box", box,
                   "After a pick, the place to which the object is taken; then the next one")
      ->type_name("LAT,LON")
      ->needs(go_flag);
  point_flag->excludes(hunt_flag);
  for (CLI::Option* other : {hunt_flag, follow_flag}) {
    position_flag->excludes(other);
    no_position_flag->excludes(other);
    other->excludes("--target")->excludes("--target-id")->excludes("--target-size");
  }
  team.AddTo(command)->needs(hunt_flag);
  command->add_flag("--loop", loop, "Play a recording in a loop");
}

std::vector<RecordingChoice> FlyArguments::Cameras(PixelFormat format) const {
  std::vector<RecordingChoice> cameras;
  for (std::size_t i = 0; i < source.sources.size(); ++i) {
    SourceArguments one = source;
    one.sources = {source.sources[i]};
    if (source.cameras.size() > 1) one.cameras = {source.cameras[i]};
    cameras.push_back(one.Recording(format));
  }
  return cameras;
}

std::optional<RelativeJob> FlyArguments::WithoutPosition() const {
  if (floor.empty()) return std::nullopt;
  return RelativeJob{.lands = !hover,
                     .pad_moves = floor == "moves",
                     .has_ceiling = ceiling == "yes",
                     .is_reserve = !no_position};
}

// A text with a comma is a place. At a place the UAV flies no lower than limits.floor_m.
void FlyArguments::ReadGo(const FlyOptions& options) {
  job = ParseGoJob(then);
  const bool is_place = go.find(',') != std::string::npos;
  const bool is_marked = task.name == "follow" && go == "marked";
  if (is_place) {
    place = ParseGlobalPosition(go);
    if (!place) throw InputError(fmt::format("--go '{}': expected LAT,LON in degrees", go));
    job.target = GoTarget::kPlace;
    const double least_m = options.guidance.limits.floor_m - options.guidance.leg_m;
    if (then.find(',') == std::string::npos) job.height_m = std::max(job.height_m, least_m);
    if (!team.team.empty()) {
      throw InputError("--go LAT,LON: expected no --team, which goes to objects");
    }
  } else if (is_marked) {
    job.target = GoTarget::kMarked;
  } else if (!go.empty() && task.name != "hunt") {
    throw InputError(fmt::format(
        "--go '{}': expected LAT,LON, marked with --follow, or a class with --hunt", go));
  }
  if (box.empty()) return;
  box_place = ParseGlobalPosition(box);
  if (!box_place) throw InputError(fmt::format("--box '{}': expected LAT,LON in degrees", box));
  if (job.action != GoAction::kPick || job.target != GoTarget::kObject) {
    throw InputError("--box: expected --then pick, and --go CLASS");
  }
  job.delivers = true;
}

KestrelOptions FlyArguments::ReadOptions() {
  RequireFlyable(source);
  KestrelOptions options = source.options.Read();
  given = source.options.Settings();
  if (!source.sources.empty()) {
    options.fly.source = source.sources.front();
    given.push_back("fly.source=" + options.fly.source);
  } else if (options.fly.source.empty()) {
    throw CLI::RequiredError("SOURCE, or fly.source in --config FILE,");
  }
  if (source.sources.empty()) source.sources = {options.fly.source};
  if (rate_hz) options.fly.rate_hz = *rate_hz;
  if (!signing_key.empty()) options.fly.link.signing_key = signing_key;
  if (link_delay != "auto") options.fly.link_delay_s = ParseLinkDelay(link_delay);
  if (guide && autopilot.empty()) throw InputError("--guide: expected --autopilot URL");
  if (point && autopilot.empty()) throw InputError("--point: expected --autopilot URL");
  if (pad_position && autopilot.empty()) {
    throw InputError("--pad-position: expected --autopilot URL");
  }
  ReadGo(options.fly);
  if (guide && task.name == "follow" && !place && !console) {
    throw InputError("--follow --guide: expected --console, on which a person confirms the flight");
  }
  if (guide && task.name == "hunt" && go.empty()) {
    throw InputError("--hunt --guide: expected --go CLASS, the objects to fly to");
  }
  const bool is_answered = !floor.empty() && !ceiling.empty();
  const bool is_without = no_position || !floor.empty() || !ceiling.empty();
  if (is_without && !is_answered) {
    throw InputError(
        "expected --floor still or moves, and --ceiling yes or no: without a position they decide "
        "what a lost pad costs");
  }
  if (!floor.empty() && task.name != "land") {
    throw InputError("--floor: expected a landing, not --hunt or --follow");
  }
  if (no_guard) options.fly.guard.enabled = false;
  if (console && !console->empty()) {
    options.console = WithAddress(options.console, *console, "--console");
    RequireValid(options.console);
  }
  return options;
}

}  // namespace kestrel
