"""The verb `crosscheck`, which compares many results with those of other engines."""

import fnmatch
import os
import shlex
import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, nullcontext
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from ...errors import without_control_characters
from ...parameters import SET_OPS
from ..console import output, status_line
from ..console.output import Output, counted
from ..console.tables import table_text
from ..inputs.files import STREAM, display_name, is_among, is_dropped, refuse_folder
from ..options.campaign import (
    POSES,
    as_bytes,
    as_engines,
    as_keep,
    as_poses,
    as_shard,
)
from ..options.patterns import files_argument
from ..options.shared import SAMPLES, SECONDS, FilePath, Words, basic_options, rare_option, verb

if TYPE_CHECKING:
    from ...campaign.cases.case import Case
    from ...campaign.cases.sources import CaseInputs
    from ...campaign.record import CaseRecord, RunRecord
    from ...campaign.running.pool import RequestHandler

_EPILOG = """\b
Examples:
  bspcsg crosscheck a.stl b.stl
  bspcsg crosscheck parts/ --poses 500 --results r.jsonl --resume --junit j.xml
  bspcsg crosscheck model.csg cases.json --against pymeshlab,openscad
"""

#: The largest number of failures that are printed at the end; the results file has all failures.
_MAX_FAILURES_LISTED = 20

#: The largest number of reasons for refusing operands that are printed.
_MAX_REASONS_LISTED = 3

_FILE = FilePath()


@verb("crosscheck", short_help="Compare many results with other engines'.", epilog=_EPILOG)
@files_argument("CASES...", "paths", also=(".csg",))
@click.option(
    "--op",
    "operations",
    multiple=True,
    type=Words(SET_OPS),
    help="Operation on each pair; may be repeated, by default all four.",
)
@click.option(
    "--poses",
    metavar="N",
    type=click.IntRange(min=1),
    help="Draw this number of pairs, half in random and half in coincident poses.",
)
@rare_option(
    "--pose",
    "pose",
    multiple=True,
    metavar="NAME[:NUMBER]",
    callback=as_poses,
    help=f"Pose of the second of each pair ({', '.join(POSES)}); a number for one draw; may be"
    " repeated.",
)
@rare_option(
    "--seed",
    metavar="N",
    type=click.IntRange(min=0),
    default=0,
    help="Seed of the random draws.",
)
@rare_option(
    "--max-triangles",
    metavar="N",
    type=click.IntRange(min=1),
    help="Leave larger files out; files that are no solids are left out of --poses too.",
)
@rare_option("--only", metavar="PATTERN", help="Only cases whose names match, as in '*-union'.")
@click.option(
    "--against",
    metavar="ENGINES",
    callback=as_engines,
    help="Ask these in every case besides manifold3d: pymeshlab, openscad. By default they are"
    " asked where manifold3d disagrees or has no answer, and openscad about scripts.",
)
@click.option(
    "--results", metavar="FILE", type=_FILE, help="JSON lines to append each finished case to."
)
@click.option("--junit", metavar="FILE", type=_FILE, help="JUnit XML to write at the end.")
@rare_option("--markdown", metavar="FILE", type=_FILE, help="Markdown summary to write at the end.")
@click.option(
    "-j",
    "--jobs",
    metavar="N",
    type=click.IntRange(0, 1024),
    default=0,
    help="Cases at once; 0 for all cores.",
)
@click.option(
    "--timeout",
    metavar="SECONDS",
    type=SECONDS,
    default=300.0,
    show_default=True,
    help="Seconds for a case, after which its process is killed.",
)
@rare_option(
    "--memory",
    metavar="SIZE",
    default="4G",
    show_default=True,
    callback=as_bytes,
    help="Memory for a case; 0 for no limit.",
)
@rare_option("--shard", metavar="I/N", callback=as_shard, help="Only the I-th of N parts.")
@click.option("--resume", is_flag=True, help="Leave out what the results file has already.")
@rare_option(
    "--retry-crashed",
    "retry",
    is_flag=True,
    help="With --resume, run again what crashed, as where a worker was lost for want of memory.",
)
@rare_option(
    "--fail-fast/--keep-going", default=False, help="Stop at the first failure, or go on (default)."
)
@rare_option(
    "--keep-meshes",
    "keep",
    metavar="WHICH",
    default="interesting",
    callback=as_keep,
    help="Cases whose meshes are stored beside the results: interesting (default), all, none, or a"
    " number of further ones.",
)
@rare_option(
    "--samples",
    metavar="N",
    type=SAMPLES,
    default=500,
    show_default=True,
    help="Points to measure distances from; 0 for none.",
)
@rare_option(
    "--scheduler",
    metavar="ADDRESS|FILE",
    help="Run on the workers of this Dask scheduler, which see the same files.",
)
@basic_options
def crosscheck(paths: tuple[Path, ...], **given: Any) -> int:
    """Compare results with manifold3d's, as exact sets, and with other engines' in doubtful cases.

    CASES are mesh files (every pair of them), folders (every pair of meshes in them, and their
    .csg scripts), scripts (.csg, .scad) and .json files of cases. Each case runs in a process of
    its own, which is killed if it exceeds a limit. The exit code is 1 if an engine disagrees with
    bspcsg, a result of bspcsg fails a check of its own, or a case was killed or crashed.
    """
    return _Campaign(paths, given).run()


class _Campaign:
    """The work of the verb `crosscheck`: it collects cases, runs them and writes reports."""

    def __init__(self, paths: tuple[Path, ...], settings: dict[str, Any]) -> None:
        self._paths, self._settings = paths, settings
        self._out = Output.of(settings)
        if settings["resume"] and settings["results"] is None:
            raise click.UsageError(
                "--resume needs the results file to continue, such as --results r.jsonl."
            )
        if settings["retry"] and not settings["resume"]:
            raise click.UsageError("--retry-crashed can only be used with --resume.")
        if settings["poses"] and any(number is not None for _, number in settings["pose"]):
            raise click.UsageError(
                "--poses draws many random poses and cannot be combined with --pose NAME:NUMBER,"
                " which is one of them; leave one out."
            )

    def run(self) -> int:
        from ...campaign.judging.opinions import require
        from ...campaign.record import is_failure

        self._refuse_early()
        require(self._settings["against"])
        answering = self._answering()
        cases = self._cases(answering)
        header = self._header()
        records = self._records(cases, answering, header)
        self._write_reports(records, header)
        self._tell(records)
        return output.FOUND if any(map(is_failure, records)) else output.DONE

    def _refuse_early(self) -> None:
        written: dict[Path, str] = {}
        for name in ("results", "junit", "markdown"):
            path: Path | None = self._settings[name]
            if path is None:
                continue
            if str(path) == STREAM:
                raise click.UsageError(f"--{name} needs the name of a file, not “-”.")
            refuse_folder(path)
            if is_among(path, self._paths):
                raise click.UsageError(
                    f"--{name} would overwrite the input {path}; choose another name."
                )
            other = written.setdefault(path.resolve(), name)
            if other != name and not is_dropped(path):
                raise click.UsageError(
                    f"--{name} would overwrite {path}, which --{other} also writes; choose"
                    " different names."
                )
        if Path(STREAM) in self._paths:
            raise click.UsageError(
                "crosscheck cannot read standard input; give the names of files."
            )

    def _answering(self) -> "RequestHandler":
        from ...campaign.running.cluster import Cluster
        from ...campaign.running.pool import LocalPool
        from ...campaign.running.runner import greeting

        cores = os.cpu_count() or 1
        jobs = self._settings["jobs"] or cores
        settings = self._case_settings()
        scheduler = self._settings["scheduler"]
        if scheduler is not None:
            return Cluster(scheduler, greeting(settings, self._settings["memory"], 1))
        told = greeting(settings, self._settings["memory"], max(1, cores // jobs))
        return LocalPool(jobs, told)

    def _case_settings(self) -> Any:
        from ...campaign.judging.evaluation import EvaluationSettings

        results, keep = self._settings["results"], self._settings["keep"]
        folder = None if results is None or keep == "none" else results.with_suffix(".meshes")
        return EvaluationSettings(
            against=self._settings["against"],
            samples=self._settings["samples"],
            timeout=self._settings["timeout"],
            meshes=None if folder is None else str(folder.absolute()),
            relative="" if folder is None else folder.name,
        )

    def _cases(self, answering: "RequestHandler") -> "list[Case]":
        from ...campaign.cases.sources import PairSelection, cases_of, inputs_in

        count, seed = self._settings["poses"] or 0, self._settings["seed"]
        asked = self._settings["pose"] or [(None, None)]
        draws = [PairSelection(count, seed, pose, number) for pose, number in asked]
        inputs = self._usable(inputs_in(self._paths), answering)
        operations = self._settings["operations"] or SET_OPS
        cases = cases_of(inputs, tuple(dict.fromkeys(operations)), *draws)
        if not cases:
            raise click.UsageError(
                "there is nothing to compare; give at least two mesh files, a folder of them, a"
                " script, or a file of cases."
            )
        if self._settings["only"] is not None:
            cases = [one for one in cases if fnmatch.fnmatchcase(one.name, self._settings["only"])]
            if not cases:
                raise click.UsageError(f"no case has a name that matches {self._settings['only']}.")
        if self._settings["shard"] is not None:
            number, count = self._settings["shard"]
            cases = cases[number - 1 :: count]
        return cases

    def _usable(self, inputs: "CaseInputs", answering: "RequestHandler") -> "CaseInputs":
        """Drop meshes with too many triangles, and meshes that are no solids.

        Without ``--max-triangles`` and ``--poses``, all inputs are returned unread.
        """
        from dataclasses import replace

        from ...campaign.running.runner import survey

        most = self._settings["max_triangles"]
        if not inputs.meshes or (most is None and not self._settings["poses"]):
            return inputs
        found = survey(inputs.meshes, answering, self._settings["timeout"])
        bad = [path for path in inputs.meshes if found[path]["refused"]]
        large = [path for path in inputs.meshes if most and found[path]["triangles"] > most]
        for path in bad:
            self._out.detail(f"{display_name(path)}: left out: {found[path]['refused']}")
        if bad:
            words = (
                "file left out because it is not a solid"
                if len(bad) == 1
                else ("files left out because they are not solids")
            )
            self._out.note(f"{len(bad)} {words}")
        if large:
            self._out.note(
                f"{counted(len(large), 'file')} left out because of more than {most} triangles"
            )
        out = {*bad, *large}
        return replace(inputs, meshes=tuple(path for path in inputs.meshes if path not in out))

    def _header(self) -> "RunRecord":
        from ...campaign.running.runner import run_record

        arguments = click.get_current_context().find_root().obj
        return run_record(shlex.join(["bspcsg", *arguments]), self._settings["seed"])

    def _records(
        self, cases: "Sequence[Case]", answering: "RequestHandler", header: "RunRecord"
    ) -> "list[CaseRecord]":
        from ...campaign.record import Journal, read_results
        from ...campaign.running.runner import CampaignPlan, run_cases

        results, resume = self._settings["results"], self._settings["resume"]
        known = read_results([results]).cases if resume and results.exists() else {}
        if self._settings["retry"]:
            known = {key: case for key, case in known.items() if case["verdict"] != "crash"}
        plan = CampaignPlan(
            cases,
            known,
            self._settings["timeout"],
            self._settings["keep"],
            self._settings["fail_fast"],
        )
        done = len(cases) - len(plan.open_cases)
        if done:
            self._out.note(
                f"{counted(done, 'case')} of {len(cases)} already finished in"
                f" {display_name(results)}"
            )
        with Journal(results) if results else nullcontext() as journal:
            if journal is not None:
                journal.append(header)
            with self._progress(len(plan.open_cases)) as notice:
                return run_cases(plan, answering, journal, notice)

    @contextmanager
    def _progress(self, count: int) -> "Iterator[Callable[[CaseRecord], None]]":
        """Yield a function to call with each record: it moves a progress bar or prints a line."""
        if not sys.stderr.isatty() or self._out.verbosity < 0:
            yield lambda record: self._out.detail(_line(record))
            return
        from rich.console import Console
        from rich.progress import (
            BarColumn,
            MofNCompleteColumn,
            Progress,
            TimeElapsedColumn,
            TimeRemainingColumn,
        )

        from ...campaign.record import is_failure

        status_line.end()
        times = TimeElapsedColumn(), TimeRemainingColumn()
        columns = ("comparing", BarColumn(), MofNCompleteColumn(), *times)
        with Progress(*columns, console=Console(stderr=True), transient=True) as bar:
            task = bar.add_task("", total=count)

            def notice(record: "CaseRecord") -> None:
                bar.advance(task)
                if is_failure(record) or self._out.verbosity > 0:
                    bar.console.print(
                        without_control_characters(_line(record)),
                        markup=False,
                        emoji=False,
                        highlight=False,
                    )

            yield notice

    def _write_reports(self, records: "Sequence[CaseRecord]", header: "RunRecord") -> None:
        from ...formats.atomic import write_file
        from ...report.junit import junit_text
        from ...report.markdown import markdown_text

        for name, writer in (("junit", junit_text), ("markdown", markdown_text)):
            path = self._settings[name]
            if path is not None:
                # Case names need not be valid Unicode.
                write_file(path, [writer(records, [header]).encode("utf-8", "replace")])

    def _tell(self, records: "Sequence[CaseRecord]") -> None:
        from ...campaign.summary import summary_of

        document = summary_of(records) if self._out.as_json else {}
        self._tell_refused(records)
        self._out.result("" if self._out.as_json else self._text(records), document)

    def _tell_refused(self, records: "Sequence[CaseRecord]") -> None:
        """Print the reasons why cases were refused, each reason once."""
        refused = [record["reason"] for record in records if record["verdict"] == "refused"]
        reasons = list(dict.fromkeys(refused))
        for reason in reasons[:_MAX_REASONS_LISTED]:
            self._out.note(f"refused: {reason.rstrip('.')}.")
        if len(reasons) > _MAX_REASONS_LISTED:
            self._out.note(
                f"operands were refused for {len(reasons)} different reasons in all; -v prints"
                " every one"
            )

    def _text(self, records: "Sequence[CaseRecord]") -> str:
        from ...campaign.record import is_failure
        from ...campaign.summary import conclusion, counts_by_verdict

        counts = counts_by_verdict(records)
        rows = [(verdict, str(count)) for verdict, count in counts.items()]
        lines = [table_text(("verdict", "cases"), rows, right=("cases",))] if rows else []
        failures = [record for record in records if is_failure(record)]
        lines += [_failure(record) for record in failures[:_MAX_FAILURES_LISTED]]
        if len(failures) > _MAX_FAILURES_LISTED:
            lines.append(f"and {len(failures) - _MAX_FAILURES_LISTED} more")
        return "\n".join([*lines, conclusion(records)])


def _line(record: "CaseRecord") -> str:
    reason = f": {record['reason']}" if record["reason"] else ""
    return f"{record['case']}  {record['verdict']}{reason}  {record['seconds']['total']:.2f} s"


def _failure(record: "CaseRecord") -> str:
    reason = f": {record['reason']}" if record["reason"] else ""
    return f"{record['verdict']}  {record['case']}{reason}\n  Again: {record['command']}"
