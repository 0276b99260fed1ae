# SPDX-License-Identifier: BSD-3-Clause
"""The configurations that a study compares: options from a file, values of single options, grids of
them, and other builds of the command."""
import itertools
import os
from dataclasses import dataclass

import yaml

from .commands import find_command, output_of, version_of
from .errors import StudyError
from .mappings import take

_KEYS = {"name": str, "config": str, "set": dict, "command": str}


@dataclass
class Configuration:
    """A configuration, complete: a worker needs no file of it."""

    name: str
    command: str  # path of `kestrel`
    version: str
    text: str  # every option of the command, as YAML


def _text(value):
    """Returns an option's value as `--set` reads it."""
    if isinstance(value, bool):
        return "true" if value else "false"
    return str(value)


def settings_of(values):
    """Returns the words `--set key=value` for a mapping."""
    return [word for key, value in values.items() for word in ("--set", f"{key}={_text(value)}")]


def _grid(values):
    """Yields (what differs, {key: value}) for all combinations of the values that are lists."""
    choices = [[(key, one) for one in (value if isinstance(value, list) else [value])]
               for key, value in values.items()]
    varied = [key for key, value in values.items() if isinstance(value, list)]
    for combination in itertools.product(*choices):
        chosen = dict(combination)
        yield ", ".join(f"{key}={_text(chosen[key])}" for key in varied), chosen


def _complete(entry, values, command, print_command, base):
    """Returns all options of a configuration as the command prints them, which checks them, too."""
    words = list(print_command)
    if "config" in entry:
        words += ["--config", os.path.join(base, os.path.expanduser(entry["config"]))]
    return output_of(command, *words, *settings_of(values))


def _expand(entry, where, context):
    entry = take(entry, where, _KEYS, required=("name",))
    command = find_command(os.path.expanduser(entry.get("command", context["command"])))
    for differs, values in _grid({**entry.get("set", {}), **context["settings"]}):
        name = f"{entry['name']} {differs}".strip()
        try:
            text = _complete(entry, values, command, context["print_command"], context["base"])
        except StudyError as error:
            raise StudyError(f"{where} '{name}': {error}") from None
        yield Configuration(name, command, version_of(command), text)


def read_configurations(entries, context):
    """Returns the configurations of a study, each complete and checked by its own command.

    context: {"command": the default, "settings": values for all, "print_command": words by which
    the command prints its options, "base": folder that relative paths are seen from}. Raises
    StudyError that names the configuration and the key.
    """
    found = {}
    for number, entry in enumerate(entries or [{"name": "default"}], 1):
        for configuration in _expand(entry, f"configurations {number}", context):
            if configuration.name in found:
                raise StudyError(f"configurations {number}: a second '{configuration.name}'")
            found[configuration.name] = configuration
    return list(found.values())


def parse_setting(text):
    """Returns (key, value) of an argument `key=value`; the value may be a list: a grid."""
    key, equals, value = text.partition("=")
    if not equals or not key:
        raise StudyError(f"--set {text}: expected key=value")
    return key, yaml.safe_load(value)
