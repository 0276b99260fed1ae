// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>

#include "kestrel/app/evaluation/object_comparison.h"
#include "kestrel/app/evaluation/report_table.h"

namespace kestrel {

// Returns by class and in total: share of the wanted objects that were found, precision of the
// detections, share of right classes, errors.
ReportTable DetectionTable(std::span<const ObjectComparison> comparisons);

// Rows: true classes. Columns: the classes that were reported for them, or nothing.
ReportTable ConfusionTable(std::span<const ObjectComparison> comparisons);

// Share of right classes (with shapes) and digits by their reported probability. A 6 does not count
// as a 9 here, as each digit has a probability of its own.
ReportTable ProbabilityTable(std::span<const ObjectComparison> comparisons);

// Completeness and correctness of the map.
ReportTable MapTable(std::span<const MapComparison> comparisons);

}  // namespace kestrel
