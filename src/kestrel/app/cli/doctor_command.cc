// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <chrono>
#include <cmath>
#include <iostream>
#include <iterator>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <unistd.h>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "kestrel/app/cli/commands.h"
#include "kestrel/app/cli/fly_arguments.h"
#include "kestrel/app/cli/interrupt.h"
#include "kestrel/app/fly/fly_autopilot.h"
#include "kestrel/app/fly/fly_source.h"
#include "kestrel/comms/mavlink/link_url.h"
#include "kestrel/core/base/error.h"
#include "kestrel/core/camera/calibration_reader.h"
#include "kestrel/flight/doctor/check_list.h"
#include "kestrel/flight/doctor/computer_checks.h"
#include "kestrel/flight/doctor/examination.h"
#include "kestrel/flight/doctor/finding.h"
#include "kestrel/simulation/autopilot_rules/explanation.h"
#include "kestrel/vision/targets/make_target_detector.h"

namespace kestrel {
namespace {

struct DoctorArguments {
  FlyArguments flight;
  double moving_mps = 0;  // 0: the target stands
  double duration_s = 8;
  bool explain = false;
  bool json = false;
  bool fix = false;
};

// One examination of camera and autopilot. A device that cannot be opened is a finding as well.
class DoctorVisit {
 public:
  explicit DoctorVisit(const DoctorArguments& arguments)
      : arguments_(arguments),
        options_(arguments_.flight.ReadOptions()),
        source_(options_, arguments_.flight.source.dds.NodeOpener(options_.dds)) {
    SetUse();
    OpenSource();
    if (source_.live.source) {
      observations_.use.sight_range_m =
          ShapeOfTarget(options_.landing.target, options_.landing.detector)
              .SightRange(source_.live.calibration.intrinsics);
    }
    OpenLink();
    ExaminationParts parts;
    parts.source = source_.live.source.get();
    parts.calibration = source_.live.calibration;
    parts.further = source_.live.further;
    parts.connection = connection_ ? &*connection_ : nullptr;
    parts.autopilot = autopilot_ ? &*autopilot_ : nullptr;
    examination_.emplace(options_.landing, options_.fly.events, parts);
  }

  std::vector<Finding> Look() {
    if (simulated_) simulated_->Start();
    const Time start = Now();
    examination_->Run(DurationFromSeconds(arguments_.duration_s), WasInterrupted, &observations_);
    // The checks would judge what could not yet be seen.
    if (WasInterrupted()) {
      throw Interrupted(fmt::format("interrupted: not checked: {:.1f} s of flight, expected {:g} s",
                                    ToSeconds(Now() - start), arguments_.duration_s));
    }
    ComputerObservations computer = ObserveComputer(observations_.use.record);
    computer.frame_mb = observations_.computer.frame_mb;
    computer.least_disk_mb = options_.fly.recorder.free_space_mb;
    if (!observations_.use.record.empty()) {
      computer.disk_mb_per_s = MeasureDisk(observations_.use.record);
    }
    observations_.computer = computer;
    for (const LateCamera& late : source_.live.late) {
      CameraSetup& setup =
          late.camera == 0 ? observations_ : observations_.further[late.camera - 1];
      setup.camera.comes_late = true;
      setup.camera.delay = late.video->offset();
    }
    return Check(observations_);
  }

  // Sets the parameters that are not good, if the user agrees, reads them back, and checks again.
  std::vector<Finding> Fix(const std::vector<Finding>& findings) {
    if (!autopilot_ || !autopilot_->is_here()) return findings;
    if (autopilot_->is_armed()) {
      fmt::print(stderr, "the autopilot is armed: its parameters are left alone\n");
      return findings;
    }
    std::vector<ParameterFix> wanted;
    for (const Finding& finding : findings) {
      if (finding.fix && IsWanted(finding)) wanted.push_back(*finding.fix);
    }
    if (wanted.empty()) return findings;
    for (const ParameterFix& fix : wanted) autopilot_->SetParameter(fix.name, fix.value);
    WaitForWrites();
    bool needs_reboot = false;
    for (const ParameterFix& fix : wanted) needs_reboot |= TakeOver(fix) && fix.needs_reboot;
    if (needs_reboot) {
      fmt::print(stderr, "restart the autopilot: some take effect only then\n");
    }
    return Check(observations_);
  }

 private:
  void SetUse() {
    DoctorUse& use = observations_.use;
    const FlyArguments& flight = arguments_.flight;
    if (flight.profile != "auto") use.profile = ParseLinkProfile(flight.profile);
    use.guides = arguments_.flight.guide;
    use.points = flight.point || flight.guide;
    use.follows = flight.task.name == "follow";
    if (arguments_.moving_mps > 0) use.target_mps = arguments_.moving_mps;
    use.tilt_deg = options_.fly.guidance.limits.max_tilt_deg;
    use.sight_s = options_.fly.guidance.sight_s;
    use.pad_position = flight.pad_position;
    use.no_position = flight.no_position;
    use.has_reserve = !flight.floor.empty() && !flight.no_position;
    use.has_pad_origin = !options_.fly.pad_origin.empty();
    use.sends_distance = options_.fly.messages.sends_distance;
    use.attitude_rate_hz = options_.fly.autopilot.attitude_rate_hz;
    use.position_rate_hz = options_.fly.autopilot.position_rate_hz;
    if (options_.fly.link_delay_s >= 0) use.link_delay_s = options_.fly.link_delay_s;
    use.record = flight.record;
  }

  void OpenSource() {
    CameraObservations& camera = observations_.camera;
    try {
      if (arguments_.flight.source.sources.size() > 1) {
        source_.Open(arguments_.flight.Cameras(PixelFormat::kGray),
                     [this](const std::string& fault) { observations_.unopened.push_back(fault); });
      } else {
        RecordingChoice choice = arguments_.flight.source.Recording(PixelFormat::kGray);
        choice.all_cameras = true;
        source_.Open(choice, arguments_.flight.loop);
      }
    } catch (const ImageSizeError& error) {
      camera.open_error = error.what();
      camera.has_other_size = true;
      ReadCameraFile();
    } catch (const InputError& error) {
      camera.open_error = error.what();
      if (!observations_.unopened.empty()) observations_.unopened.pop_back();  // the same fault
      ReadCameraFile();
    }
  }

  // The calibration of a camera that cannot be opened.
  void ReadCameraFile() {
    const std::vector<std::string>& files = arguments_.flight.source.cameras;
    if (files.empty()) return;
    try {
      source_.live.calibration = ReadCalibration(files.front());
    } catch (const InputError&) {  // which is why it could not be opened
    }
  }

  void OpenLink() {
    LinkObservations& link = observations_.link;
    if (arguments_.flight.autopilot.empty()) return;
    link.isrequested = true;
    link.is_signed = !options_.fly.link.signing_key.empty();
    try {
      FlyAutopilot opened = MakeFlyAutopilot(arguments_.flight.autopilot, options_.fly,
                                             arguments_.flight.guide, &source_);
      const LinkUrl url = ParseLinkUrl(opened.url);
      link.scheme = url.scheme;
      link.baud = url.number;
      simulated_ = std::move(opened.simulated);
      connection_.emplace(opened.url, options_.fly.link);
    } catch (const InputError& error) {
      link.open_error = error.what();
      return;
    }
    AutopilotOptions options = source_.simulated.Asking(options_.fly.autopilot);
    if (const auto& gimbal = source_.live.calibration.gimbal) {
      options.gimbal_device_id = gimbal->device_id;
      options.points_gimbal = true;
    }
    if (const auto& zoom = source_.live.calibration.zoom) options.zoom_device_id = zoom->device_id;
    autopilot_.emplace(
        options, &*connection_,
        AutopilotListener{
            .pose = [this](const PoseSample& pose) { TakePose(pose); },
            .true_pose = [this](const PoseSample& pose) { source_.simulated.TakeTruePose(pose); },
            .event = [this](const AutopilotEvent& e) { examination_->TakeEvent(e); },
            .text = {},
            .gimbal = [this](const GimbalSample& report) { TakeGimbal(report); },
            .zoom = [this](const ZoomSample& report) { examination_->TakeZoom(report); },
        });
  }

  void TakePose(const PoseSample& pose) {
    if (!source_.live.has_poses) examination_->TakePose(pose);
    source_.simulated.TakePose(pose);
    for (const LateCamera& late : source_.live.late) late.video->Add(pose);
  }

  void TakeGimbal(const GimbalSample& report) {
    examination_->TakeGimbal(report);
    for (const LateCamera& late : source_.live.late) late.video->Add(report);
  }

  bool IsWanted(const Finding& finding) const {
    const ReportedParameter& reported = observations_.parameters.at(finding.fix->name);
    fmt::print(stderr, "{} is {:g}. Set it to {:g}? (y/n) ", reported.own_name,
               reported.value / reported.scale, finding.fix->value / reported.scale);
    std::string answer;
    std::getline(std::cin, answer);
    return answer.starts_with('y') || answer.starts_with('Y');
  }

  void WaitForWrites() {
    constexpr Duration kLongest = std::chrono::seconds(15);
    constexpr Duration kPatience = std::chrono::milliseconds(5);
    const Time start = Now();
    while (!autopilot_->parameter_writes().is_done() && Now() - start < kLongest) {
      connection_->Receive(kPatience, [this](const mavlink::Packet& packet, Time received) {
        autopilot_->Handle(packet, received);
      });
      autopilot_->Tick(Now());
    }
  }

  // Puts the value that the autopilot reports into the observations. Returns false when it was not
  // written.
  bool TakeOver(const ParameterFix& fix) {
    const ParameterWriteState state = autopilot_->parameter_writes().StateOf(fix.name);
    ReportedParameter& reported = observations_.parameters.at(fix.name);
    reported.value = autopilot_->parameters().Find(fix.name).value_or(reported.value);
    fmt::print(stderr, "{}: {}, now {:g}\n", reported.own_name, ToString(state),
               reported.value / reported.scale);
    return state == ParameterWriteState::kWritten;
  }

  DoctorArguments arguments_;
  KestrelOptions options_;
  DoctorObservations observations_;
  FlySource source_;
  std::unique_ptr<SimulatedAutopilot> simulated_;
  std::optional<Connection> connection_;
  std::optional<Autopilot> autopilot_;
  std::optional<Examination> examination_;
};

void RunDoctor(const DoctorArguments& arguments) {
  if (arguments.explain) {
    fmt::print("{}{}", CheckTable(), Explain({}));
    return;
  }
  CatchInterrupts();  // a source may take seconds to open
  DoctorVisit visit(arguments);
  fmt::print(stderr, "observing for {:g} s\n", arguments.duration_s);
  std::vector<Finding> findings = visit.Look();
  const bool has_colors = isatty(STDOUT_FILENO) != 0;
  if (arguments.fix) {
    fmt::print(stderr, "{}", FindingsTable(findings, isatty(STDERR_FILENO) != 0));
    findings = visit.Fix(findings);
  }
  fmt::print("{}", arguments.json ? FindingsJson(findings) : FindingsTable(findings, has_colors));
  std::vector<std::string_view> wrong;
  for (const Finding& finding : findings) {
    if (finding.verdict == Verdict::kWrong) wrong.push_back(finding.check);
  }
  if (!wrong.empty()) throw InputError(fmt::format("wrong: {}", fmt::join(wrong, ", ")));
}

}  // namespace

void AddDoctorCommand(CLI::App* app) {
  constexpr double kFastest_mps = 40;
  CLI::App* command =
      app->add_subcommand("doctor", "Check camera, calibration, mount, autopilot and computer");
  const auto arguments = std::make_shared<DoctorArguments>();
  arguments->flight.AddTo(command);
  command
      ->add_flag("--moving{4.2}", arguments->moving_mps,
                 "Check the set-up for a moving target, at 4.2 m/s or --moving=SPEED")
      ->check(InRange(0, kFastest_mps, "a speed in m/s, up to 40"));
  command->add_option("--duration", arguments->duration_s, "Duration of the observation (8 s)")
      ->type_name("S")
      ->check(InRange(0.999, 600.001, "1 to 600 seconds"));
  CLI::Option* explain =
      command->add_flag("--explain", arguments->explain,
                        "Only print all checks with what is good, and the messages for a pattern "
                        "2 m ahead, 1 m right, 5 m below, with the position that each autopilot "
                        "computes from them");
  command->add_flag("--json", arguments->json, "The findings as JSON")->excludes(explain);
  command
      ->add_flag("--fix", arguments->fix,
                 "Set the parameters that are not good, after a question for each")
      ->excludes(explain);
  command->callback([arguments] { RunDoctor(*arguments); });
}

}  // namespace kestrel
