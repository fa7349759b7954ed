"""`make mutants`: what it changes, which tests it runs, and its verdicts, with a small program in a repository."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path
from textwrap import dedent
from zlib import crc32

import mutants
import pytest
import touched_lines
from mutant_places import mutants_of
from skips import missing_programs, require

PROGRAM = dedent("""
    def first(values):
        \"\"\"Return it.\"\"\"
        if not values:
            raise ValueError("none")
        return values[0]


    class Counter:
        step = 1

        def add(self, by: int = 2):
            while by > 0 and self.step:
                by -= self.step
                self.note("down")
            return None


    def endless():
        count = 1
        while count < 2:
            count += 1


    def never_run():
        return 1
""").lstrip()
TESTS = dedent("""
    from pyfrc_core.program import Counter, endless, first


    def test_first():
        assert first([4, 5]) == 4


    def test_counter():
        counter = Counter()
        counter.note = lambda text: None
        counter.add()


    def test_endless():
        endless()
""")


def test_what_is_changed() -> None:
    found = [str(each).partition(" ")[2] for each in mutants_of("a.py", PROGRAM.encode())]
    assert found == [
        "first, condition: not values -> (not (not values))",
        "first, return: values[0] -> None",
        "first, constant: 0 -> 1",
        "Counter.add, condition: by > 0 and self.step -> (not (by > 0 and self.step))",
        "Counter.add, operator: and -> or",
        "Counter.add, operator: > -> >=",
        "Counter.add, constant: 0 -> 1",
        'Counter.add, call: self.note("down") -> pass',
        "Counter.add, constant: \"down\" -> 'downX'",
        "endless, constant: 1 -> 2",
        "endless, condition: count < 2 -> (not (count < 2))",
        "endless, operator: < -> <=",
        "endless, constant: 2 -> 3",
        "endless, constant: 1 -> 2",
        "never_run, return: 1 -> None",
        "never_run, constant: 1 -> 2",
    ]


def test_each_mutant_is_a_program() -> None:
    source = 'def f(é):\n    x = "é" + (a\n    +  b)\n    return x is  not é or x in [1.5, True]\n'.encode()
    for each in mutants_of("a.py", source):
        compile(source[: each.start] + each.new.encode() + source[each.end :], "a.py", "exec")
        assert source[each.start : each.end].decode() == each.old
    operators = [(each.line, each.new.strip()) for each in mutants_of("a.py", source) if each.kind == "operator"]
    assert operators == [(2, "- ("), (2, "-"), (4, "and"), (4, "is"), (4, "not in")]


@pytest.fixture
def repository(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A repository with the program and its tests, which is the tool's."""
    require("make mutants", missing_programs("git"))
    root = tmp_path / "repository"
    for name, text in {"pyfrc_core/program.py": PROGRAM, "tests/test_program.py": TESTS}.items():
        (root / name).parent.mkdir(parents=True)
        (root / name).write_text(text, encoding="utf-8")
    (root / "pyfrc_core/__init__.py").touch()
    (root / "tests/touched_lines.py").write_bytes(Path(touched_lines.__file__).read_bytes())
    subprocess.run(["git", "init", "--quiet", root], check=True)
    monkeypatch.setattr(mutants, "ROOT", root)
    monkeypatch.chdir(root)
    return root


def test_each_mutant_is_of_another_function_and_the_same_for_a_seed(repository: Path) -> None:
    (files,) = mutants.rooms().values()
    assert files == ["pyfrc_core/__init__.py", "pyfrc_core/program.py"]
    chosen = mutants.choose(files, 3, "1")
    assert len({each.function for each in chosen}) == 3
    assert mutants.choose(files, 3, "1") == chosen
    assert len(mutants.choose(files, 99, "2")) == 4


def recorded(directory: Path, name: str, seconds: float, *lines: int, outcome: str = "passed") -> None:
    phases = [f"@ setup passed {seconds:.3f}", f"@ call {outcome} {seconds:.3f}", "@ teardown passed 0.000"]
    touched = [f"pyfrc_core/program.py:{line}" for line in lines]
    file = directory / f"{crc32(name.encode()):08x}"
    file.write_text("\n".join([f"= tests/test_program.py::{name}", *touched, *phases, *phases, ""]), encoding="utf-8")


@pytest.fixture
def scratch(repository: Path, tmp_path: Path) -> Path:
    """A scratch directory with a map."""
    (directory := tmp_path / "touched").mkdir()
    recorded(directory, "test_counter", 0.02, 12, 13, 14)
    recorded(directory, "test_first", 0.01, 3, 5)
    recorded(directory, "test_first_again", 0.001, 3, 5, outcome="failed")
    recorded(directory, "test_endless", 0.03, 19, 20, 21)
    (scratch := tmp_path / "scratch").mkdir()
    mutants.Map(scratch / "map.json").add(directory, repository)
    return scratch


def test_the_map_follows_lines_that_have_moved(repository: Path, scratch: Path) -> None:
    map = mutants.Map(scratch / "map.json")
    # One that has failed without a mutant says nothing.
    assert map.seconds == {
        "tests/test_program.py::test_counter": 0.04,
        "tests/test_program.py::test_first": 0.02,
        "tests/test_program.py::test_endless": 0.06,
    }
    file = repository / "pyfrc_core/program.py"
    file.write_text("# new\n\n" + PROGRAM.replace("by -= self.step", "by -= 2 * self.step"), encoding="utf-8")
    tests = {each.line: map.tests_of(each) for each in mutants.at("pyfrc_core/program.py:Counter.add")}
    assert list(tests) == [14, 15, 16]
    assert all(each == ["tests/test_program.py::test_counter"] for each in tests.values())


@pytest.mark.slow
def test_verdicts(
    repository: Path, scratch: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(mutants, "LIMIT", (4.0, 1))
    monkeypatch.setenv("PYTEST_DISABLE_PLUGIN_AUTOLOAD", "1")  # pyfrc's needs all of it
    program = "pyfrc_core/program.py"
    arguments = ["--scratch", str(scratch), "--jobs", "1"]
    for place in (f"{program}:first", f"{program}:14", f"{program}:21", f"{program}:never_run"):
        arguments += ["--at", place]
    assert mutants.main(arguments) == 0
    lines = capsys.readouterr().out.splitlines()
    table = dict(zip([each.partition(" ")[2] for each in lines[:-2:2]], map(str.strip, lines[1:-2:2]), strict=True))
    assert table == {
        "first, condition: not values -> (not (not values))": "killed by tests/test_program.py::test_first",
        "first, return: values[0] -> None": "killed by tests/test_program.py::test_first",
        "first, constant: 0 -> 1": "killed by tests/test_program.py::test_first",
        'Counter.add, call: self.note("down") -> pass': "SURVIVES 1 of its 1 tests",
        "Counter.add, constant: \"down\" -> 'downX'": "SURVIVES 1 of its 1 tests",
        "endless, constant: 1 -> 2": "SURVIVES 1 of its 1 tests",
        "never_run, return: 1 -> None": "SURVIVES: no test runs it",
        "never_run, constant: 1 -> 2": "SURVIVES: no test runs it",
    }
    assert [each.split() for each in lines[-2:]] == [
        ["pyfrc_core", "3", "of", "8", "killed"],
        ["~", "all", "3", "of", "8", "killed"],
    ]
    assert (repository / program).read_text("utf-8") == PROGRAM


@pytest.mark.slow  # it waits for a time limit
def test_a_mutant_that_never_ends_is_stopped_and_tests_that_fail_without_one_are_not_believed(
    repository: Path, scratch: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(mutants, "LIMIT", (2.0, 1))
    monkeypatch.setenv("PYTEST_DISABLE_PLUGIN_AUTOLOAD", "1")
    program = repository / "pyfrc_core/program.py"
    program.write_text(
        PROGRAM.replace("count < 2", "count < 3").replace("count += 1", "count = min(count + 1, 3)"), encoding="utf-8"
    )
    arguments = ["--scratch", str(scratch), "--jobs", "1", "--at", "pyfrc_core/program.py:20"]
    assert mutants.main(arguments) == 0
    assert "killed by the limit of 2 s of processor time" in capsys.readouterr().out
    program.write_text(PROGRAM.replace("values[0]", "values[1]"), encoding="utf-8")
    with pytest.raises(SystemExit):
        mutants.main([*arguments[:-1], "pyfrc_core/program.py:first"])
    assert "without a mutant, this fails: tests/test_program.py::test_first" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (["--each", "1"], "first see which tests run which lines: make mutants ARGS=--map"),
        *([] if sys.version_info >= (3, 12) else [(["--map"], "the map needs Python 3.12 or newer")]),
    ],
)
def test_without_a_map(
    repository: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str], options: list[str], message: str
) -> None:
    with pytest.raises(SystemExit):
        mutants.main(["--scratch", str(tmp_path / "empty"), *options])
    assert message in capsys.readouterr().err
