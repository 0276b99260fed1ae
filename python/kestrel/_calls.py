# SPDX-License-Identifier: BSD-3-Clause
"""One line for a call with wrong arguments, in place of pybind11's list of signatures."""

from __future__ import annotations

import enum
import functools
import inspect
import os
import re
from collections.abc import Callable, Mapping, Sequence
from typing import Any

from . import _kestrel

_SIGNATURE = re.compile(r"^ +\d+\. [\w.]*\((.*)\)(?: -> [^)]*)?$", re.MULTILINE)
_LONGEST_VALUE = 40

# Whether a value may be one of a type of pybind11's signatures. A type that is not here takes all.
_IS: Mapping[str, Callable[[Any], bool]] = {
    "None": lambda value: value is None,
    "int": lambda value: hasattr(value, "__index__"),
    "float": lambda value: hasattr(value, "__index__") or hasattr(value, "__float__"),
    "str": lambda value: isinstance(value, (str, bytes)),
    "bytes": lambda value: isinstance(value, bytes),
    "function": callable,
    "os.PathLike": lambda value: isinstance(value, (str, bytes, os.PathLike)),
    "numpy.ndarray": lambda value: value is not None and not isinstance(value, (str, bytes)),
}


def with_clear_errors(value: Any) -> Any:
    """Returns a bound function whose TypeError is one line, or a class with such methods."""
    if not inspect.isclass(value):
        return _with_clear_errors(value, value.__name__, is_method=False)
    if issubclass(value, enum.Enum):
        return value
    for name, member in list(vars(value).items()):
        full_name = value.__name__ + ("" if name == "__init__" else f".{name}")
        if isinstance(member, staticmethod):
            function = _with_clear_errors(member.__func__, full_name, is_method=False)
            setattr(value, name, staticmethod(function))
        elif inspect.isroutine(member) and isinstance(member.__doc__, str):
            setattr(value, name, _with_clear_errors(member, full_name, is_method=True))
    return value


def _with_clear_errors(function: Callable[..., Any], name: str,
                       is_method: bool) -> Callable[..., Any]:
    @functools.wraps(function)
    def call(*args: Any, **kwargs: Any) -> Any:
        try:
            return function(*args, **kwargs)
        except TypeError as error:
            signatures = _signatures(str(error))
            if not signatures:
                raise
            given = args[1:] if is_method else args
            line = f"{name}: {_complaint(signatures, given, kwargs)}"
        raise TypeError(line)

    call.__qualname__ = name
    call.__doc__ = (function.__doc__ or "").replace("kestrel._kestrel.", "kestrel.")
    return call


def _signatures(message: str) -> list[list[str]]:
    """Returns the arguments of each signature in a message of pybind11."""
    if " incompatible " not in message:
        return []
    listed = message.partition("\n\nInvoked with: ")[0]
    return [[each for each in split(arguments) if not each.startswith("self: ")]
            for arguments in _SIGNATURE.findall(listed)]


def _complaint(signatures: Sequence[Sequence[str]], args: Sequence[Any],
               kwargs: Mapping[str, Any]) -> str:
    found = [_mismatch(signature, args, kwargs) for signature in signatures]
    what = found[0][0]
    expected = dict.fromkeys(kind for each, kind in found if each == what)
    return f"{what}, expected {_one_of(list(expected))}"


def _mismatch(signature: Sequence[str], args: Sequence[Any],
              kwargs: Mapping[str, Any]) -> tuple[str, str]:
    """Returns what is wrong with arguments by a signature, and what it expects."""
    kinds, required = _parameters(signature)
    by_position = list(kinds)[:signature.index("*")] if "*" in signature else list(kinds)
    names = ", ".join(kinds)
    if len(args) > len(by_position):
        some = f"{len(by_position)} at most ({', '.join(by_position)})" if by_position else "none"
        return f"got {len(args)} by position", some
    given = {**dict(zip(by_position, args)), **kwargs}
    for name in given:
        if name not in kinds and "**kwargs" not in signature:
            return f"has no argument '{name}'", names or "none"
    for name in required:
        if name not in given:
            return f"'{name}' is missing", _in_words(kinds[name])
    for name, value in given.items():
        if name in kinds and not _may_be(kinds[name], value):
            return f"'{name}' is {_described(value)}", _in_words(kinds[name])
    return f"got ({', '.join(map(_described, args))})", f"({_in_words(', '.join(signature))})"


def _parameters(signature: Sequence[str]) -> tuple[dict[str, str], list[str]]:
    """Returns the types of named arguments, and the names of those without a default."""
    kinds, required = {}, []
    for argument in signature:
        name, colon, rest = argument.partition(": ")
        if colon:
            kind, _, default = rest.partition(" = ")
            takes_none = default == "None" and not kind.startswith("Optional[")
            kinds[name] = f"Optional[{kind}]" if takes_none else kind
            required += [] if default else [name]
    return kinds, required


def _may_be(kind: str, value: Any) -> bool:
    union = re.fullmatch(r"(Optional|Union)\[(.*)\]", kind)
    if union:
        some = split(union.group(2)) + ["None"] * (union.group(1) == "Optional")
        return any(_may_be(each, value) for each in some)
    items = re.fullmatch(r"List\[(.*)\]", kind)
    if items:
        is_list = isinstance(value, Sequence) and not isinstance(value, (str, bytes))
        return is_list and all(_may_be(items.group(1), each) for each in value)
    test = _IS.get(kind.partition("[")[0])
    if test:
        return test(value)
    bound = getattr(_kestrel, kind.rpartition(".")[2], None)
    if isinstance(bound, enum.EnumMeta):
        return value in list(bound)
    return not inspect.isclass(bound) or isinstance(value, bound)


def _in_words(kinds: str) -> str:
    words = re.sub(r": (?:object|handle)\b", "", kinds)
    words = re.sub(r"\b(?:object|handle)\b", "a value", words)
    words = re.sub(r"\b(?:kestrel|_kestrel|numpy|os)\.", "", words)
    words = re.sub(r"Union\[(.*?)\]", lambda union: _one_of(split(union.group(1))), words)
    return re.sub(r"^Optional\[(.*)\]$", r"\1 or None", words)


def _one_of(names: Sequence[str]) -> str:
    return " or ".join([", ".join(names[:-1])] * (len(names) > 1) + list(names[-1:]))


def _described(value: Any) -> str:
    if hasattr(value, "shape"):
        return f"{type(value).__name__} of shape {value.shape}"
    text = repr(value)
    return text if len(text) <= _LONGEST_VALUE and "\n" not in text else type(value).__name__


def split(arguments: str) -> list[str]:
    """Splits a list of arguments at the commas that are in no brackets."""
    parts, depth = [""], 0
    for letter in arguments:
        depth += (letter in "[({<") - (letter in "])}>")
        if letter == "," and depth == 0:
            parts.append("")
        else:
            parts[-1] += letter
    return [part.strip() for part in parts if part.strip()]
