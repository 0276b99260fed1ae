// SPDX-License-Identifier: BSD-3-Clause
#include <cstdlib>
#include <exception>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <opencv2/core/utils/logger.hpp>

#include "kestrel/app/cli/commands.h"
#include "kestrel/app/cli/fly_command.h"
#include "kestrel/app/cli/interrupt.h"
#include "kestrel/app/cli/terminal.h"
#include "kestrel/app/cli/usage_error.h"
#include "kestrel/io/recording/media/silence_gstreamer.h"
#include "kestrel/io/recording/media/video_address.h"
#include "kestrel/version.h"

namespace {

constexpr int kInputAtFault = 1;
constexpr int kWrongUsage = 2;

// Errors are reported once and in our words; those of OpenCV and GStreamer would bury them.
void SilenceLibraries() {
  kestrel::SilenceGstreamer();
  cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT);
}

void UnsilenceLibraries() {
  kestrel::UnsilenceGstreamer();
  cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_INFO);
}

}  // namespace

int main(int argc, char** argv) {
  SilenceLibraries();
  CLI::App app("Kestrel gives UAVs eyes for landing on moving targets.", "kestrel");
  app.set_version_flag("--version", fmt::format("kestrel {}", kestrel::kVersion));
  app.add_flag_callback("--verbose", UnsilenceLibraries,
                        "Print the messages of GStreamer and OpenCV too");
  app.fallthrough();  // also behind the subcommand
  app.require_subcommand(1);
  kestrel::AddDemoCommand(&app);
  kestrel::AddTaskCommands(&app);
  kestrel::AddFlyCommand(&app);
  kestrel::AddDoctorCommand(&app);
  kestrel::AddConsoleCommand(&app);
  kestrel::AddSimulateCommand(&app);
  kestrel::AddEvaluateCommand(&app);
  kestrel::AddCalibrateCommand(&app);
  kestrel::AddPrintCommand(&app);
  kestrel::AddConvertCommand(&app);
  kestrel::AddStudyCommand(&app);
  kestrel::AddBenchmarkCommand(&app);
  kestrel::AddConfigCommand(&app);
  kestrel::AddHelpCommand(&app);
  try {
    app.parse(argc, argv);
    return EXIT_SUCCESS;
  } catch (const CLI::Success& wanted) {  // help, version
    return app.exit(wanted);
  } catch (const CLI::ParseError& error) {
    fmt::print(
        stderr, "{}\n",
        kestrel::WithoutPassword(kestrel::UsageErrorInWords(app, error, {argv + 1, argv + argc})));
    return kWrongUsage;
  } catch (const kestrel::WrongUsage& error) {
    fmt::print(stderr, "kestrel: {}\n", kestrel::WithoutPassword(error.what()));
    return kWrongUsage;
  } catch (const kestrel::BadFlightEnd& end) {
    kestrel::Print(fmt::format("kestrel: {}\n", end.what()));
    return end.status();
  } catch (const kestrel::Interrupted& end) {
    fmt::print(stderr, "kestrel: {}\n", end.what());
    return kestrel::kInterruptedStatus;
  } catch (const std::exception& error) {
    fmt::print(stderr, "kestrel: {}\n", kestrel::WithoutPassword(error.what()));
    return kInputAtFault;
  }
}
