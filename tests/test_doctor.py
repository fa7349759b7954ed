"""`pyfrc doctor`: problems of computers and projects, and their remedies."""

from __future__ import annotations

import json
import re
import sys
from collections.abc import Iterator
from email.message import Message
from importlib.metadata import metadata
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from loops import for_each
from packaging.requirements import Requirement
from ports import refusing_port

from pyfrc_core._version import __version__
from pyfrc_core.doctor import NEXT_STEP, CheckResult, installed, robot_project
from pyfrc_core.doctor.check_result import hint, ok, problem
from pyfrc_core.doctor.examine import (
    DoctorOptions,
    _project,
    _season_settings,
    check_downloads,
    check_window,
)
from pyfrc_core.doctor.installed import Installed, Package, find_installed
from pyfrc_core.doctor.packages import NEWEST, OLDEST, check_imports, check_pyfrc, check_python, check_wpilib
from pyfrc_core.doctor.robot import RobotSearch
from pyfrc_core.doctor.steps import Step, first_missing, next_step
from pyfrc_core.errors import ProjectError
from pyfrc_core.project import Project, find_project
from pyfrc_core.season import CURRENT

ROBOT = "import wpilib\n\nclass MyRobot(wpilib.TimedRobot):\n    pass\n"


def package(name: str, version: str, *needs: str, place: str = "/packages") -> Package:
    return Package(name, version, tuple(map(Requirement, needs)), place)


HAL = package("robotpy-hal", "2026.2.2")
WPILIB = package("wpilib", "2026.2.2", "robotpy-hal==2026.2.2")


def problems(findings: Iterator[CheckResult]) -> list[CheckResult]:
    found = list(findings)
    assert all(each.remedy for each in found if each.status != "ok")
    return [each for each in found if each.status == "problem"]


def results_of(result: Any) -> dict[str, list[dict[str, str]]]:
    """The findings of a run with --json, by their topics."""
    answer = json.loads(result.stdout)
    assert answer["problems"] == sum(each["status"] == "problem" for each in answer["findings"])
    assert result.code == (1 if answer["problems"] else 0)
    found: dict[str, list[dict[str, str]]] = {}
    for each in answer["findings"]:
        assert each["remedy"] or each["status"] == "ok"
        found.setdefault(each["topic"], []).append(each)
    return found


# --- the computer


def test_the_pythons_that_are_known_are_from_the_oldest_tested_one_to_the_robots() -> None:
    tested = re.findall(r"Python :: 3[.](\d+)", "\n".join(metadata("pyfrc").get_all("Classifier") or []))
    minors = sorted(map(int, tested))
    assert (3, minors[0]) == OLDEST
    assert (3, minors[-1]) <= NEWEST == CURRENT.controller.python


@for_each(
    "version, bits, status",
    [((3, 9), 64, "problem"), ((3, 12), 32, "problem"), ((3, 12), 64, "ok"), ((3, 15), 64, "hint")],
)
def test_python_itself(version: tuple[int, int], bits: int, status: str) -> None:
    (finding,) = check_python(version, bits)
    assert finding.status == status


def test_no_wpilib() -> None:
    (finding,) = problems(check_wpilib(Installed([])))
    assert finding.remedy == 'Install the one of 2026: pip install "wpilib>=2026.2.2,<2027"'


@for_each(
    "others, said",
    [
        ([], "wpilib 2026.2.2 needs robotpy-hal==2026.2.2, which is missing"),
        (
            [package("robotpy-hal", "2026.1.1")],
            "wpilib 2026.2.2 needs robotpy-hal==2026.2.2, not 2026.1.1",
        ),
        (
            [HAL, package("photonlibpy", "2025.3.1", "wpilib>=2025")],
            "photonlibpy 2025.3.1 is for the season 2025, wpilib 2026.2.2 for 2026",
        ),
        (
            [HAL, package("phoenix6", "25.4.0", "wpilib>=2025")],
            "phoenix6 25.4.0 is for the season 2025, wpilib 2026.2.2 for 2026",
        ),
        (
            [HAL, package("robotpy-rev", "2026.0.1", "wpilib<2026.2,>=2026.1")],
            "robotpy-rev 2026.0.1 needs wpilib<2026.2,>=2026.1, not 2026.2.2",
        ),
    ],
)
def test_packages_that_do_not_fit(others: list[Package], said: str) -> None:
    (finding,) = problems(check_wpilib(Installed([WPILIB, *others])))
    assert finding.text == said


def test_of_wpilibs_own_packages_the_odd_one_is_named_once() -> None:
    """Not what it needs itself, which would be the opposite."""
    odd = package("robotpy-wpimath", "2026.1.1", "robotpy-native-wpimath==2026.1.1")
    others = [
        package("robotpy-native-wpimath", "2026.2.2"),
        package("robotpy-hal", "2026.2.2", "robotpy-wpimath==2026.2.2"),
        package("wpilib", "2026.2.2", "robotpy-hal==2026.2.2", "robotpy-wpimath==2026.2.2"),
    ]
    (finding,) = problems(check_wpilib(Installed([odd, *others])))
    assert finding.remedy == 'pip install "robotpy-wpimath==2026.2.2"'
    assert finding.text.endswith("not 2026.1.1; also needed by wpilib 2026.2.2")


def test_a_package_that_wants_an_older_wpilib_is_to_be_upgraded() -> None:
    rev = package("robotpy-rev", "2026.0.1", "wpilib<2026.2")
    (finding,) = problems(check_wpilib(Installed([WPILIB, HAL, rev])))
    assert finding.remedy == "pip install --upgrade robotpy-rev"


def test_a_vendors_package_is_upgraded_in_its_own_numbering() -> None:
    vendors = [package("phoenix6", "25.4.0", "wpilib"), package("photonlibpy", "2025.3.1", "wpilib")]
    remedies = [each.remedy for each in problems(check_wpilib(Installed([WPILIB, HAL, *vendors])))]
    assert remedies == ['pip install --upgrade "phoenix6==26.*"', 'pip install --upgrade "photonlibpy==2026.*"']


def test_packages_of_other_kinds_have_no_season() -> None:
    others = [package("requests", "25.1.0"), package("robotpy-helpers", "0.3", "wpilib")]
    (finding,) = check_wpilib(Installed([WPILIB, HAL, *others]))
    assert finding.status == "ok"
    assert finding.text == "2026.2.2, and its 1 companions fit; with robotpy-helpers 0.3"
    native = package("robotpy-native-wpihal", "1.0", "wpilib")
    (finding,) = check_wpilib(Installed([WPILIB, HAL, native]))
    assert finding.text == "2026.2.2, and its 2 companions fit"


def test_another_pyfrc_beside_this_one() -> None:
    ours, todays = package("pyfrc", __version__), package("pyfrc", "2026.0.3", place="/elsewhere")
    (finding,) = problems(check_pyfrc(Installed([ours, todays])))
    assert "2026.0.3 in /elsewhere" in finding.text
    (finding,) = problems(check_pyfrc(Installed([todays])))
    assert "2026.0.3 is installed, in /elsewhere" in finding.text


def test_something_else_under_pyfrcs_names(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    other = tmp_path / "other_tool-1.0.dist-info"
    other.mkdir()
    (other / "METADATA").write_text("Metadata-Version: 2.1\nName: other-tool\nVersion: 1.0\n", "utf-8")
    (other / "entry_points.txt").write_text("[robotpy_cli.2026]\ntest = other_tool:Test\n", "utf-8")
    (tmp_path / "pyfrc").mkdir()
    (tmp_path / "pyfrc/__init__.py").write_text("", "utf-8")
    monkeypatch.syspath_prepend(tmp_path)
    monkeypatch.delitem(sys.modules, "pyfrc", raising=False)
    findings = list(check_pyfrc(Installed([package("pyfrc", __version__)])))
    assert [each.status for each in findings] == ["problem", "hint"]
    assert str(tmp_path) in findings[0].text
    assert findings[1].text == "both other-tool and pyfrc provide robotpy test"


def test_what_pyfrc_needs_and_has_not() -> None:
    (finding,) = problems(
        check_pyfrc(Installed([package("pyfrc", __version__, "click>=8.1"), package("click", "7.0")]))
    )
    assert finding.remedy == 'pip install "click>=8.1"'


def test_a_directory_that_is_twice_on_the_path_is_no_second_copy() -> None:
    once = [package("pyfrc", __version__)]
    assert len(Installed(once * 2).copies["pyfrc"]) == 1


@pytest.mark.parametrize(
    ("code", "how"),
    [
        ("raise ImportError('libhal.so: GLIBC_2.99 not found')", "ImportError libhal.so: GLIBC_2.99 not found"),
        ("import os; os._exit(3)", "ends Python with 3"),
        pytest.param(
            "import os, signal; os.kill(os.getpid(), signal.SIGSEGV)",
            "crashes Python: signal 11 (SIGSEGV, segmentation fault)",
            marks=pytest.mark.skipif(sys.platform == "win32", reason="there are no signals"),
        ),
    ],
)
def test_a_library_that_cannot_be_imported_is_named_and_the_next_is_tried(code: str, how: str, tmp_path: Path) -> None:
    (tmp_path / "wpilib.py").write_text(code, "utf-8")
    (tmp_path / "rev.py").write_text("raise ValueError('of its own')", "utf-8")
    (tmp_path / "navx.py").write_text("", "utf-8")
    installed = Installed([package(name, "2026.1") for name in ("wpilib", "robotpy-rev", "robotpy-navx")])
    found = list(check_imports(installed, [str(tmp_path), *sys.path]))
    assert [each.text for each in found] == [f"import wpilib: {how}", "import rev: ValueError of its own"]
    assert {each.status for each in found} == {"problem"}
    if sys.platform == "linux":
        too_old = "This system is too old for WPILib: it needs a newer release of your Linux."
        reinstall = "pip install --force-reinstall --no-deps"
        assert found[0].remedy == (too_old if "GLIBC" in code else f"{reinstall} wpilib")
        assert found[1].remedy == f"{reinstall} robotpy-rev"


# --- the project


def test_a_new_project_has_no_problems_and_one_line_per_check(make_project) -> None:
    project = make_project({})
    assert project.run("init", ".").code == 0
    result = project.run("doctor", "--no-robot")
    assert result.code == 0, result.output
    assert f"ok      program: class MyRobot in {project.path / 'robot.py'}" in result.stdout
    assert result.stdout.endswith("\nno problems\n")
    for line in result.stdout.splitlines()[:-2]:
        assert re.match(r"ok      |hint    |          \S", line), line


@pytest.mark.parametrize(
    ("files", "topic", "said", "remedy"),
    [
        ({"robot.py": "import wpilib\n\n1 / 0\n"}, "program", "robot.py:3: ZeroDivisionError", ""),
        ({"robot.py": "x = 1\n"}, "program", "no robot class", "class MyRobot"),
        ({"random.py": ""}, "project", "random.py hides a library", "another name"),
        ({"physics.py": "class PhysicsEngine:"}, "physics", "physics.py:1: IndentationError", "by four spaces"),
        (
            {"physics.py": "class PhysicsEngine:\n    def update_sim(self): pass\n"},
            "physics",
            "physics.py:2: ",
            "It must have a class",
        ),
    ],
)
def test_what_is_wrong_in_a_project(files: dict[str, str], topic: str, said: str, remedy: str, make_project) -> None:
    project = find_project(make_project({"robot.py": ROBOT} | files).path)
    found = list(robot_project.check_project(project, find_installed()))
    wrong = [each for each in found if each.status == "problem"]
    assert [each.topic for each in wrong][:1] == [topic], found
    assert said in wrong[0].text
    assert remedy in str(wrong[0].remedy)
    tests = next(each for each in found if each.topic == "tests")
    assert (tests.status, tests.text) == ("hint", "the project has none")


def test_what_is_wrong_in_files_that_are_not_run(make_project) -> None:
    made = make_project(
        {
            "robot.py": ROBOT,
            "pyproject.toml": "[tool.robotpy]\nrequires = ['click>99', 'no-such>=1']\n",
            "sim/config.json": '{"pyfrc": {"robot": {"w": "wide"}}}',
            "sim/dashboards.json": '{"dashboards": {"a": {"rows": 0}}}',
        }
    )
    project = find_project(made.path)
    config, *_ = problems(robot_project._sim_config(project))
    assert "robot.w" in config.text
    (dashboard,) = problems(robot_project._dashboards(project))
    assert "a.rows = 0" in dashboard.text
    made.write({"sim/dashboards.json": '{"dashboards": {"drivers": {}}}', "sim/config.json": "{}"})
    assert [each.text for each in robot_project._dashboards(project)] == ["dashboards: drivers"]
    assert [each.text for each in robot_project._sim_config(project)] == ["no mistakes"]
    for file in ("dashboards.json", "config.json"):
        (made.path / "sim" / file).unlink()
    assert list(robot_project._dashboards(project)) == []
    (none,) = robot_project._sim_config(project)
    assert (none.status, none.remedy) == ("hint", "pyfrc create-physics")
    click, missing = problems(robot_project._asked_for(project, find_installed(), None))
    assert "requires click>99, but " in click.text
    assert "click>99" in click.remedy
    assert "it is not installed" in missing.text


# --- the robot


def test_only_one_result_about_the_robot(make_project) -> None:
    assert make_project({}).run_here("doctor", "--no-robot", "--team", "1").code == 2


def robot_found(project: Project | None, robot: str | None = None, team: int | None = None) -> tuple[CheckResult, Any]:
    search = RobotSearch(project, robot, team)
    (finding,) = search.findings()
    return finding, search.missing_step()


def test_a_robot_that_is_not_found_is_a_problem_if_the_user_has_named_it(make_project) -> None:
    with refusing_port() as port:
        address = f"127.0.0.1:{port}"
        preferences = {".wpilib/wpilib_preferences.json": json.dumps({"robotHostname": address})}
        project = find_project(make_project({"robot.py": ROBOT} | preferences).path)
        for named, status in ((None, "hint"), (address, "problem")):
            finding, (step, remedy) = robot_found(project, named)
            assert (finding.status, finding.text) == (status, f"{address}: no robot found")
            assert step is Step.CONTROLLER
            assert "pyfrc deploy lists the addresses that were tried." in remedy


def test_a_robot_that_is_not_searched(make_project) -> None:
    finding, step = robot_found(None)
    assert (finding.status, finding.text, finding.remedy, step) == (
        "hint",
        "not searched: no team is known outside of a project",
        "pyfrc doctor --team NUMBER",
        None,
    )
    made = make_project({"robot.py": ROBOT})
    finding, (step, remedy) = robot_found(find_project(made.path))
    assert finding.text.startswith("not searched: no robot is specified")
    assert (step, remedy.partition(",")[0]) == (Step.TEAM, "pyfrc deploy asks for it")
    made.write({".wpilib/wpilib_preferences.json": '{"teamNumber": "red"}'})
    finding, step = robot_found(find_project(made.path))
    assert (finding.status, "teamNumber = 'red'" in finding.text, step) == ("problem", True, None)


def test_the_next_step_is_named_with_its_number() -> None:
    found = next_step(Step.TEAM, "do this")
    assert (found.topic, found.status, found.text, found.remedy) == (
        NEXT_STEP,
        "hint",
        "1 of 6, the team number",
        "do this",
    )
    drive = next_step(Step.DRIVE, "")
    assert (drive.status, drive.text.partition(".")[0]) == ("ok", "drive")
    for step in Step:
        assert next_step(step, "").text
    # What is not downloaded is only in the way of what comes after it, and before the packages are on the robot.
    lacks = hint("sync", "", "pyfrc sync")
    assert [first_missing(lacks, (step, "")).text.partition(" ")[0] for step in Step] == [
        "1",
        "2",
        "2",
        "2",
        "5",
        "drive.",
    ]
    assert first_missing(None, (Step.PACKAGES, "x")).remedy == "x"


def test_a_project_that_is_not_there_is_a_problem_only_if_it_was_named(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    for named, status in ((None, "hint"), (Path("nowhere"), "problem")):
        project, about = _project(DoctorOptions(named))
        assert project is None
        assert about is not None
        assert about.status == status
    (tmp_path / "robot.py").write_text(ROBOT)
    project, about = _project(DoctorOptions())
    assert (project is not None, about) == (True, None)


def test_what_is_asked_for_and_differs_here(make_project) -> None:
    settings = """
        [tool.robotpy]
        robotpy_version = "2026.1.1"
        robotpy_extras = []
        requires = ["pyfrc==2026.0.1", "none-such==1.0; platform_machine != 'roborio'"]
        components = ["command2"]
    """
    project = find_project(make_project({"robot.py": ROBOT, "pyproject.toml": settings}).path)
    found = list(robot_project._asked_for(project, find_installed(), WPILIB))
    by_status = {status: [each for each in found if each.status == status] for status in ("hint", "problem")}
    texts = "\n".join(each.text for each in by_status["hint"])
    assert "robotpy_version is 2026.1.1, but wpilib 2026.2.2 is installed here" in texts
    assert "robotpy_extras was renamed in 2026" in texts
    assert "requires pyfrc==2026.0.1, but" in texts
    assert any("a robot does not need pyfrc" in str(each.remedy) for each in by_status["hint"])
    remedies = [each.remedy for each in by_status["problem"]]
    assert any("Did you mean 'commands2'?" in str(each) for each in remedies)
    assert 'pip install "none-such==1.0"' in remedies


def test_problems_come_first_and_the_next_step_last(make_project, monkeypatch: pytest.MonkeyPatch) -> None:
    found = [ok("a", "fine"), hint(NEXT_STEP, "1 of 6", "go on"), hint("b", "a hint", "this"), problem("c", "d", "e")]
    monkeypatch.setattr("pyfrc_core.doctor.examine", lambda options: iter(found))
    project = make_project({})
    result = project.run_here("doctor", "--no-robot")
    words = [line.split()[0] for line in result.stdout.splitlines() if line[:1].strip()]
    assert (result.code, words) == (1, ["problem", "hint", "ok", "hint", "1"])
    assert result.stdout.endswith("\n1 problem\n")
    quiet = project.run_here("-q", "doctor", "--no-robot")
    assert (quiet.code, quiet.stdout) == (1, "problem c: d\n          e\n")
    as_json = results_of(project.run_here("doctor", "--no-robot", "--json"))
    assert as_json["c"] == [{"topic": "c", "status": "problem", "text": "d", "remedy": "e"}]


def test_downloads_that_are_missing_or_differ(make_project, monkeypatch: pytest.MonkeyPatch) -> None:
    project = find_project(make_project({"robot.py": ROBOT}).path)
    examine = sys.modules[check_downloads.__module__]

    def found(count: int, others: int, lock: object = SimpleNamespace(files=[1], controller="X")) -> list[CheckResult]:
        monkeypatch.setattr(examine, "load_lock", lambda file, season: lock)
        monkeypatch.setattr(examine, "differences", lambda *_: map(str, range(count)))
        monkeypatch.setattr(examine, "different_here", lambda lock: map(str, range(others)))
        return list(check_downloads(project, CURRENT, "2026.2.2"))

    (missing,) = found(0, 0, None)
    assert missing.text == "there is no pyfrc-lock.toml: what the robot needs was not downloaded with pyfrc"
    fine, here = found(0, 3)
    assert (fine.status, fine.text) == ("ok", "1 file for the X are on this computer")
    assert (here.text, here.remedy) == (
        "this computer has 0, 1, 2",
        "For the robot's versions here, too: pyfrc sync --install",
    )
    assert found(0, 5)[1].text == "this computer has 0, 1, 2 and 2 more"
    assert [each.text for each in found(3, 0)] == ["0; 1; 2"]
    assert [each.text for each in found(5, 0)] == ["0; 1; 2; and 2 more"]


def test_settings_that_cannot_be_read_fit_no_season(make_project) -> None:
    made = make_project({"robot.py": ROBOT, "pyproject.toml": "[tool.robotpy]\nrobotpy_version = 5\n"})
    assert _season_settings(find_project(made.path)) == _season_settings(None) == []


@pytest.mark.parametrize(
    ("error", "text"),
    [
        (ProjectError("no class", where="robot.py:1", remedy="Add one."), "robot.py:1: no class"),
        (OSError("no process"), "no process"),
        (ValueError("odd"), "robot.py cannot be imported: odd"),
    ],
)
def test_a_file_that_cannot_be_looked_at(error: Exception, text: str, monkeypatch: pytest.MonkeyPatch) -> None:
    def fail(*_: object) -> None:
        raise error

    monkeypatch.setattr(robot_project, "run_in_subprocess", fail)
    found = robot_project._imported(lambda project, log: None, None, "program", "robot.py", "it")  # type: ignore[arg-type]
    assert isinstance(found, CheckResult)
    assert (found.topic, found.status, found.text) == ("program", "problem", text)
    assert found.remedy


@pytest.mark.parametrize(
    ("display", "tkinter", "status", "text"),
    [
        (True, True, "ok", "there is a display, and tkinter"),
        (True, False, "hint", "pyfrc sim --ui tk cannot show one: this Python has no tkinter"),
        (False, True, "hint", "pyfrc sim --ui tk cannot show one: there is no display"),
        (False, False, "hint", "pyfrc sim --ui tk cannot show one: there is no display"),
    ],
)
def test_whether_there_can_be_a_window(
    display: bool, tkinter: bool, status: str, text: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    examine = sys.modules[check_window.__module__]
    monkeypatch.setattr(examine, "has_display", lambda: display)
    monkeypatch.setattr(examine, "has_tkinter", lambda: tkinter)
    (found,) = check_window()
    assert (found.status, found.text) == (status, text)
    assert (found.remedy is None) is (status == "ok")


def test_what_an_installed_package_needs_here() -> None:
    def found(name: str | None, version: str, *needs: str, place: str = "/a") -> Any:
        about = Message()
        for key, value in [("Name", name), ("Version", version), *(("Requires-Dist", each) for each in needs)]:
            if value is not None:
                about[key] = value
        return SimpleNamespace(metadata=about, locate_file=lambda path: Path(place))

    assert installed._package(found(None, "1")) is None, "left over from an incomplete removal"
    needs = ("wpilib>=2026.1", "six; extra == 'more'", "not a requirement!")
    rev = installed._package(found("robotpy-rev", "2026.1.2", *needs))
    assert rev is not None
    assert (str(rev), rev.season, [str(each) for each in rev.needs]) == ("robotpy-rev 2026.1.2", 2026, [needs[0]])
