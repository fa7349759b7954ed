"""What the documentation shows works: its files are written into a new project, its commands are run there."""

from __future__ import annotations

import re
import shlex
import shutil
import subprocess
import sys
from collections.abc import Iterable
from dataclasses import asdict
from pathlib import Path

import click
import pytest
from conftest import SHORT_MATCH, add_settings, sampled
from loops import for_each
from projects_of_before import OF_2019, OF_TODAY
from test_virtual_robot import started

from pyfrc_cli.main import COMMANDS, cli, loaded
from pyfrc_core.config.settings import FuzzSettings

ROOT = Path(__file__).parents[1]
CONTEXT = click.Context(cli)
#: A block: its file, if the line above names one, its language, and its text.
BLOCK = re.compile(r"(?:^`([^`\n]+)`:\n\n)?^```(\w+)\n(.*?)^```$", re.MULTILINE | re.DOTALL)
#: How much robot time a campaign took, and how many runs to shorten its script: another Python may need others.
TAKEN = re.compile(r"\d+[.]\d\d h|\d+ runs")


def blocks(document: str, language: str) -> list[str]:
    text = (ROOT / document).read_text("utf-8")
    return [block for _, found, block in BLOCK.findall(text) if found == language]


def files(document: str) -> dict[str, str]:
    """The documentation's examples in Python and JSON, by the file's name in the line above."""
    text = (ROOT / document).read_text("utf-8")
    named = {name: block for name, language, block in BLOCK.findall(text) if name and language in ("python", "json")}
    assert set(blocks(document, "python")) <= set(named.values()), f"an example in {document} is no file"
    return named


#: The rule of a turret, which the robot of `pyfrc init` has not.
RULES = "tests/rules.py"


def files_of(pages: Iterable[str]) -> dict[str, str]:
    return {name: text for page in pages for name, text in files(f"docs/{page}").items()}


def commands(document: str) -> list[str]:
    return [line.removeprefix("$ ") for block in blocks(document, "console") for line in block.splitlines()]


#: Where a page says nothing of how long matches are.
SHORT_MATCHES = SHORT_MATCH + "\n[tool.pyfrc.fuzz]\nmatch_seconds = 5\n"


@pytest.fixture(scope="module")
def written(make_shared_project):
    """What `pyfrc init` writes."""
    project = make_shared_project({})
    result = project.run_here("init")
    assert result.code == 0, result.output
    return project


@pytest.fixture
def new_project(written, make_project):
    project = make_project({})
    project.copy(written.path)
    return project


@pytest.fixture
def project(new_project):
    """A new project, with short matches."""
    add_settings(new_project.path, SHORT_MATCHES)
    return new_project


TESTING = (
    "explanation/time.md",
    "how_to/keep_a_rule.md",
    "how_to/test_a_lost_driver_station.md",
    "how_to/a_motor_does_nothing.md",
    "how_to/test_a_limit_switch.md",
    "how_to/test_an_autonomous.md",
    "how_to/write_a_test.md",
    "reference/hal_data.md",
    "reference/ready_made_tests.md",
    "reference/testing.md",
)


@pytest.mark.slow
def test_the_examples_in_the_testing_guide_pass(new_project) -> None:
    examples = files_of(TESTING)
    examples["switch/robot.py"] = files("docs/how_to/test_a_limit_switch.md")["elevator/robot.py"]
    for file in [RULES, *(file for file in examples if file.startswith("elevator/"))]:
        del examples[file]
    new_project.write(examples)
    for directory, tests in (("two_modes", 2), ("switch", 1)):
        result = new_project.run("test", "--project", directory, "--", "-v")
        assert list(result.outcomes().values()) == ["PASSED"] * tests, result.output
        shutil.rmtree(new_project.path / directory)
    (settings,) = blocks("docs/reference/settings.md", "toml")
    for real, short in (("autonomous = 15", "autonomous = 2"), ("teleop = 135", "teleop = 5")):
        assert real in settings
        settings = settings.replace(real, short)
    add_settings(new_project.path, settings)
    result = new_project.run("test", "--", "-v")
    assert result.code == 0, result.output
    for file in examples:
        assert not file.startswith("tests/") or any(test.startswith(f"{file}::") for test in result.outcomes()), file


PHYSICS_PAGES = (
    "how_to/simulate_a_camera.md",
    "how_to/simulate_a_drivetrain.md",
    "how_to/simulate_an_arm.md",
    "how_to/simulate_can_motors.md",
    "how_to/test_a_limit_switch.md",
    "how_to/test_an_autonomous.md",
    "reference/physics.md",
)
#: The robots and tests of physics that the pages show without.
TESTS_OF_PHYSICS = {
    "camera/robot.py": """
import wpilib


class MyRobot(wpilib.TimedRobot):
    def robotInit(self):
        self.left_motor = wpilib.PWMSparkMax(0)
        self.right_motor = wpilib.PWMSparkMax(1)

    def autonomousPeriodic(self):
        found, _, offset, distance = wpilib.SmartDashboard.getNumberArray("target", [0, 0, 0, 0])
        forward = 0.5 if found and distance > 5 else 0.0
        turn = 0.02 * offset if found else 0.2
        self.left_motor.set(forward + turn)
        self.right_motor.set(-(forward - turn))
""",
    "camera/sim/config.json": """
{
  "pyfrc": {
    "robot": { "starting_x": 15, "starting_y": 5, "starting_angle": 0 }
  }
}
""",
    "camera/tests/test_camera.py": """
import math


def test_finds_the_target(control, robot, physics_controller):
    control.set_autonomous(enabled=True)
    control.run_test(lambda tm: tm < 15)
    distance, angle = physics_controller.get_offset(30, 10)
    assert math.isclose(distance, 5, abs_tol=0.5)
    assert abs(angle) > 150  # seen from the target, the robot is in the west
""",
    "rolling/robot.py": """
    import wpilib


    class MyRobot(wpilib.TimedRobot):
        def robotInit(self):
            self.left_motor = wpilib.PWMSparkMax(0)
            self.right_motor = wpilib.PWMSparkMax(1)
            self.right_motor.setInverted(True)
            self.encoder = wpilib.Encoder(0, 1)
            self.encoder.setDistancePerPulse(0.001)  # feet

        def robotPeriodic(self):  # also while disabled
            self.left_motor.set(1)
            self.right_motor.set(1)
""",
    "rolling/tests/test_rolling.py": """
    def test_it_comes_to_rest(control, robot, physics_controller):
        with control.run_robot():
            control.step_timing(seconds=1, autonomous=False, enabled=False)
            assert robot.encoder.getDistance() == 0  # although robotPeriodic sets both motors

            control.step_timing(seconds=1, autonomous=False, enabled=True)
            driven = robot.encoder.getDistance()
            control.step_timing(seconds=5, autonomous=False, enabled=False)
            assert robot.encoder.getDistance() > driven + 0.5  # feet
            assert robot.left_motor.get() == 1

            x, y, angle = physics_controller.get_position()
            assert abs(robot.encoder.getDistance() - x) < 0.01
""",
}
PHYSICS = {
    name: text
    for name, text in files_of(PHYSICS_PAGES).items()
    if name.partition("/")[0] not in ("switch", "two_modes")
} | TESTS_OF_PHYSICS
PHYSICS_PROJECTS = sorted({file.rpartition("/")[0] for file in PHYSICS if f"/{file}".endswith("/physics.py")})


@pytest.mark.slow
@pytest.mark.parametrize("directory", sampled(PHYSICS_PROJECTS, *PHYSICS_PROJECTS[::3]))
def test_the_examples_in_the_physics_guide_pass(directory: str, project) -> None:
    if directory == "can":
        pytest.importorskip("rev")
    project.write(PHYSICS)
    result = project.run("test", "--", "-v", cwd=project.path / directory)
    assert result.code == 0, result.output
    here = f"{directory}/tests/".removeprefix("/")
    for file in PHYSICS:
        if file.startswith(here):
            assert any(test.startswith(f"{file.removeprefix(directory + '/')}::") for test in result.outcomes()), file


@pytest.mark.slow
def test_the_examples_in_the_replay_guide_work(project) -> None:
    project.write(files("docs/how_to/record_and_replay.md"))
    result = project.run("test", "--", "-v")
    assert result.outcomes()["tests/test_replay.py::test_the_script"] == "PASSED", result.output
    for command in commands("docs/how_to/record_and_replay.md"):
        result = project.run(*shlex.split(command)[1:])
        assert result.code == 0, result.output


@pytest.mark.slow
def test_the_examples_in_the_fuzzing_guide_work(make_project) -> None:
    """The robot has a bug, which is found, kept and replayed; repaired, it has none."""
    document, rules = "docs/how_to/find_crashes.md", "docs/how_to/keep_a_rule.md"
    project = make_project(files(document) | {RULES: files(rules)[RULES]})
    campaigns = [command for command in commands(document) if "--time" in command]
    for command in commands(document):
        if command not in campaigns:
            result = project.run(*shlex.split(command)[1:])
            assert result.code == 1, result.output
        if "--runs" in command:
            example, found = blocks(document, "text")[0], without_progress(result.stdout).strip()
            assert re.sub(TAKEN, "N", found) in re.sub(TAKEN, "N", example), result.output
    robot = project.path / "robot.py"
    repaired = robot.read_text("utf-8").replace("270: -0.5}", "270: -0.5, 315: -0.3}")
    robot.write_text(repaired.rpartition("        else:\n")[0], "utf-8")
    result = project.run("fuzz", "--seed", "1", "--runs", "8")
    broken, found = (re.sub(r"\b(is|at) -?[\d.]+", r"\1 N", text) for text in (blocks(rules, "text")[0], result.stdout))
    assert broken in found, result.output  # another seed, another POV
    for file in (project.path / "tests/fuzz").glob("invariant-*"):
        file.unlink()
    robot.write_text(repaired, "utf-8")
    project.write({"pyproject.toml": blocks("docs/reference/fuzz_findings.md", "toml")[0]})
    add_settings(project.path, SHORT_MATCH)
    assert len(campaigns) == 2
    for command in ["pyfrc test", *campaigns]:
        result = project.run(*shlex.split(re.sub(r"--time \d+", "--time 0.1", command))[1:])
        assert result.code == 0, result.output


@pytest.mark.slow
def test_the_examples_in_the_simulation_guide_work(project) -> None:
    for command in commands("docs/how_to/simulate_without_a_window.md"):
        result = project.run(*shlex.split(command)[1:])
        assert result.code == 0, result.output
    project.write(files_of(["how_to/draw_on_the_field.md", "how_to/simulate_in_a_program.md"]))
    result = project.run("sim", "--ui", "none", "--mode", "auto", "--seconds", "1", "--project", "drawing")
    assert result.code == 0, result.output
    done = subprocess.run(
        [sys.executable, "tools/drive.py"], cwd=project.path, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    assert "failure: None\nmode: autonomous\nleft motor: 0.49" in done.stdout, done.stdout


@pytest.mark.slow
def test_the_examples_in_the_guide_to_logs_work(project) -> None:
    for command in commands("docs/how_to/look_at_a_log.md") + commands("docs/how_to/compare_with_a_log.md"):
        result = project.run(*shlex.split(command)[1:])
        assert result.code == 0, result.output
    assert {file.name for file in (project.path / ".runs").glob("*.html")} == {"before.html", "both.html"}


@pytest.mark.slow
def test_the_robot_in_the_guide_to_2027_becomes_what_is_shown_there(make_project) -> None:
    pytest.importorskip("libcst")
    document = "docs/how_to/from_2026_to_2027.md"
    project = make_project(files(document))
    check, migrate = (shlex.split(command)[1:] for command in commands(document))
    assert project.run(*check).code == 1
    result = project.run(*migrate)
    assert result.stdout == blocks(document, "text")[0]
    assert blocks(document, "py")[0] in (project.path / "robot.py").read_text("utf-8")


COMING_FROM = {"docs/how_to/from_pyfrc_2019.md": OF_2019, "docs/how_to/from_todays_pyfrc.md": OF_TODAY}


@pytest.mark.parametrize("document", sampled(list(COMING_FROM)))
def test_the_project_of_those_who_come_from_elsewhere_works_as_it_is(document: str, make_project) -> None:
    """But for the length of teleop; autonomous is as long as the way that the robot is to drive in it."""
    files = COMING_FROM[document]
    project = make_project(files)
    add_settings(project.path, "[tool.pyfrc.match]\nteleop = 5\n")
    for command in commands(document):
        result = project.run(*shlex.split(command)[1:])
        assert result.code == 0, result.output
        if " sim " in command:
            assert re.search(r"distance driven: .*\([1-9][0-9.]* m\)", result.stdout)
        for file in files if command == "pyfrc test" else ():
            if file.startswith("tests/test_"):
                assert f"\n{file} ." in result.stdout, file
    assert "pyfrc test" in commands(document)


@for_each("document", COMING_FROM)
def test_the_commands_that_take_the_place_of_others_exist(document: str) -> None:
    named = re.findall(r"`pyfrc ([^`]+)`", (ROOT / document).read_text("utf-8"))
    assert len(named) >= 10
    for words in map(str.split, named):
        options = {option for parameter in cli.get_command(CONTEXT, words[0]).params for option in parameter.opts}
        assert {word for word in words[1:] if word.startswith("-")} <= options, words


@pytest.mark.slow
def test_the_measuring_guides_reports_are_written(project) -> None:
    for command in commands("docs/how_to/measure_coverage.md"):
        if "html" in command:
            result = project.run(*shlex.split(command)[1:])
            assert result.code == 0, result.output
            for file in ("htmlcov/index.html", "coverage.xml"):
                (project.path / file).unlink()
    assert (project.path / "coverage.json").is_file()
    (command,) = (each for each in commands("docs/reference/profile.md") if " fuzz " in each)
    result = project.run(*shlex.split(command)[1:])
    assert result.code == 0, result.output


@pytest.mark.slow
def test_the_example_of_a_slow_robot_is_measured(make_project) -> None:
    document = "docs/how_to/loop_overruns.md"
    project = make_project(files(document))
    (project.path / "slow/pyproject.toml").write_text(SHORT_MATCHES, "utf-8")
    (command,) = commands(document)
    result = project.run(*shlex.split(command)[1:])
    assert result.code == 0, result.output
    assert re.search(r"^  MyRobot.teleopPeriodic +[0-9.]+ ms", result.stdout, re.MULTILINE), result.output


#: Pages with commands that no test here runs: each is in a test of what it does.
NOT_RUN = (
    "explanation/isolation.md",
    "how_to/create_physics.md",
    "how_to/find_what_is_wrong.md",
    "how_to/tests_are_slow.md",
)


def test_each_command_in_the_pages_has_these_options(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    assert all(commands(f"docs/{page}") for page in NOT_RUN)
    for directory in ("slow", "leaving"):
        (tmp_path / directory).mkdir()
    monkeypatch.chdir(tmp_path)
    pages = [ROOT / "README.md", *(ROOT / "docs").rglob("*.md")]
    text = "".join(block for page in pages for kind in ("console", "sh") for block in blocks(str(page), kind))
    found = re.findall(r"^(?:\$ )?pyfrc (?:-v )?(.+)$", text, re.MULTILINE)
    assert len(found) > 60
    for words in found:
        name, *arguments = shlex.split(words, comments=True)
        parse(name, arguments)


def parse(name: str, arguments: list[str]) -> None:
    """Parse a command's arguments, those of a command within it, too."""
    command = loaded(name)
    if isinstance(command, click.Group):
        name, *arguments = arguments
        command = command.commands[name]
    inner = command.make_context(name, arguments).params.get("command_line")
    if inner:
        parse(inner[0], list(inner[1:]))


SELECTING = [command for page in TESTING for command in commands(f"docs/{page}") if " -k " in command]


@pytest.mark.slow
def test_the_guides_commands_select_tests(project) -> None:
    project.write(files("docs/how_to/a_motor_does_nothing.md"))
    assert len(SELECTING) >= 2
    for command in SELECTING:
        result = project.run(*shlex.split(command)[1:])
        assert result.code == 0, result.output


def shows(expected: str, printed: str) -> bool:
    """Whether this is what a page shows: ``...`` stands for any lines; numbers of lines and bytes are compared."""
    parts = [re.escape(part.strip("\n")) for part in re.split(r"^[.]{3}$", alike(expected), flags=re.MULTILINE)]
    return re.search(r"^" + r"(?:.*\n)*?".join(f"{part}\n?" for part in parts) + r"\Z", alike(printed)) is not None


def without_progress(printed: str) -> str:
    """Return what a campaign prints without how far it was by then, which a slow computer prints, too."""
    *lines, last = printed.splitlines()
    return "\n".join([*(line for line in lines if not re.match(r"[\d,]+ match", line)), last, ""])


def alike(text: str) -> str:
    text = re.sub(r"SHA256:\S+ \([\w-]+\)", "SHA256", text)
    text = re.sub(r"([.]py:)?\d+([.,:]\d+)*( bytes)?", lambda found: found[0] if found[1] or found[3] else "0", text)
    return "\n".join(re.sub(r"={3,}|  +", " ", line).strip() for line in text.strip().splitlines()) + "\n"


@pytest.mark.slow
def test_the_tutorial_leads_from_nothing_to_a_deployed_robot(make_project, tmp_path: Path) -> None:
    """Its files, commands and outputs, in their order; a line in a block without a file's name replaces its like."""
    project = make_project({})
    text = (ROOT / "docs/tutorials/first_robot.md").read_text("utf-8")
    place, done = project.path, []
    with started(project, tmp_path / "robot") as robot:
        for name, language, block in BLOCK.findall(text):
            if language == "python":
                (place / name).write_text(block, "utf-8")
            elif language == "py":
                lines = (place / "robot.py").read_text("utf-8").splitlines(keepends=True)
                (number,) = (each for each, line in enumerate(lines) if line.startswith(f"{block.partition('=')[0]}="))
                lines[number] = block
                (place / "robot.py").write_text("".join(lines), "utf-8")
            elif language == "console":
                for step in re.split(r"^\$ ", block, flags=re.MULTILINE)[1:]:
                    command, _, expected = step.partition("\n")
                    program, *arguments = shlex.split(command)
                    done.append(arguments[0])
                    if program == "cd":
                        place /= arguments[0]
                        add_settings(place, SHORT_MATCH)
                        continue
                    assert program == "pyfrc"
                    arguments = [robot.address if part == "127.0.0.1:2222" else part for part in arguments]
                    result = project.run(*arguments, cwd=place)
                    assert result.code == (1 if arguments[0] in ("fuzz", "replay") else 0), result.output
                    printed = without_progress(result.output) if arguments[0] == "fuzz" else result.output
                    assert shows(expected, printed), (command, result.output)
    assert {"init", "test", "sim", "fuzz", "replay", "deploy"} <= set(done)


def test_outputs_are_compared() -> None:
    assert shows("...\na 0.1 s\n...\nend\n", "x\ny\na 25.3 s\nb\nend\n")
    assert not shows("a\nend\n", "a\nb\nend\n")
    assert not shows("...\nfailed\n", "passed\n")
    assert not shows("robot.py:35: no key 315\n", "robot.py:36: no key 45\n")


def test_the_files_of_a_project_are_listed(written) -> None:
    page = (ROOT / "docs/reference/templates.md").read_text("utf-8")
    named = re.findall(r"^\| `([^`*]+)`", page, re.MULTILINE)
    assert len(named) >= 7
    assert [name for name in named if not (written.path / name).exists()] == []


def test_the_readmes_example_passes(project) -> None:
    project.write(files("README.md"))
    result = project.run("test", "--", "-q")
    assert result.code == 0, result.output


def test_the_readmes_commands_exist_in_the_makefile() -> None:
    makefile = (ROOT / "Makefile").read_text("utf-8")
    first = blocks("README.md", "console")[0]
    for line in first.splitlines():
        target = shlex.split(line, comments=True)[2]
        assert re.search(rf"^{target}:", makefile, re.MULTILINE)


def test_the_table_of_commands_lists_every_command() -> None:
    (table,) = re.findall(r"^\| command \|.*\n(?:\|.*\n)+", (ROOT / "README.md").read_text("utf-8"), re.MULTILINE)
    first_column = "".join(row.split("|")[1] for row in table.splitlines()[2:])
    named = {name.removeprefix("pyfrc ") for name in re.findall(r"`([^`]+)`", first_column)}
    # A module's first name is its command, others are older names of it.
    names = {module: name for name, (module, _) in reversed(COMMANDS.items())}
    assert named == set(names.values())


def test_the_fuzzing_guide_lists_every_check() -> None:
    checks = {name for name, value in asdict(FuzzSettings()).items() if isinstance(value, bool)}
    document = "docs/reference/fuzz_findings.md"
    text = (ROOT / document).read_text("utf-8")
    (table,) = re.findall(r"^\| setting \|.*\n(?:\|.*\n)+", text, re.MULTILINE)
    assert set(re.findall(r"^\| `(\w+)` \|", table, re.MULTILINE)) == checks


@for_each(
    "document",
    [
        "README.md",
        "CONTRIBUTING.md",
        "ARCHITECTURE.md",
        "benchmarks/README.md",
        *sorted(file.relative_to(ROOT).as_posix() for file in (ROOT / "docs").rglob("*.md")),
    ],
)
def test_links_lead_somewhere(document: str) -> None:
    for target in re.findall(r"\]\(([^)\s]+)\)", (ROOT / document).read_text("utf-8")):
        if not target.startswith("http"):
            name, _, heading = target.partition("#")
            file = ROOT / document if not name else (ROOT / document).parent / name
            assert file.exists(), target
            assert not heading or heading in headings(file), target


def headings(file: Path) -> list[str]:
    """Return the names by which links lead to headings of a page."""
    titles = re.findall(r"^#+ (.*)$", file.read_text("utf-8"), re.MULTILINE)
    return [re.sub(r"[^\w -]", "", title.lower()).replace(" ", "-") for title in titles]


def test_the_modules_in_the_map_exist() -> None:
    """Those with a room before them, such as `runtime.clock`; a name after a module's is one of the module's own."""
    text = (ROOT / "ARCHITECTURE.md").read_text("utf-8")
    rooms = {path.parent.name for path in (ROOT / "pyfrc_core").glob("*/__init__.py")} | {"pyfrc_cli"}
    named = [name for name in re.findall(r"`([a-z_]+(?:[.][A-Za-z_]+)+)`", text) if name.partition(".")[0] in rooms]
    assert len(named) >= 30
    for name in named:
        path, parts = ROOT if name.startswith("pyfrc_cli") else ROOT / "pyfrc_core", name.split(".")
        while parts and (path / parts[0]).is_dir():
            path /= parts.pop(0)
        module = path / f"{parts.pop(0)}.py" if parts else path / "__init__.py"
        assert module.is_file(), name
        assert all(
            re.search(rf"^(?:class|def) {part}\b", module.read_text("utf-8"), re.MULTILINE) for part in parts[:1]
        ), name


@for_each("document, most", [("ARCHITECTURE.md", 12_000), ("benchmarks/README.md", 6_000)])
def test_a_page_to_read_at_once_stays_short(document: str, most: int) -> None:
    assert len((ROOT / document).read_bytes()) <= most


def test_every_room_says_what_it_is_for() -> None:
    for file in (ROOT / "pyfrc_core").rglob("__init__.py"):
        assert file.read_text("utf-8").startswith('"""'), file


def test_each_place_outside_of_a_project_is_listed() -> None:
    """Where a module asks for a user's directory, and what the list of such files has for it."""
    listed = {
        "deploy/host_keys.py": "`~/.pyfrc/known_hosts`",
        "physics/registry.py": "caches, `pint-...`",
        "sim/ui/web/recorded_page.py": "",  # writes nothing there
        "sim/view.py": "user data, `view`",
        "sync/cache.py": "`~/wpilib/YEAR/robotpy`",
        "virtual_robot/robot.py": "user data, `virtual-robot`",
    }
    core = ROOT / "pyfrc_core"
    asks = re.compile(r"platformdirs\.user_|Path\.home\(\)|\.expanduser\(")
    found = {file.relative_to(core).as_posix() for file in core.rglob("*.py") if asks.search(file.read_text("utf-8"))}
    assert found == listed.keys()
    text = (ROOT / "docs/reference/commands.md").read_text("utf-8")
    for name in filter(None, listed.values()):
        assert f"| {name} |" in text
