// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <CLI/CLI.hpp>

namespace kestrel {

// Each adds a subcommand with its options to the command line; `fly` has a header of its own.

// `kestrel land SOURCE...`, `kestrel hunt SOURCE...`: run a task over a source.
void AddTaskCommands(CLI::App* app);
// `kestrel doctor`: says what is wrong with camera, calibration, mount, autopilot and computer, and
// what to do about it.
void AddDoctorCommand(CLI::App* app);
// `kestrel console SOURCE...`: shows a recording on a web page.
void AddConsoleCommand(CLI::App* app);
// `kestrel simulate landing|hunt|touchdown`: renders a recording with truth.
void AddSimulateCommand(CLI::App* app);
void AddTouchdownCommand(CLI::App* simulate);
// `kestrel demo`: simulated flights, their videos and plots, and a verdict.
void AddDemoCommand(CLI::App* app);
// `kestrel evaluate RECORDING OUTPUT`: compares an output folder with the recording's truth.
void AddEvaluateCommand(CLI::App* app);
// `kestrel calibrate mount|clock|lens|pads|colors`: mount angles and clock offset from a flight
// over the landing pattern, the lens from views of it, a map of tags, colour models from marked
// images.
void AddCalibrateCommand(CLI::App* app);
void AddCalibrateLensCommand(CLI::App* calibrate);
void AddCalibratePadsCommand(CLI::App* calibrate);
void AddCalibrateColorsCommand(CLI::App* calibrate);
// `kestrel print`: the landing pattern on paper, or the check of a photographed print.
void AddPrintCommand(CLI::App* app);
// `kestrel convert SOURCE DESTINATION`: converts between EuRoC folders and bags of ROS 1 and ROS 2.
void AddConvertCommand(CLI::App* app);
// `kestrel study run|report`: many recordings, several configurations; a program in Python.
void AddStudyCommand(CLI::App* app);
// `kestrel benchmark`: says how fast this computer is.
void AddBenchmarkCommand(CLI::App* app);
// `kestrel config`: prints all options with value, unit and meaning, as YAML for --config.
void AddConfigCommand(CLI::App* app);
// `kestrel help [SUBCOMMAND]`: the same as --help.
void AddHelpCommand(CLI::App* app);

}  // namespace kestrel
