# SPDX-License-Identifier: BSD-3-Clause
"""`kestrel study report DIR`: what the results of a study show."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path

from . import plots
from .gates import GateError, Outcome, check
from .pages import Page, to_html, to_markdown
from .reported_study import Study, read_study
from .results import ResultsError, Variant
from .sections import disturbance_effects, sections, suffixes, values_of
from .statistics import Effect
from .verdict import verdict

_MET, _NOT_MET = 0, 1


def main(arguments: Sequence[str]) -> int:
    """Runs the command. Returns its exit status: 1 where a gate is not met or the input is at
    fault."""
    given = _parser().parse_args(arguments)
    folder = Path(given.output or Path(given.folder) / "report")
    try:
        study = read_study(given.folder, given.before, given.after, given.against, given.gate,
                           given.seed)
        outcomes = [check(gate, comparison, _failed(study, comparison.after))
                    for comparison in study.comparisons for gate in study.gates]
        page = _write(study, outcomes, folder)
    except (ResultsError, GateError) as error:
        print(f"kestrel: {error}", file=sys.stderr)
        return _NOT_MET
    except OSError as error:
        print(f"kestrel: {error.filename}: {error.strerror}", file=sys.stderr)
        return _NOT_MET
    print(page.verdict)
    for note in page.notes:
        print(f"  {note}")
    print(f"  {folder / 'report.html'}, report.md, tables as CSV")
    return _MET if all(outcome.is_met for outcome in outcomes) else _NOT_MET


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="kestrel study report", description="What the results of a study show: a verdict, "
        "tables and pictures, as report.html, report.md and CSV.")
    parser.add_argument("folder", metavar="DIR", help="folder of `kestrel study run`")
    parser.add_argument("--before", metavar="NAME", help="configuration (or NAME@VERSION) that the "
                        "others are compared with (default: the first of study.yaml)")
    parser.add_argument("--after", metavar="NAME", help="the one to compare (default: all others)")
    parser.add_argument("--against", metavar="DIR", help="take 'before' from this study, as that "
                        "of last week")
    parser.add_argument("--output", metavar="DIR", help="default: DIR/report")
    parser.add_argument("--gate", action="append", default=[], metavar="TEXT",
                        help="a gate besides those of study.yaml, as 'found >= 0.95'")
    parser.add_argument("--seed", type=int, default=1, help="of the resampling (default 1)")
    return parser


def _failed(study: Study, variant: Variant) -> int:
    return sum(one.variant == variant for one in study.results.failures())


def _page(study: Study, outcomes: list[Outcome], effects: dict[str, list[Effect]]) -> Page:
    verdicts = [verdict(study, one) for one in study.comparisons]
    tones = {tone for tone, _ in verdicts}
    tone = "worse" if "worse" in tones or not all(one.is_met for one in outcomes) else \
        "better" if "better" in tones else ""
    notes = [text for _, text in verdicts[1:]]
    notes += [f"gate '{one.text}': {'met' if one.is_met else 'NOT met'} ({one.said})"
              for one in outcomes]
    failed = len(study.results.failures())
    if failed:
        notes.append(f"{failed} units failed: they are in no number here")
    title = f"Study: {study.results.folder.resolve().name}"
    return Page(title, verdicts[0][1], tone, notes, sections(study, effects))


def _write(study: Study, outcomes: list[Outcome], folder: Path) -> Page:
    """Writes the report's files and returns its page."""
    effects = disturbance_effects(study)
    page = _page(study, outcomes, effects)
    folder.mkdir(parents=True, exist_ok=True)
    for section in page.sections:
        if section.picture:  # of a report before
            (folder / section.picture).unlink(missing_ok=True)
    try:
        _draw(study, effects, folder)
    except ImportError:
        page.notes.append("no pictures: they need python3-matplotlib")
    for section in page.sections:
        if section.picture and not (folder / section.picture).exists():
            section.picture = ""
    (folder / "report.md").write_text(to_markdown(page))
    (folder / "report.html").write_text(to_html(page))
    for table in page.tables():
        (folder / f"{table.name}.csv").write_text(table.to_csv())
    return page


def _draw(study: Study, effects: dict[str, list[Effect]], folder: Path) -> None:
    plots.plot_rates({study.name(variant): values_of(study, variant, ["found"])
                      for variant in study.variants}, folder / "found.png")
    for comparison, suffix in zip(study.comparisons, suffixes(study)):
        if not comparison.is_single:
            plots.plot_changes(comparison.changes, folder / f"changes{suffix}.png")
    plots.plot_effects(effects, folder / "disturbances.png")
