// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "casters.h"
#include "kestrel/calibration.h"

namespace kestrel::python {

// The argument "camera": a CameraModel, CameraIntrinsics or a CameraCalibration.
struct CameraArgument {
  std::optional<CameraModel> model;
};

}  // namespace kestrel::python

namespace pybind11::detail {

// A caster instead of implicit conversions, which would hide what is wrong with a camera.
template <>
struct type_caster<kestrel::python::CameraArgument> {
  PYBIND11_TYPE_CASTER(kestrel::python::CameraArgument,
                       const_name("Union[CameraModel, CameraIntrinsics, CameraCalibration]"));

  bool load(handle source, bool /*convert*/) {
    if (isinstance<kestrel::CameraModel>(source)) {
      value.model = source.cast<const kestrel::CameraModel&>();
    } else if (isinstance<kestrel::CameraIntrinsics>(source)) {
      value.model.emplace(source.cast<const kestrel::CameraIntrinsics&>());
    } else if (isinstance<kestrel::CameraCalibration>(source)) {
      value.model.emplace(source.cast<const kestrel::CameraCalibration&>().intrinsics);
    }
    return value.model.has_value();
  }
};

}  // namespace pybind11::detail
