// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "casters.h"
#include "kestrel/error.h"

namespace kestrel::python {

// Returns a view of a text that lives as long as the program: for results whose text is static.
std::string_view Interned(const std::string& text);

// A class of plain values in Python. Its objects do not change: they are made with names of fields,
// `replace` makes another one, and they can be pickled, printed and turned into a dict.
template <class T>
class ValueClass {
 public:
  // 'blank' has the values of fields that are not given.
  ValueClass(pybind11::module_& module, const char* name, const char* doc, const T& blank = T{})
      : fields_(std::make_shared<std::vector<FieldOf>>()), class_(module, name, doc) {
    const auto fields = fields_;
    const std::string own = name;
    class_.def(pybind11::init([fields, own, blank](const pybind11::kwargs& values) {
                 T value = blank;
                 SetAll(*fields, own, values, &value);
                 return value;
               }),
               "Makes a value from its fields, by their names; the others have their defaults.");
    class_.def(
        "replace",
        [fields, own](const T& self, const pybind11::kwargs& values) {
          T value = self;
          SetAll(*fields, own, values, &value);
          return value;
        },
        "Returns a copy with other values of the named fields.");
    class_.def(
        "asdict",
        [fields](const T& self) {
          pybind11::dict values;
          for (const FieldOf& field : *fields) values[field.name] = field.get(self);
          return values;
        },
        "Returns the fields as a dict.");
    class_.def(pybind11::pickle(
        [fields](const T& self) {
          pybind11::dict values;
          for (const FieldOf& field : *fields) values[field.name] = field.get(self);
          return values;
        },
        [fields, own, blank](const pybind11::dict& values) {
          T value = blank;
          SetAll(*fields, own, values, &value);
          return value;
        }));
    class_.def("__repr__", [fields, own](const T& self) {
      std::string text = own + "(";
      for (const FieldOf& field : *fields) {
        if (text.back() != '(') text += ", ";
        text += std::string(field.name) + "=" + std::string(pybind11::repr(field.get(self)));
      }
      return text + ")";
    });
  }

  template <class Owner, class Member>
  ValueClass& Field(const char* name, Member Owner::*member, const char* doc) {
    fields_->push_back({name, doc, [member](const T& self) { return pybind11::cast(self.*member); },
                        [member](const pybind11::handle& value, T* self) {
                          if constexpr (std::is_same_v<Member, std::string_view>) {
                            self->*member = Interned(value.cast<std::string>());
                          } else {
                            self->*member = value.cast<Member>();
                          }
                        }});
    class_.def_property_readonly(
        name, [member](const T& self) -> const Member& { return self.*member; },
        pybind11::return_value_policy::reference_internal, doc);
    return *this;
  }

  // A field that is no member: 'get' returns it, 'set' takes it.
  template <class Get, class Set>
  ValueClass& Field(const char* name, Get get, Set set, const char* doc) {
    fields_->push_back({name, doc, [get](const T& self) { return ObjectOf(get(self)); },
                        [set](const pybind11::handle& value, T* self) { set(value, self); }});
    class_.def_property_readonly(name, get, doc);
    return *this;
  }

  // Something that follows from the fields.
  template <class Get>
  ValueClass& Derived(const char* name, Get get, const char* doc) {
    class_.def_property_readonly(name, get, doc);
    return *this;
  }

  // Replaces the text of all fields by what one wants to see.
  ValueClass& Repr(std::function<std::string(const T&)> repr) {
    class_.attr("__repr__") = pybind11::cpp_function(std::move(repr), pybind11::name("__repr__"),
                                                     pybind11::is_method(class_));
    return *this;
  }

  pybind11::class_<T>& py() { return class_; }

 private:
  struct FieldOf {
    const char* name;
    const char* doc;
    std::function<pybind11::object(const T&)> get;
    std::function<void(const pybind11::handle&, T*)> set;
  };

  template <class Value>
  static pybind11::object ObjectOf(Value&& value) {
    if constexpr (std::is_base_of_v<pybind11::object, std::decay_t<Value>>) {
      return std::forward<Value>(value);
    } else {
      return pybind11::cast(std::forward<Value>(value));
    }
  }

  static void SetAll(const std::vector<FieldOf>& fields, const std::string& own,
                     const pybind11::dict& values, T* value) {
    for (const auto& [key, given] : values)
      Set(fields, own, std::string(pybind11::str(key)), given, value);
  }

  static void Set(const std::vector<FieldOf>& fields, const std::string& own,
                  const std::string& key, const pybind11::handle& given, T* value) {
    std::string names;
    for (const FieldOf& field : fields) {
      names += (names.empty() ? "" : ", ") + std::string(field.name);
      if (key != field.name) continue;
      try {
        field.set(given, value);
      } catch (const pybind11::cast_error&) {
        throw pybind11::type_error(own + "." + key + ": got " + std::string(pybind11::repr(given)) +
                                   ", expected: " + field.doc);
      }
      return;
    }
    throw pybind11::type_error(own + " has no field '" + key + "', it has " + names);
  }

  std::shared_ptr<std::vector<FieldOf>> fields_;
  pybind11::class_<T> class_;
};

}  // namespace kestrel::python
