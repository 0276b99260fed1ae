# SPDX-License-Identifier: BSD-3-Clause
"""The study that a report is of: its variants, in order, and how they compare."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import yaml  # type: ignore[import]

from .comparison import Comparison, compare_variants
from .gates import Gate, parse_gates
from .results import Results, ResultsError, Variant

PLAN = "study.yaml"  # of the run, beside its results


@dataclass
class Study:
    """The data of a report."""

    results: Results
    variants: list[Variant]
    comparisons: list[Comparison]
    gates: list[Gate]
    seed: int

    def name(self, variant: Variant) -> str:
        """The configuration, with what tells it from others of the same name."""
        same = [one for one in self.variants if one.configuration == variant.configuration]
        return variant.configuration if len(same) < 2 else \
            f"{variant.configuration} ({variant.version})"


def read_study(folder: str, before: str | None = None, after: str | None = None,
               against: str | None = None, gates: list[str] | None = None, seed: int = 1) -> Study:
    """Reads the results in a folder and compares them.

    before, after: configurations, or CONFIGURATION@VERSION; by default the first of the plan, and
    all others. against: folder of the study that `before` is taken from. gates: besides those of
    the plan. Raises ResultsError or GateError.
    """
    results = Results(folder)
    plan = _plan(results.folder / PLAN)
    all_gates = parse_gates(plan.get("gates") or []) + parse_gates(gates or [])
    variants = _variants(results)
    old = Results(against) if against else results
    old_variants = _variants(old)
    first = _choose(old_variants, before, old) if before else old_variants[0]
    others = [_choose(variants, after, results)] if after else \
        [one for one in variants if against or one != first] or [first]
    comparisons = [compare_variants((old, first), (results, one), seed, len(others))
                   for one in others]
    return Study(results, variants, comparisons, all_gates, seed)


def _plan(path: Path) -> dict[str, Any]:
    if not path.is_file():
        return {}
    try:
        plan = yaml.safe_load(path.read_text())
    except yaml.YAMLError as error:
        raise ResultsError(f"{path}: no YAML: {getattr(error, 'problem', error)}") from None
    return plan if isinstance(plan, dict) else {}


def _variants(results: Results) -> list[Variant]:
    variants = results.variants()
    if not variants:
        raise ResultsError(f"{results.folder}: no results yet")
    return variants


def _choose(variants: list[Variant], name: str, results: Results) -> Variant:
    for variant in variants:
        if name in (variant.configuration, f"{variant.configuration}@{variant.version}"):
            return variant
    known = ", ".join(f"'{one.configuration}'" for one in variants)
    raise ResultsError(f"{results.folder}: no configuration '{name}', expected {known}")
