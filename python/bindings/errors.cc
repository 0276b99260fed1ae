// SPDX-License-Identifier: BSD-3-Clause
#include <mutex>
#include <set>
#include <string>
#include <string_view>

#include "bindings.h"
#include "kestrel/error.h"
#include "value_class.h"

namespace kestrel::python {

std::string_view Interned(const std::string& text) {
  static std::mutex mutex;
  static std::set<std::string> texts;
  const std::lock_guard lock(mutex);
  return *texts.insert(text).first;
}

void Warn(const std::string& text) {
  if (PyErr_WarnEx(PyExc_UserWarning, text.c_str(), 1) != 0) throw pybind11::error_already_set();
}

void BindErrors(pybind11::module_& module) {
  pybind11::register_exception<InputError>(module, "InputError", PyExc_ValueError).doc() =
      "An error in what was given: a file, a key, a row, an option, the size of an image. One line "
      "that names it and says what was expected.";
}

}  // namespace kestrel::python
