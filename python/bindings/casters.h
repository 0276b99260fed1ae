// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Conversions of Kestrel's types to those of Python. Every source of the module includes this one,
// so that all convert a type alike.

#include <cmath>
#include <pybind11/eigen.h>
#include <pybind11/functional.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include "kestrel/time.h"

namespace pybind11::detail {

// An instant is a whole number of nanoseconds.
template <>
struct type_caster<kestrel::Time> {
  PYBIND11_TYPE_CASTER(kestrel::Time, const_name("int"));

  bool load(handle source, bool convert) {
    make_caster<std::int64_t> nanoseconds;
    if (!nanoseconds.load(source, convert)) return false;
    value = kestrel::TimeFromNanoseconds(cast_op<std::int64_t>(nanoseconds));
    return true;
  }
  static handle cast(kestrel::Time time, return_value_policy /*policy*/, handle /*parent*/) {
    return PyLong_FromLongLong(kestrel::ToNanoseconds(time));
  }
};

// A span of time is a number of seconds.
template <>
struct type_caster<kestrel::Duration> {
  PYBIND11_TYPE_CASTER(kestrel::Duration, const_name("float"));

  bool load(handle source, bool convert) {
    constexpr double kLongest_s = 9e9;  // what 64 bits of nanoseconds hold
    make_caster<double> seconds;
    if (!seconds.load(source, convert)) return false;
    if (!(std::abs(cast_op<double>(seconds)) < kLongest_s)) return false;
    value = kestrel::DurationFromSeconds(cast_op<double>(seconds));
    return true;
  }
  static handle cast(kestrel::Duration span, return_value_policy /*policy*/, handle /*parent*/) {
    return PyFloat_FromDouble(kestrel::ToSeconds(span));
  }
};

}  // namespace pybind11::detail
