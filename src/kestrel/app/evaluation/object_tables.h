// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>

#include "kestrel/app/evaluation/object_comparison.h"
#include "kestrel/app/evaluation/report_table.h"

namespace kestrel {

// By class and in all: found of the objects that must be found, precision of the detections, share
// of right classes, errors.
ReportTable DetectionTable(std::span<const ObjectComparison> comparisons);

// Rows: true classes; columns: the classes that they were given, or nothing.
ReportTable ConfusionTable(std::span<const ObjectComparison> comparisons);

// What is said to be so probable, and how much of it is right: classes with their shapes, and
// digits (a 6 is no 9 here: each is said to be as probable as it is).
ReportTable ProbabilityTable(std::span<const ObjectComparison> comparisons);

// How complete and how right the map is.
ReportTable MapTable(std::span<const MapComparison> comparisons);

}  // namespace kestrel
