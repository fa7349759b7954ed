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

from pyfrc_cli.main import COMMANDS, cli
from pyfrc_core.config.settings import FuzzSettings
from pyfrc_core.scaffold import TEMPLATES

ROOT = Path(__file__).parents[1]
CONTEXT = click.Context(cli)
BLOCK = re.compile(r"^```(\w+)\n(.*?)^```$", re.MULTILINE | re.DOTALL)
#: How much robot time a campaign took, and how many runs to shorten its script: another Python may need others.
TAKEN = re.compile(r"\d+[.]\d\d h|\d+ runs")


def blocks(document: str, language: str) -> list[str]:
    text = (ROOT / document).read_text("utf-8")
    return [block for found, block in BLOCK.findall(text) if found == language]


def files(document: str) -> dict[str, str]:
    """The documentation's Python examples, by the file name in their first line."""
    named = {}
    for block in blocks(document, "python"):
        first, _, rest = block.partition("\n")
        assert first.startswith("# "), f"an example that is no file: {block}"
        named[first.removeprefix("# ")] = rest
    return named


#: The rule of a turret, which the robot of `pyfrc init` has not.
RULES = "tests/rules.py"


def files_of(pages: Iterable[str]) -> dict[str, str]:
    return {name: text for page in pages for name, text in files(f"docs/{page}").items()}


def json_files(document: str) -> dict[str, str]:
    """Its JSON examples, by the file name in the line above: JSON has no comments."""
    text = (ROOT / document).read_text("utf-8")
    return dict(re.findall(r"^`([^`]+[.]json)`:\n\n```json\n(.*?)^```$", text, re.MULTILINE | re.DOTALL))


def commands(document: str) -> list[str]:
    return [line.removeprefix("$ ") for block in blocks(document, "console") for line in block.splitlines()]


#: Where a page says nothing of how long matches are.
SHORT_MATCHES = SHORT_MATCH + "\n[tool.pyfrc.fuzz]\nmatch_seconds = 5\n"


@pytest.fixture(scope="module")
def written(make_shared_project):
    """What `pyfrc init` writes."""
    project = make_shared_project({})
    result = project.run("init")
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


def test_the_examples_in_the_testing_guide_pass(new_project) -> None:
    examples = files_of(TESTING)
    examples["switch/robot.py"] = files("docs/how_to/test_a_limit_switch.md")["elevator/robot.py"]
    for file in [RULES, *(file for file in examples if file.startswith("elevator/"))]:
        del examples[file]
    new_project.write(examples)
    for directory, tests in (("two_modes", 3), ("switch", 1)):
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
    "how_to/create_physics.md",
    "how_to/simulate_a_camera.md",
    "how_to/simulate_a_drivetrain.md",
    "how_to/simulate_an_arm.md",
    "how_to/test_a_limit_switch.md",
    "reference/physics.md",
)
PHYSICS = files_of(PHYSICS_PAGES)
PHYSICS_PROJECTS = sorted({file.rpartition("/")[0] for file in PHYSICS if f"/{file}".endswith("/physics.py")})


@pytest.mark.parametrize("directory", sampled(PHYSICS_PROJECTS, *PHYSICS_PROJECTS[::3]))
def test_the_examples_in_the_physics_guide_pass(directory: str, project) -> None:
    project.write(PHYSICS | json_files("docs/how_to/simulate_a_camera.md"))
    result = project.run("test", "--", "-v", cwd=project.path / directory)
    assert result.code == 0, result.output
    here = f"{directory}/tests/".removeprefix("/")
    for file in PHYSICS:
        if file.startswith(here):
            assert any(test.startswith(f"{file.removeprefix(directory + '/')}::") for test in result.outcomes()), file


@pytest.mark.slow
def test_the_examples_in_the_replay_guide_work(project) -> None:
    (script,) = re.findall(
        r"^`(tests/.+[.]jsonl)`:$", (ROOT / "docs/how_to/record_and_replay.md").read_text("utf-8"), re.MULTILINE
    )
    project.write(
        files("docs/how_to/record_and_replay.md") | {script: blocks("docs/how_to/record_and_replay.md", "json")[0]}
    )
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
    written = commands(document) + commands("docs/explanation/fuzzing.md")
    campaigns = [command for command in written if "--time" in command]
    for command in written:
        if command not in campaigns:
            result = project.run(*shlex.split(command)[1:])
            assert result.code == 1, result.output
        if "--runs" in command:
            *lines, last = result.stdout.splitlines()
            findings = [line for line in lines if not re.match(r"[\d,]+ match", line)]  # without how far it was by then
            example, found = blocks(document, "text")[0], "\n".join([*findings, last])
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
    pytest.importorskip("PIL")
    pages = [f"docs/how_to/{page}.md" for page in ("drive_in_the_browser", "simulate_without_a_window")]
    for command in [command for page in pages for command in commands(page)]:
        result = project.run(*shlex.split(command)[1:])
        assert result.code == 0, result.output
    assert (project.path / ".runs/path.png").is_file()
    project.write(files_of(["how_to/draw_on_the_field.md", "how_to/simulate_in_a_program.md"]))
    result = project.run("sim", "--ui", "none", "--mode", "auto", "--seconds", "1", "--project", "drawing")
    assert result.code == 0, result.output
    done = subprocess.run(
        [sys.executable, "tools/drive.py"], cwd=project.path, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    assert "failure: None\nmode: autonomous\nleft motor: 0.49" in done.stdout, done.stdout


def test_the_examples_in_the_guide_to_logs_work(project) -> None:
    for command in commands("docs/how_to/look_at_a_log.md") + commands("docs/how_to/compare_with_a_log.md"):
        result = project.run(*shlex.split(command)[1:])
        assert result.code == 0, result.output
    assert {file.name for file in (project.path / ".runs").glob("*.html")} == {"before.html", "both.html"}


def test_the_robot_in_the_guide_to_2027_becomes_what_is_shown_there(make_project) -> None:
    pytest.importorskip("libcst")
    document = "docs/how_to/from_2026_to_2027.md"
    project = make_project(files(document))
    check, migrate = (shlex.split(command)[1:] for command in commands(document))
    assert project.run(*check).code == 1
    result = project.run(*migrate)
    assert result.stdout == blocks(document, "text")[0]
    assert (project.path / "robot.py").read_text("utf-8") == blocks(document, "py")[0]


def test_the_guide_to_2027_lists_every_option() -> None:
    (table,) = re.findall(
        r"^\| option \|.*\n(?:\|.*\n)+", (ROOT / "docs/reference/migrate.md").read_text("utf-8"), re.MULTILINE
    )
    options = {name for each in cli.get_command(CONTEXT, "migrate").params for name in each.opts if name[:2] == "--"}
    assert set(re.findall(r"`(--\w+)`", table)) == options - {"--project", "--verbose", "--quiet"}


def test_the_robot_of_2026_on_the_page_of_2027_passes(make_project) -> None:
    examples = files("docs/reference/wpilib_2027.md")
    ours = {name.removeprefix("robot_2026/"): text for name, text in examples.items() if name.startswith("robot_2026/")}
    result = make_project(ours).run("test", "--", "-v")
    assert list(result.outcomes().values()) == ["PASSED"], result.output


COMING_FROM = ("docs/how_to/from_pyfrc_2019.md", "docs/how_to/from_todays_pyfrc.md")


@pytest.mark.parametrize("document", sampled(COMING_FROM))
def test_the_project_of_those_who_come_from_elsewhere_works_as_it_is(document: str, make_project) -> None:
    """But for the length of teleop; autonomous is as long as the way that the robot is to drive in it."""
    project = make_project(files(document) | json_files(document))
    add_settings(project.path, "[tool.pyfrc.match]\nteleop = 5\n")
    for command in commands(document):
        result = project.run(*shlex.split(command)[1:])
        assert result.code == 0, result.output
        if " sim " in command:
            assert re.search(r"distance driven: .*\([1-9][0-9.]* m\)", result.stdout)
        for file in files(document) if command == "pyfrc test" else ():
            if file.startswith("tests/test_"):
                assert f"\n{file} ." in result.stdout, file
    assert "pyfrc test" in commands(document)


@pytest.mark.parametrize("document", COMING_FROM)
def test_the_commands_that_take_the_place_of_others_exist(document: str) -> None:
    named = re.findall(r"`pyfrc ([^`]+)`", (ROOT / document).read_text("utf-8"))
    assert len(named) >= 10
    for words in map(str.split, named):
        options = {option for parameter in cli.get_command(CONTEXT, words[0]).params for option in parameter.opts}
        assert {word for word in words[1:] if word.startswith("-")} <= options, words


@pytest.mark.slow
def test_the_commands_in_the_measuring_guide_work(project) -> None:
    for command in [*commands("docs/how_to/measure_coverage.md")[2:], *commands("docs/reference/profile.md")]:
        if "--html profile.html" in command:
            pytest.importorskip("pyinstrument")
        result = project.run(*shlex.split(command)[1:])
        assert result.code == 0, result.output
    coverage, profile = ("htmlcov/index.html", "coverage.xml", "coverage.json"), ("json", "pstats", "html")
    for file in (*coverage, *(f"profile.{each}" for each in profile)):
        assert (project.path / file).is_file(), file


@pytest.mark.slow
def test_the_examples_of_a_slow_and_a_fast_robot_work(make_project) -> None:
    document = "docs/how_to/loop_overruns.md"
    project = make_project(files(document))
    medians = {}
    for command in commands(document):
        program, *arguments = shlex.split(command)
        assert program == "pyfrc"
        directory = arguments[arguments.index("--project") + 1]
        (project.path / directory / "pyproject.toml").write_text(SHORT_MATCHES, "utf-8")
        result = project.run(*arguments)
        assert result.code == 0, result.output
        (median,) = re.findall(r"^  MyRobot.teleopPeriodic +([0-9.]+) ms", result.stdout, re.MULTILINE)
        medians[directory] = float(median)
    assert medians["fast"] < medians["slow"]


GUIDES_COMMANDS = [
    command
    for page in (
        *TESTING,
        *PHYSICS_PAGES,
        "explanation/isolation.md",
        "how_to/measure_coverage.md",
        "how_to/tests_are_slow.md",
    )
    for command in commands(f"docs/{page}")
    if not command.startswith("pyfrc coverage")  # they are in the test of measuring
]


@pytest.mark.parametrize("command", sampled(GUIDES_COMMANDS, "pyfrc test --no-isolation"))
def test_the_commands_in_the_guides_work(command: str, project) -> None:
    program, *arguments = shlex.split(command)
    assert program == "pyfrc"
    result = project.run(*arguments)
    assert result.code == 0, result.output


def test_the_page_on_getting_started_leads_to_a_driving_robot(make_project) -> None:
    """Its commands, one after the other, each in the directory to which those before it have led."""
    project = make_project({})
    place = project.path
    for command in commands("docs/tutorials/first_robot.md"):
        program, *arguments = shlex.split(command)
        if program == "cd":
            place /= arguments[0]
            add_settings(place, SHORT_MATCHES)
            continue
        assert program == "pyfrc"
        result = project.run(*arguments, cwd=place)
        assert result.code == 0, result.output
        if arguments[0] == "sim":
            assert re.search(r"distance driven: .*\([1-9][0-9.]* m\)", result.stdout)
    assert place != project.path


def test_the_page_on_getting_started_lists_the_templates(written) -> None:
    page = (ROOT / "docs/tutorials/first_robot.md").read_text("utf-8")
    assert re.findall(r"^\| `([a-z-]+)` \|", page, re.MULTILINE) == list(TEMPLATES)
    named = re.findall(
        r"^\| `([^`*]+)`", page.partition("Each project has")[2].partition("## Test it")[0], re.MULTILINE
    )
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


@pytest.mark.parametrize("document", ["README.md", "docs/reference/commands.md"])
def test_the_tables_of_commands_list_every_command(document: str) -> None:
    (table,) = re.findall(r"^\| command \|.*\n(?:\|.*\n)+", (ROOT / document).read_text("utf-8"), re.MULTILINE)
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
    (example,) = (block for block in blocks(document, "toml") if block.startswith("[tool.pyfrc.fuzz]"))
    assert set(re.findall(r"^(\w+) = (?:true|false)", example, re.MULTILINE)) == checks


@pytest.mark.parametrize(
    "document",
    [
        "README.md",
        "CONTRIBUTING.md",
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
    text = (ROOT / "docs/explanation/architecture.md").read_text("utf-8")
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


@pytest.mark.parametrize(
    ("document", "most"), [("docs/explanation/architecture.md", 12_000), ("benchmarks/README.md", 6_000)]
)
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
