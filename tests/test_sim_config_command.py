"""`pyfrc config`, and what `pyfrc test` tells of sim/config.json."""

from __future__ import annotations

import json

import pytest
from conftest import MakeProject

ROBOT = "import wpilib\n\nclass MyRobot(wpilib.TimedRobot):\n    pass\n"


def test_check_tells_warnings_and_mistakes(make_project: MakeProject) -> None:
    project = make_project({"robot.py": ROBOT})
    none = project.run_here("config", "check")
    assert (none.code, none.stderr) == (0, "")
    assert none.stdout == "sim/config.json: the file does not exist, so all values are defaults\n"

    project.write({"sim/config.json": '{"pyfrc": {\n"robt": {}}}'})
    warned = project.run_here("config", "check")
    assert warned.code == 0, warned.output
    assert warned.stdout == (
        "warning: sim/config.json:2: unknown key 'pyfrc.robt'\n  did you mean 'robot'?\n"
        "sim/config.json: no mistakes, but 1 warning\n"
    )

    shape = '{"color": "gren", "rect": [1, 1, 2, 2]}'
    project.write({"sim/config.json": '{"pyfrc": {"field": {"objects": [\n' + shape + "]}}}"})
    assert project.run_here("config", "check").stdout == (
        'warning: sim/config.json:2: pyfrc.field.objects[0].color = "gren": there is no such colour: '
        "did you mean 'green'?\nsim/config.json: no mistakes, but 1 warning\n"
    )

    project.write({"sim/config.json": '{"pyfrc": {"robot": {\n"w": -1}, "pwm": {\n"20": "x"}}}'})
    wrong = project.run_here("config", "check")
    assert wrong.code == 2
    assert wrong.stdout == ""
    assert wrong.stderr == (
        "error: sim/config.json:2: pyfrc.robot.w = -1: input should be greater than 0\n"
        'sim/config.json:3: pyfrc.pwm.20 = "x": the key should be a number from 0 to 19\n'
    )


def test_strict_makes_warnings_fail(make_project: MakeProject) -> None:
    project = make_project({"robot.py": ROBOT})
    for config, code in [("{}", 0), ('{"pyfrc": {"robt": {}}}', 1), ('{"pyfrc": {"robot": {"w": 0.3}}}', 1), ("", 2)]:
        project.write({"sim/config.json": config})
        assert project.run_here("config", "check", "--strict").code == code
    project.write({"sim/config.json": json.dumps({"pyfrc": {f"key{n}": n for n in range(30)}})})
    many = project.run_here("config", "check")
    assert many.code == 0
    assert many.stdout.endswith("sim/config.json: no mistakes, but more than 20 warnings\n")


def test_a_file_in_the_wrong_place_is_told(make_project: MakeProject) -> None:
    project = make_project({"robot.py": ROBOT})
    for place in ("config.json", "tests/sim/config.json", "Sim/config.json", "sim/Config.json"):
        project.write({place: '{"pyfrc": {}}'})
        if (project.path / "sim/config.json").exists():
            pytest.skip("this file system does not tell capital letters from others")
        checked = project.run_here("config", "check", "--strict")
        assert checked.code == 1
        assert checked.stdout == (
            f"warning: {place}: pyfrc does not read this file\n  Move it to sim/config.json\n"
            "sim/config.json: the file does not exist, so all values are defaults, but 1 warning\n"
        )
        project.write({place: '{"other": 1}'})  # another tool's
        assert project.run_here("config", "check", "--strict").code == 0


def test_a_file_beside_the_directory_of_the_code_is_told(make_project: MakeProject) -> None:
    project = make_project({"src/robot.py": ROBOT, "sim/config.json": '{"pyfrc": {}}'})
    told = "warning: sim/config.json: pyfrc does not read this file\n  Move it to src/sim/config.json\n"
    assert told in project.run_here("config", "check", "--project", "src").stdout
    project.write({"robot.py": ROBOT})  # whose it then is
    assert told not in project.run_here("config", "check", "--project", "src").stdout


GAMEDATA_TEST = "def test_it(gamedata):\n    pass\n"


def test_a_test_run_warns_once_of_what_has_no_effect(make_project: MakeProject) -> None:
    config = '{"pyfrc": {"field": {"season": 2018},\n"dios": {}}}'
    project = make_project({"robot.py": ROBOT, "tests/test_a.py": GAMEDATA_TEST, "sim/config.json": config})
    result = project.run("test")
    assert result.code == 0, result.output
    assert "4 passed, 1 warning" in result.stdout
    assert result.stdout.count("unknown key 'pyfrc.dios'") == 1
    _, _, summary = result.stdout.partition("warnings summary")
    assert "\n  sim/config.json:2: SettingsWarning: unknown key 'pyfrc.dios'\n" in summary
    assert ".py:" not in summary

    strict = project.run("test", "--", "-W", "error")
    assert strict.code != 0
    assert "sim/config.json:2: unknown key 'pyfrc.dios'" in strict.stdout
    assert "Traceback" not in strict.output


def test_a_test_run_tells_a_mistake(make_project: MakeProject) -> None:
    config = '{"pyfrc": {\n"game_specific_messages": [1]}}'
    project = make_project({"robot.py": ROBOT, "tests/test_a.py": GAMEDATA_TEST, "sim/config.json": config})
    result = project.run("test")
    assert result.code != 0
    assert "sim/config.json:2: pyfrc.game_specific_messages[0] = 1: input should be a valid string" in result.stdout
    assert "Traceback" not in result.output
