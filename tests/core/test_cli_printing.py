"""What commands print and end with: in this process, with the work that they start replaced by its result."""

from __future__ import annotations

import sys
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import click
import pytest
from click.testing import CliRunner, Result
from loops import for_each

from pyfrc_cli import create_physics, fuzz, migrate, project_options, robot_options, shared_options, start, wrapping
from pyfrc_cli.file_options import ReadPath, WrittenDirectory, WrittenFile, check_outputs
from pyfrc_cli.main import cli
from pyfrc_cli.verbosity import Verbosity
from pyfrc_core.errors import PyfrcError, UsageError
from pyfrc_core.fuzz.campaign.results import CampaignProgress
from pyfrc_core.project import Project
from pyfrc_core.sync.lock import Lock, LockedFile, changes


@pytest.fixture
def project(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Project:
    (tmp_path / "robot.py").write_text("")
    monkeypatch.chdir(tmp_path)
    return Project(tmp_path / "robot.py")


def run(*words: str) -> Result:
    return CliRunner().invoke(cli, words, obj=Verbosity())


def printed(call: Callable[[], object], quiet: bool = False) -> str:
    """What a function prints within a command."""

    @click.command()
    def command() -> None:
        call()

    result = CliRunner().invoke(command, [], obj=Verbosity(quiet=quiet), catch_exceptions=False)
    return result.stdout


# -- fuzz --------------------------------------------------------------------------------------------------------------


def finding(**changed: Any) -> Any:
    entry = SimpleNamespace(display_path="tests/fuzz/a.jsonl", file=Path("tests/fuzz/a.jsonl"))
    failure = SimpleNamespace(text="robot.py:3: ValueError: x\nmore", place="robot.py:3")
    story = ("0.10 s: press A", "0.20 s: it fails")
    same = {"failure": failure, "story": story, "entry": entry, "repeats": True, "known": False, "runs": 7, "writes": 1}
    return SimpleNamespace(**{**same, "fails_at": None, **changed})


@pytest.fixture
def campaign(project: Project, monkeypatch: pytest.MonkeyPatch) -> SimpleNamespace:
    """The result of the next campaign; `options` and `executor` are what it was started with."""
    from pyfrc_core.fuzz.campaign import campaign as module

    progress = CampaignProgress(100, 360.0, 0.5, 0, "shrinking", 0.02)
    result = SimpleNamespace(progress=progress, findings=[], unrepeatable=(), problem="", always_fails=0)
    result.hints = SimpleNamespace(texts=list, unsteady=False)
    result.interrupted = False

    def run_campaign(executor: object, options: object, printer: Any) -> object:
        result.options, result.executor = options, executor
        for each in result.findings:
            printer.on_found(each)
        return result

    monkeypatch.setattr(module, "run_campaign", run_campaign)
    monkeypatch.setattr(fuzz, "_open_executor", lambda *chosen: chosen)
    monkeypatch.delenv("GITHUB_ACTIONS", raising=False)
    return result


def test_a_campaign_without_a_finding(campaign: SimpleNamespace) -> None:
    result = run("fuzz")
    assert (result.exit_code, result.stdout.splitlines()) == (
        0,
        [
            "100 matches, 0.10 h of robot time, 50% of the robot's lines, 0 failures",
            "A match of 30 s takes about 0.6 s here.",
            "Nothing was found.",
        ],
    )
    options = campaign.options
    assert (options.seed, options.runs, options.seconds, options.resume) == (0, None, 60.0, True)
    assert (options.shard.number, options.shard.count) == (1, 1)
    campaign.progress = CampaignProgress(1, crashes=1)
    campaign.hints = SimpleNamespace(texts=lambda: ["slow"], unsteady=True)
    campaign.problem, campaign.always_fails = "The disk is full.", 3
    result = run("fuzz", "--runs", "1", "-j", "3", "--shard", "2/4")
    assert (result.exit_code, result.stdout.splitlines()) == (
        0,
        [
            "1 match, 0.00 h of robot time, 1 failure",
            "hint: slow",
            "The robot failed in the same way at each of 3 starts: the campaign ends until this is repaired.",
            "No failure that repeats was found.",
            "But 1 match proves little: pyfrc fuzz --time 600 plays for ten minutes.",
        ],
    )
    assert result.stderr == "The scripts are in a temporary directory: copy them. The disk is full.\n"
    assert (campaign.options.runs, campaign.options.seconds, campaign.options.resume) == (1, None, False)
    assert (campaign.options.jobs, campaign.executor[1:]) == (3, (3, None))
    assert (campaign.options.shard.number, campaign.options.shard.count) == (2, 4)
    campaign.interrupted = True
    assert run("-q", "fuzz", "--seed", "5").stdout.splitlines() == [
        "The robot failed in the same way at each of 3 starts: the campaign ends until this is repaired.",
        "interrupted",
    ]
    assert (campaign.options.seed, campaign.options.resume, campaign.options.seconds) == (5, False, 60.0)
    assert run("fuzz", "--seed", "5", "--continue").exit_code == 0
    assert campaign.options.resume


def test_findings_of_a_campaign(campaign: SimpleNamespace, monkeypatch: pytest.MonkeyPatch) -> None:
    campaign.findings = [finding(fails_at=3.0), finding(known=True), finding(repeats=False)]
    result = run("fuzz")
    text, replays = "robot.py:3: ValueError: x\nmore\n", "  pyfrc replay tests/fuzz/a.jsonl\n"
    shown = [
        f"{text}  0.10 s: press A\n  fails at 3.00 s\n  1 write, 7 runs of the robot to find them\n{replays}",
        f"{text}  still fails: tests/fuzz/a.jsonl\n",
        f"{text}  0.10 s: press A\n"
        f"  This failure did not repeat in a replay. The script of the whole match is saved:\n{replays}",
    ]
    assert result.exit_code == 1
    assert result.stdout.partition("100 matches")[0] == "".join(shown)
    assert "Nothing was found." not in result.stdout
    assert run("-q", "fuzz").stdout == "".join(shown).replace("  1 write, 7 runs of the robot to find them\n", "")
    monkeypatch.setenv("GITHUB_ACTIONS", "true")
    monkeypatch.setenv("GITHUB_WORKSPACE", str(Path.cwd().parent))
    campaign.findings = [finding(known=True)]
    (line,) = (line for line in run("fuzz").stdout.splitlines() if line.startswith("::"))
    where = f"file={Path.cwd().name}/robot.py,line=3,"
    story = "0.10 s: press A%0A0.20 s: it fails%0Apyfrc replay tests/fuzz/a.jsonl"
    assert line == f"::error {where}title=pyfrc fuzz::{story}"
    assert fuzz._escaped("50 %: a,b\r\n") == "50 %25: a,b%0D%0A"
    assert fuzz._escaped("50 %: a,b\r\n", in_property=True) == "50 %25%3A a%2Cb%0D%0A"


@for_each(
    "words, complaint",
    [
        ("--time 1 --runs 1", "--time and --runs are mutually exclusive."),
        ("--scheduler tcp://a -j 1", "--scheduler and -j are mutually exclusive."),
        ("--continue --from robot.py", "--continue and --from are mutually exclusive."),
        ("--pages a --merge b", "--pages and --merge are mutually exclusive."),
        ("--merge", "--merge and DIRECTORIES belong together."),
        ("a", "Got unexpected extra argument (a)"),
        ("a b", "Got unexpected extra arguments (a b)"),
        ("--merge none", "there is no directory none"),
        *((f"--shard {each}", f"'{each}' is not I/N with I from 1 to N") for each in ("1", "0/2", "3/2", "a/2", "1/b")),
    ],
)
def test_options_of_a_campaign_that_are_wrong(words: str, complaint: str, campaign: SimpleNamespace) -> None:
    result = run("fuzz", *words.split())
    assert result.exit_code == 2
    assert complaint in str(result.exception) + " ".join(result.stderr.split())
    assert not hasattr(campaign, "options")


@pytest.mark.parametrize("on_terminal", [True, False])
def test_progress_of_a_campaign_comes_now_and_then(
    on_terminal: bool, project: Project, monkeypatch: pytest.MonkeyPatch
) -> None:
    now = [5.0]
    monkeypatch.setattr(fuzz.time, "monotonic", lambda: now[0])
    line = "2 matches, 0.00 h of robot time, 0 failures"
    every = 0.2 if on_terminal else 10.0

    def play() -> None:
        monkeypatch.setattr(sys.stdout, "isatty", lambda: on_terminal, raising=False)
        for quiet in (False, True):
            printer = fuzz._ProgressPrinter(quiet, project)
            for step in (every * 0.75, every * 0.5, every * 0.5, every * 0.75):
                now[0] += step
                printer.on_progress(CampaignProgress(2))
        printer = fuzz._ProgressPrinter(False, project)
        printer.on_seen(SimpleNamespace(text="it fails\nmore"))  # type: ignore[arg-type]
        printer.end(CampaignProgress(2, doing="shrinking"))

    clear = "\r" if on_terminal else ""  # without a terminal, click leaves out the code that clears the line
    shown = f"{clear}{line}" if on_terminal else f"{line}\n"
    assert printed(play) == 2 * shown + f"{clear}found it fails\n{clear}{line}\n"


# -- sync --------------------------------------------------------------------------------------------------------------


def locked(name: str, version: str, index: str | None = "https://pypi.org/simple") -> LockedFile:
    return LockedFile(name, version, f"{name}-{version}.whl", 2_000_000, "ab", "https://a/b.whl", index)


LOCK = Lock(2026, "roboRIO", ("six",), locked("python", "3.14", None), (locked("a", "1"), locked("b", "1", None)))


@pytest.fixture
def synced(project: Project, monkeypatch: pytest.MonkeyPatch) -> SimpleNamespace:
    from pyfrc_core.sync import install, synchronize

    result = SimpleNamespace(lock=LOCK, previous=None, differs=[], different=[], missing=[], installed=[])

    def synchronized(project: object, season: object, installed: object, options: object, progress: Any) -> object:
        result.options = options
        progress.finding("a")
        progress.note("a is old")
        progress.waiting()
        progress.received("a", 1, 2)
        progress.got(LOCK.packages[0], "downloaded", "https://a/b.whl")
        return result

    monkeypatch.setattr(synchronize, "synchronize", synchronized)
    monkeypatch.setattr(synchronize, "differences", lambda *asked: result.differs)
    monkeypatch.setattr(install, "different_here", lambda lock: result.different)
    monkeypatch.setattr(install, "missing_here", lambda *asked: result.missing)
    monkeypatch.setattr(install, "install_here", lambda *asked: result.installed.append(asked))
    return result


def test_what_a_sync_says(synced: SimpleNamespace) -> None:
    lines = run("sync").stdout.splitlines()
    (got,) = (line for line in lines if line.startswith("get "))
    assert got.split() == ["get", "a", "1", "2000", "kB", "downloaded"]
    assert lines[0] == "Another pyfrc sync is running: waiting until it has ended."
    assert lines[2:-1] == [
        "note      a is old",
        "index     https://pypi.org/simple: a",
        "index     none, but a directory: b",
        "lock      pyfrc-lock.toml is new: 2 packages. Commit it.",
    ]
    assert lines[-1].startswith("For the roboRIO: 3 files, 6000 kB, in ")
    synced.previous, synced.different, synced.missing = LOCK, ["a 1", "b 1", "c 1", "d 1"], ["e 1"]
    lines = run("-v", "sync").stdout.splitlines()
    assert "lock      pyfrc-lock.toml: unchanged" in lines
    assert lines[1].endswith("downloaded from https://a/b.whl")
    assert lines[-2:] == [
        "This computer has a 1, b 1, c 1 and 1 more. For the same here: pyfrc sync --install",
        "This computer does not have e 1. For the same here: pyfrc sync --install",
    ]
    synced.previous = replace(LOCK, packages=())
    lines = run("sync").stdout.splitlines()
    at = lines.index("lock      pyfrc-lock.toml has changed. Commit it.")
    assert [each.strip() for each in lines[at + 1 : at + 3]] == ["+ a 1", "+ b 1"]
    assert run("-q", "sync", "--install", "--upgrade", "--find-links", "w", "--use-certifi").stdout == ""
    assert (synced.options.upgrade, synced.options.find_links, synced.options.use_certifi) == (True, ("w",), True)
    ((lock, _, links, quiet),) = synced.installed
    assert (lock, links, quiet) == (LOCK, ("w",), True)


def test_a_sync_that_only_checks(synced: SimpleNamespace) -> None:
    result = run("sync", "--check")
    assert (result.exit_code, result.stdout) == (0, "nothing is missing\n")
    synced.differs = ["a 1 is missing", "b 1 is missing"]
    result = run("sync", "--check")
    assert (result.exit_code, result.stdout) == (1, "a 1 is missing\nb 1 is missing\n\nTo get it: pyfrc sync\n")
    for option in ("--upgrade", "--install", "--find-links=w"):
        result = run("sync", "--check", option)
        assert "--check changes nothing: it takes none of the other options." in str(result.exception) + result.stderr
    assert not hasattr(synced, "options")


def test_changes_of_a_lock_one_line_each() -> None:
    before = replace(LOCK, packages=(*(locked(name, "1") for name in "acde"), locked("f", "1", None)))
    other = replace(locked("c", "1"), sha256="cd")
    moved = locked("d", "2", "https://other"), locked("e", "2"), locked("f", "2")
    after = replace(LOCK, requirements=("attrs",), packages=(locked("b", "1"), other, *moved))
    assert list(changes(before, after)) == [
        "- a 1",
        "+ b 1",
        "c 1: another file of this version",
        "d 1 -> 2, now from https://other",
        "e 1 -> 2",
        "f 1 -> 2",
        "asked for now: attrs",
        "no longer asked for: six",
    ]
    assert list(changes(LOCK, LOCK)) == []


# -- replay, and commands about robots ---------------------------------------------------------------------------------


@for_each(
    "result, code, lines",
    [
        ({}, 0, []),
        (
            {"equal": True},
            0,
            ["The trace equals the recorded one. It has the values of hal_data, and not those of NetworkTables."],
        ),
        ({"equal": False}, 1, ["The trace differs from the recorded one."]),
        ({"failure": "robot.py:3: x"}, 1, ["then robot.py:3: x"]),
        (
            {"equal": False, "difference": SimpleNamespace(now=1.5, path="pwm[0].value", recorded=0.5, replayed=None)},
            1,
            [
                "The trace differs from the recorded one, first at 1.50 s:",
                "  pwm[0].value was 0.5, is null",
            ],
        ),
        (
            {"starts": 2},
            0,
            ["The script starts the robot program 2 times: the trace is that of the last start."],
        ),
    ],
)
def test_how_a_replay_ends(
    result: dict[str, Any], code: int, lines: list[str], project: Project, monkeypatch: pytest.MonkeyPatch
) -> None:
    import pyfrc_core.replay
    from pyfrc_core.compat import unrepeatable

    same = {"seconds": 2.0, "starts": 1, "failure": None, "unrepeatable": (), "difference": None, "equal": None}
    done = SimpleNamespace(**{**same, **result})
    asked: list[Any] = []
    monkeypatch.setattr(pyfrc_core.replay, "replay", lambda *files, **options: asked.append((files, options)) or done)
    monkeypatch.setattr(unrepeatable, "explain_unrepeatable", lambda names: f"not repeating: {names}")
    Path("a.jsonl").write_text("", encoding="utf-8")
    ended = run("replay", "a.jsonl", "--until", "3", "--trace", "t.jsonl")
    assert (ended.exit_code, ended.stdout.splitlines()) == (code, ["replayed 2.00 s of robot time", *lines])
    ((_, options),) = asked
    assert (options["until"], options["trace"]) == (3.0, Path("t.jsonl"))
    # Devices that do not repeat explain a difference, and no failure.
    done.unrepeatable = ("phoenix6",)
    assert run("replay", "a.jsonl").exit_code == int(done.failure is not None)


@pytest.mark.parametrize("command", ["console", "deploy-info", "undeploy", "logs"])
def test_a_command_about_a_robot_passes_on_its_options(
    command: str, project: Project, monkeypatch: pytest.MonkeyPatch
) -> None:
    from pyfrc_core.deploy import logs, session

    calls: list[tuple[Any, ...]] = []
    name = {"console": "show_console", "deploy-info": "show_info", "undeploy": "undeploy", "logs": "fetch_logs"}[
        command
    ]
    monkeypatch.setattr(
        logs if command == "logs" else session, name, lambda *given, **named: calls.append((*given, named))
    )
    more = {"console": ["--nc-ds"], "undeploy": ["--yes"], "logs": ["Q12", "--delete", "--into", "here"]}
    assert run(command, "--robot", "10.0.0.2", "--no-resolve", *more.get(command, [])).exit_code == 0
    ((found, choice, *rest),) = calls
    assert (found.main_file, choice.robot, choice.team, choice.resolve) == (project.main_file, "10.0.0.2", None, False)
    if command == "console":
        assert rest[1] is True
    if command == "logs":
        assert (rest[0].wanted, rest[0].into, rest[0].delete) == (("Q12",), Path("here"), True)
    assert rest[-1] == ({"confirmed": True} if command == "undeploy" else {})
    (talk,) = (each for each in rest if hasattr(each, "progress"))
    assert talk.ask is None
    assert talk.progress.add_robot_option("pyfrc deploy") == "pyfrc deploy --robot 10.0.0.2"


def test_with_json_nothing_is_asked(project: Project, monkeypatch: pytest.MonkeyPatch) -> None:
    from pyfrc_core.deploy import session

    choices: list[Any] = []
    monkeypatch.setattr(session, "show_info", lambda project, choice, talk: choices.append((choice, talk.ask)))
    monkeypatch.setattr(robot_options, "can_ask", lambda: True)
    key = ["--accept-host-key", "SHA256:x", "--robot-name", "Ada"]
    for words in ([], ["--json"]):
        assert run("deploy-info", "--robot", "10.0.0.2", *key, *words).exit_code == 0
    (asking, questions), (quiet, none) = choices
    assert (asking.accepted_key, asking.robot_name, asking.resolve) == ("SHA256:x", "Ada", True)
    assert asking.credentials.ask_password is not None
    assert questions is not None
    assert (quiet.credentials.ask_password, none) == (None, None)


def test_outside_of_a_project_a_robot_has_to_be_named(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    from pyfrc_core.deploy.team import RobotChoice

    assert robot_options.project_if_any(None, RobotChoice(team=3)) is None
    with pytest.raises(PyfrcError) as error:
        robot_options.project_if_any(None, RobotChoice())
    assert (error.value.remedy or "").endswith("Without a project, specify the robot: --robot HOST or --team NUMBER.")
    with pytest.raises(PyfrcError, match="there is no directory"):
        robot_options.project_if_any(Path("none"), RobotChoice(team=3))


def test_who_can_be_asked(monkeypatch: pytest.MonkeyPatch) -> None:
    for output, input_, can in ((True, True, True), (True, False, False), (False, True, False)):
        monkeypatch.setattr(sys, "stdout", SimpleNamespace(isatty=lambda output=output: output))
        monkeypatch.setattr(sys, "stdin", SimpleNamespace(isatty=lambda input_=input_: input_))
        assert shared_options.can_ask() is can
    prompts: list[str] = []
    monkeypatch.setattr(robot_options, "can_ask", lambda: True)
    monkeypatch.setattr(click, "prompt", lambda text, hide_input: prompts.append(text) or "secret")
    assert robot_options._password_prompt(as_json=True) is None
    ask = robot_options._password_prompt(as_json=False)
    assert ask is not None
    assert [ask("a"), ask("a"), ask("b")] == ["secret"] * 3
    assert prompts == ["Password of a", "Password of b"]
    monkeypatch.setattr(robot_options, "can_ask", lambda: False)
    assert robot_options._password_prompt(as_json=False) is None


# -- files -------------------------------------------------------------------------------------------------------------


@click.command()
@click.option("--read", type=ReadPath())
@click.option("--file", type=WrittenFile())
@click.option("--other", type=WrittenFile())
@click.option("--record", type=WrittenFile(is_recording=True))
@click.option("--into", type=WrittenDirectory())
def writing(**files: Path | None) -> None:
    here = Path("robot.py")
    check_outputs(click.get_current_context(), Project(here.absolute()) if here.exists() else None)


@for_each(
    "words, problem",
    [
        ("--file a.txt --other b.txt --record c.jsonl --read d.txt --into e", ""),
        ("--file new/a.txt", ""),
        ("--file robot.py", "--file robot.py cannot be written: it is a file of your robot project"),
        ("--file pyproject.toml", "--file pyproject.toml cannot be written: it is a file of your robot project"),
        ("--file deploy/a.json", "--file deploy/a.json cannot be written: it is a file of your robot project"),
        ("--file notes.txt", ""),
        ("--into lib", "--into lib cannot be written: your robot's code is in it"),
        ("--into notes.txt", "--into notes.txt cannot be written: notes.txt is a file"),
        ("--read a.txt --file a.txt", "--file a.txt cannot be written: this command reads it"),
        ("--read a.jsonl --file a.trace.jsonl", "--file a.trace.jsonl cannot be written: this command reads it"),
        ("--file a.txt --other a.txt", "--other a.txt cannot be written: --file writes it, too"),
        ("--record a.jsonl --file a.trace.jsonl", "--record a.trace.jsonl cannot be written: --file writes it, too"),
        ("--file /nowhere/a.txt", "--file /nowhere/a.txt cannot be written: there is no directory /nowhere"),
    ],
)
def test_what_a_command_must_not_write(words: str, problem: str, project: Project) -> None:
    for name in ("pyproject.toml", "deploy/a.json", "notes.txt", "lib/arm.py"):
        Path(name).parent.mkdir(exist_ok=True)
        Path(name).write_text("", encoding="utf-8")
    result = CliRunner().invoke(writing, words.split())
    assert isinstance(result.exception, UsageError if problem else type(None)), result
    if problem:
        assert problem.split(" cannot be")[0] in str(result.exception)
        assert problem.partition(": ")[2] in str(result.exception)


def test_sources_that_cannot_be_read_are_warned_of(project: Project) -> None:
    Path("bad.py").write_bytes(b"\xff\xfe")
    result = run("config", "check")
    assert (result.exit_code, result.stderr.startswith("warning: bad.py: ")) == (0, True)
    assert project_options.from_here(project.root / "a" / "b.py") == "a/b.py"


# -- other commands ----------------------------------------------------------------------------------------------------


def test_failures_that_are_listed() -> None:
    most = create_physics._MOST_FAILURES
    lines = ["x" * (create_physics._WIDTH + 1), *["y"] * (most - 1)]
    shown = f"\n  {'x' * create_physics._WIDTH}..." + "\n  y" * (most - 1)
    assert create_physics._listed(lines) == shown
    assert create_physics._listed([*lines, "z", "z"]) == f"{shown}\n  and 2 more"
    assert create_physics._listed(["x" * create_physics._WIDTH]) == f"\n  {'x' * create_physics._WIDTH}"


@pytest.mark.parametrize(
    ("words", "code", "robot"),
    [(["--robot"], 0, ""), (["--robot", "1234"], 0, "1234"), ([], 0, None), (["--robot", " "], 2, None)],
)
def test_which_robot_is_viewed(
    words: list[str], code: int, robot: str | None, project: Project, monkeypatch: pytest.MonkeyPatch
) -> None:
    from pyfrc_core.sim import view

    seen: list[Any] = []
    monkeypatch.setattr(view, "view", lambda request, say: seen.append(request) or 0)
    result = run("-q", "view", *words)
    assert (result.exit_code, [each.robot for each in seen]) == (code, [robot] * (code == 0))
    assert code == 0 or "the address is empty." in " ".join(result.stderr.split())
    assert "cannot be written" in str(run("view", "--page", "robot.py").exception)


def test_a_report_of_a_migration() -> None:
    class Remark(SimpleNamespace):
        def __str__(self) -> str:
            return "one\n  two"

    (line,) = migrate._text(Remark(places=["a.py:1"])).splitlines()[1:]  # type: ignore[arg-type]
    assert line == "        two"
    assert migrate._text(Remark(places=[1, 2])).splitlines()[-1] == "      2 lines: 1, 2"  # type: ignore[arg-type]

    def show() -> None:
        migrate._show_progress("reading", 1, 2)
        migrate._show_progress("reading", 2, 2)

    result = CliRunner().invoke(click.command()(show))
    assert (result.stdout, result.stderr.count("\r"), "reading 1/2" in result.stderr) == ("", 2, True)
    assert "reading 2/2" not in result.stderr


def test_the_current_directory_is_not_searched_for_modules(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    here, package = str(tmp_path), str(Path(start.__file__).parents[1])
    for path, left in (
        ([here, "a"], ["a"]),
        (["", "a"], ["a"]),
        (["a", here], ["a", here]),
        ([], []),
    ):
        monkeypatch.setattr(sys, "path", path)
        start._remove_current_directory(here)
        assert sys.path == left
    monkeypatch.setattr(sys, "path", [package])
    start._remove_current_directory(package)
    assert sys.path == [package], "that is where pyfrc itself is"
    monkeypatch.setattr(start.os, "getcwd", lambda: here)
    assert start._current_directory() == here


@for_each(
    "raised, code",
    [(SystemExit(3), 3), (SystemExit("x"), 1), (SystemExit(None), 0), (click.exceptions.Exit(4), 4), (None, 0)],
)
def test_a_measured_command_keeps_its_exit_code(raised: BaseException | None, code: int) -> None:
    def inner() -> None:
        if raised is not None:
            raise raised

    command = click.command()(inner)
    measured = wrapping.Wrapped("test", None, click.Context(command))  # type: ignore[arg-type]
    assert measured.run() == code


def test_a_measured_command_that_is_interrupted(capsys: pytest.CaptureFixture[str]) -> None:
    @click.command()
    def inner() -> None:
        raise KeyboardInterrupt

    assert wrapping.Wrapped("test", None, click.Context(inner)).run() == 2  # type: ignore[arg-type]
    assert capsys.readouterr().err == "interrupted\n"
