"""`pyfrc doctor`: problems of computers and projects, and their remedies."""

from __future__ import annotations

import json
import re
import socket
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from importlib.metadata import metadata
from pathlib import Path
from typing import Any

import pytest
from browsers import NO_BROWSER
from packaging.requirements import Requirement
from ports import refusing_port

from pyfrc_core._version import __version__
from pyfrc_core.doctor import CheckResult, robot_project
from pyfrc_core.doctor.installed import Installed, Package, find_installed
from pyfrc_core.doctor.packages import NEWEST, OLDEST, check_imports, check_pyfrc, check_python, check_wpilib
from pyfrc_core.project import find_project
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


def test_here_all_is_well() -> None:
    installed = find_installed()
    assert not problems(check_python())
    assert not problems(check_pyfrc(installed))
    assert not problems(check_wpilib(installed))
    assert not problems(check_imports(installed))


def test_the_pythons_that_are_known_are_from_the_oldest_tested_one_to_the_robots() -> None:
    tested = re.findall(r"Python :: 3[.](\d+)", "\n".join(metadata("pyfrc").get_all("Classifier") or []))
    minors = sorted(map(int, tested))
    assert (3, minors[0]) == OLDEST
    assert (3, minors[-1]) <= NEWEST == CURRENT.controller.python


@pytest.mark.parametrize(
    ("version", "bits", "status"),
    [((3, 9), 64, "problem"), ((3, 12), 32, "problem"), ((3, 12), 64, "ok"), ((3, 15), 64, "hint")],
)
def test_python_itself(version: tuple[int, int], bits: int, status: str) -> None:
    (finding,) = check_python(version, bits)
    assert finding.status == status


def test_no_wpilib() -> None:
    (finding,) = problems(check_wpilib(Installed([])))
    assert finding.remedy == 'Install the one of 2026: pip install "wpilib>=2026.2.2,<2027"'


@pytest.mark.parametrize(
    ("others", "said"),
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
    assert "robotpy-helpers 0.3" in finding.text
    assert "requests" not in finding.text


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


def test_without_a_display_there_is_no_window(make_project) -> None:
    found = results_of(make_project({}).run("doctor", "--no-robot", "--json", env=NO_BROWSER))
    (window,), (browser,) = found["window"], found["browser"]
    if sys.platform == "linux":
        assert window["status"] == browser["status"] == "hint"
        assert "--ui none" in window["remedy"]
        assert browser["text"] == "pyfrc sim cannot open one: there is no display"


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


def test_without_a_project_the_rest_is_looked_at(make_project) -> None:
    found = results_of(make_project({}).run("doctor", "--json"))
    assert found["project"][0]["status"] == "hint"
    assert found["wpilib"][0]["status"] == "ok"
    assert "not searched" in found["robot"][0]["text"]


@pytest.mark.slow
def test_a_project_that_was_named_has_to_be_there(make_project) -> None:
    found = results_of(make_project({}).run("doctor", "--no-robot", "--json", "--project", "nowhere"))
    assert found["project"][0]["status"] == "problem"


@pytest.mark.parametrize(
    ("files", "topic", "said", "remedy"),
    [
        ({"robot.py": "import wpilib\n\n1 / 0\n"}, "program", "robot.py:3: ZeroDivisionError", ""),
        pytest.param({"robot.py": "import os\nos._exit(0)\n"}, "program", "robot.py:2", "", marks=pytest.mark.slow),
        pytest.param({"robot.py": "x = 1\n"}, "program", "no robot class", "class MyRobot", marks=pytest.mark.slow),
        (
            {"pyproject.toml": "[tool.pyfrc]\nmian = 'robot.py'\n"},
            "project",
            "pyproject.toml:2: unknown key 'tool.pyfrc.mian'",
            "main",
        ),
        pytest.param(
            {"pyproject.toml": "[tool.robotpy]\nrequires = ['no-such>=1']\n"},
            "project",
            "not installed",
            "no-such>=1",
            marks=pytest.mark.slow,
        ),
        pytest.param(
            {"pyproject.toml": "[tool.robotpy]\nrequires = ['click>99']\n"},
            "project",
            "requires click>99, but ",
            "click>99",
            marks=pytest.mark.slow,
        ),
        pytest.param(
            {"sim/config.json": '{"pyfrc": {"robot": {"w": "wide"}}}'},
            "sim/config.json",
            "robot.w",
            "",
            marks=pytest.mark.slow,
        ),
        pytest.param(
            {"wpilib/__init__.py": ""},
            "project",
            "wpilib/__init__.py hides a library",
            "another name",
            marks=pytest.mark.slow,
        ),
        pytest.param(
            {"sim/dashboards.json": '{"dashboards": {"a": {"rows": 0}}}'},
            "sim/dashboards.json",
            "a.rows = 0",
            "",
            marks=pytest.mark.slow,
        ),
        pytest.param({"random.py": ""}, "project", "random.py hides a library", "another name", marks=pytest.mark.slow),
        pytest.param(
            {"physics.py": "class PhysicsEngine:"},
            "physics",
            "physics.py:1: IndentationError",
            "indent this one by four spaces",
            marks=pytest.mark.slow,
        ),
        pytest.param(
            {"physics.py": "import phisics"},
            "physics",
            "physics.py:1: there is no module phisics",
            "Did you mean physics?",
            marks=pytest.mark.slow,
        ),
        pytest.param(
            {"physics.py": "class PhysicEngine: pass"},
            "physics",
            "PhysicsEngine",
            "It must have a class",
            marks=pytest.mark.slow,
        ),
        (
            {"physics.py": "class PhysicsEngine:\n    def update_sim(self): pass\n"},
            "physics",
            "physics.py:2: ",
            "It must have a class",
        ),
    ],
)
def test_what_is_wrong_in_a_project(files: dict[str, str], topic: str, said: str, remedy: str, make_project) -> None:
    found = results_of(make_project({"robot.py": ROBOT} | files).run("doctor", "--no-robot", "--json"))
    wrong = [each for each in found[topic] if each["status"] == "problem"]
    assert wrong, found
    assert said in wrong[0]["text"]
    assert remedy in wrong[0]["remedy"]


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
    click, missing = problems(robot_project._asked_for(project, find_installed(), None))
    assert "requires click>99, but " in click.text
    assert "click>99" in click.remedy
    assert "it is not installed" in missing.text


@pytest.mark.slow
def test_what_a_project_could_have_besides(make_project) -> None:
    files = {"robot.py": ROBOT, "pyproject.toml": "[tool.robotpy]\nrobotpy_version = '2026.1.1'\nrobotpy_extras = []\n"}
    found = results_of(make_project(files).run("doctor", "--no-robot", "--json"))
    assert found["project"][1]["remedy"] == "Rename it to components."
    hints = {
        topic: each["remedy"] for topic, findings in found.items() for each in findings if each["status"] == "hint"
    }
    assert hints["physics"] == hints["sim/config.json"] == "pyfrc create-physics"
    assert hints["tests"].startswith("pyfrc add-tests")
    assert "wpilib==2026.1.1" in found["project"][0]["remedy"]


# --- the robot


@contextmanager
def server(says: bytes) -> Iterator[str]:
    """A server that sends fixed data."""
    with socket.create_server(("127.0.0.1", 0)) as listening:

        def answer() -> None:
            connected, _ = listening.accept()
            connected.sendall(says)
            connected.close()

        thread = threading.Thread(target=answer)
        thread.start()
        yield f"127.0.0.1:{listening.getsockname()[1]}"
        thread.join()


@pytest.mark.slow
def test_a_robot_that_is_off(make_project) -> None:
    """A robot that is not found is a problem if the user has specified it, else a hint."""
    with refusing_port() as port:
        address = f"127.0.0.1:{port}"
        preferences = {".wpilib/wpilib_preferences.json": json.dumps({"robotHostname": address})}
        project = make_project({"robot.py": ROBOT} | preferences)
        (*_, finding) = results_of(project.run("doctor", "--json"))["robot"]
        assert (finding["status"], finding["text"]) == ("hint", f"{address}: no robot found")
        (*_, finding) = results_of(project.run("doctor", "--json", "--robot", address))["robot"]
        assert finding["status"] == "problem"


@pytest.mark.slow
def test_a_team_number_that_is_none(make_project) -> None:
    project = make_project({"robot.py": ROBOT, ".wpilib/wpilib_preferences.json": '{"teamNumber": "red"}'})
    (finding,) = results_of(project.run("doctor", "--json"))["robot"]
    assert finding["status"] == "problem"
    assert "teamNumber" in finding["text"]


@pytest.mark.slow
def test_the_next_step_is_the_last_thing_that_is_shown(make_project) -> None:
    project = make_project({"robot.py": ROBOT})
    (step,) = results_of(project.run("doctor", "--json"))["next step"]
    assert step["text"] == "1 of 6, the team number"
    with refusing_port() as port:
        result = project.run("doctor", "--robot", f"127.0.0.1:{port}")
    *_, step, remedy, _, count = result.stdout.splitlines()
    assert step == "hint    next step: 2 of 6, the downloads for the robot"
    assert remedy.startswith("          With internet: pyfrc sync.")
    assert count == "1 problem"
    assert "next step" not in project.run("doctor", "--no-robot").stdout


def test_only_one_result_about_the_robot(make_project) -> None:
    assert make_project({}).run("doctor", "--no-robot", "--team", "1").code == 2


@pytest.mark.slow
def test_problems_come_first_and_extras_when_asked(make_project) -> None:
    settings = """
        [tool.robotpy]
        requires = ["pyfrc==2026.0.1", "none-such==1.0; platform_machine != 'roborio'"]
        components = ["command2"]
    """
    project = make_project({"robot.py": ROBOT, "pyproject.toml": settings})
    result = project.run("doctor", "--no-robot")
    assert result.code == 1
    order = [line.split()[0] for line in result.stdout.splitlines() if line[:1].isalpha()]
    assert order == sorted(order, key=["problem", "hint", "ok"].index)
    assert 'pip install "none-such==1.0"\n' in result.stdout
    assert "Did you mean 'commands2'?" in result.stdout
    assert 'pip install "pyfrc' not in result.stdout
    assert "a robot does not need pyfrc" in result.stdout
    assert "extras:" not in result.stdout
    assert "extras:" in project.run("doctor", "--no-robot", "--extras").stdout
