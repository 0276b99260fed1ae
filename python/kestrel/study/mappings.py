# SPDX-License-Identifier: BSD-3-Clause
"""Checks of what YAML files hold."""
import difflib

from .errors import StudyError

_WORDS = {str: "a text", int: "a whole number", float: "a number", list: "a list",
          dict: "keys with values", bool: "true or false"}


def _fits(value, kind):
    if kind is float:
        return isinstance(value, (int, float)) and not isinstance(value, bool)
    return isinstance(value, kind) and (kind is bool or not isinstance(value, bool))


def take(mapping, where, kinds, required=()):
    """Returns a mapping of which every key is known and every value of its kind.

    kinds: {key: kind or tuple of kinds}. Raises StudyError that names the key and what was
    expected.
    """
    if not isinstance(mapping, dict):
        raise StudyError(f"{where}: expected keys with values")
    for key, value in mapping.items():
        if key not in kinds:
            near = difflib.get_close_matches(str(key), kinds, 1)
            hint = f"did you mean '{near[0]}'?" if near else f"expected some of {', '.join(kinds)}"
            raise StudyError(f"{where}: no key '{key}'; {hint}")
        kind = kinds[key] if isinstance(kinds[key], tuple) else (kinds[key],)
        if not any(_fits(value, one) for one in kind):
            expected = " or ".join(_WORDS[one] for one in kind)
            raise StudyError(f"{where}: {key}: {value!r}, expected {expected}")
    for key in required:
        if key not in mapping:
            raise StudyError(f"{where}: '{key}' is missing")
    return mapping
