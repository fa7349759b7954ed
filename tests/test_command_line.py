"""The command line as people expect it: help, exit codes, colours, what was meant, completion."""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
import sys
from collections.abc import Iterator

import click
import pytest
from conftest import sampled
from loops import for_each

from pyfrc_cli.main import COMMANDS, OLDER_NAMES, cli, run

HEAVY = {"wpilib", "hal", "pytest", "pydantic", "pint", "paramiko", "hypothesis", "rich", "coverage", "numpy"}

IN_A_TERMINAL = """
import os, pty, sys
status = pty.spawn([sys.executable, "-m", "pyfrc", "doctor", "--no-robot", "--main", "none.py"])
sys.exit(os.waitstatus_to_exitcode(status))
"""


def leaves(group: click.Group, path: tuple[str, ...] = ()) -> Iterator[tuple[tuple[str, ...], click.Command]]:
    """Every command, and those within it."""
    context = click.Context(group)
    for name in group.list_commands(context):
        command = group.get_command(context, name)
        assert command is not None
        if isinstance(command, click.Group):
            yield from leaves(command, (*path, name))
        else:
            yield (*path, name), command


EVERY = dict(leaves(cli))


@for_each("path", EVERY)
def test_each_command_tells_its_exit_codes_and_has_a_short_option_for_help(path: tuple[str, ...]) -> None:
    command = EVERY[path]
    help_text = command.get_help(click.Context(command, info_name=" ".join(path), terminal_width=200))
    assert "Exit codes: " in help_text
    assert command.context_settings["help_option_names"] == ["-h", "--help"]
    for parameter in command.params:
        assert not isinstance(parameter, click.Option) or parameter.help, parameter


def help_of(option: str) -> dict[str, str]:
    """Return the help of an option in each command that has it."""
    return {
        " ".join(path): str(parameter.help)
        for path, command in EVERY.items()
        for parameter in command.params
        if isinstance(parameter, click.Option) and option in parameter.opts
    }


def test_verbose_is_described_by_what_it_does_in_each_command() -> None:
    also = {
        "test": "; print the name of each test",
        "sim": "; with --log, print each value that differs",
        "sync": "; print where each file is from",
        "coverage": ", and what -v shows in the other command",
        "profile": ", and what -v shows in the other command",
    }
    assert help_of("--verbose") == {
        " ".join(path): f"Show the whole traceback of an error, instead of one sentence{also.get(path[0], '')}."
        for path in EVERY
    }


@pytest.mark.parametrize("option", ["--main", "--robot-class"])
def test_a_file_and_a_class_are_chosen_where_the_robots_code_is_loaded(option: str) -> None:
    assert set(help_of(option)) == {"create-physics", "deploy", "doctor", "fuzz", "replay", "sim", "test"}


#: Options that mean something else in each command.
OF_EACH_COMMAND = {
    *("--verbose", "--seed", "--jobs", "--isolation", "--from", "--trace", "--page", "--record", "--share", "--port"),
    *("--robot", "--json", "--check"),
}


def test_an_option_that_means_the_same_has_the_same_help_everywhere() -> None:
    names = {name for command in EVERY.values() for each in command.params for name in each.opts if name[:2] == "--"}
    assert {name for name in names if len(set(help_of(name).values())) > 1} == OF_EACH_COMMAND


def test_no_help_has_words_that_only_pyfrcs_developers_know() -> None:
    texts = [command.get_help(click.Context(command, terminal_width=10_000)) for command in EVERY.values()]
    for word in (r"Cobertura", r"as good as new", r"in a fork\b", r"\bshards?\b(?<!--shard)", r"unattended"):
        assert not [text for text in texts if re.search(word, text)], word
    assert "a cluster of Dask, a library" in help_of("--scheduler")["fuzz"]


@pytest.mark.parametrize(("older", "name"), OLDER_NAMES.items())
def test_an_older_name_of_a_command_works_and_is_not_listed(older: str, name: str) -> None:
    context = click.Context(cli)
    assert cli.get_command(context, older) is cli.get_command(context, name)
    assert older not in cli.list_commands(context)
    assert f"  {older}" not in cli.get_help(context)
    assert older not in [each.value for each in cli.shell_complete(context, "")]


def test_the_same_option_is_of_the_same_kind_everywhere() -> None:
    """But --json: a file where the command also prints a report for people, else a flag."""
    kinds: dict[str, set[str]] = {}
    for command in EVERY.values():
        for parameter in command.params:
            if isinstance(parameter, click.Option):
                for name in parameter.opts:
                    kinds.setdefault(name, set()).add("flag" if parameter.is_flag else type(parameter.type).__name__)
    differing = {name for name, each in kinds.items() if ("flag" in each) and len(each) > 1}
    assert differing <= {"--json", "--coverage"}


@pytest.mark.parametrize(
    ("wrong", "meant"),
    [
        (["tset"], "'test'"),
        (["deploi"], "'deploy'"),
        (["test", "--isolatoin", "fork"], "'--isolation'"),
    ],
)
def test_a_mistyped_word_is_answered_with_the_right_one(wrong: list[str], meant: str, make_project) -> None:
    result = make_project({}).run_here(*wrong)
    assert result.code == 2
    assert meant in result.stderr
    assert "Traceback" not in result.stderr


@pytest.mark.parametrize("command", ["sim", "deploy", "fuzz"])
def test_a_robots_file_given_as_to_another_tool_is_answered_with_the_option_for_it(command: str, make_project) -> None:
    result = make_project({}).run_here(command, "robot.py")
    assert result.code == 2
    assert result.stderr.endswith("pyfrc finds the robot's file. Use --main FILE if it is not called robot.py.\n")


@pytest.mark.parametrize("args", [["-v", "config", "check"], ["config", "check", "--verbose"]], ids=" ".join)
def test_verbose_shows_the_traceback_and_changes_no_exit_code(args: list[str], make_project) -> None:
    result = make_project({}).run_here(*args)
    assert result.code == 2
    assert "Traceback (most recent call last)" in result.stderr
    assert "no robot project found" in result.stderr


INTERRUPTED_AT_ONCE = """
import sys

class Interrupting:
    def find_spec(self, name, path, target=None):
        if name == "pyfrc_cli.main":
            raise KeyboardInterrupt

sys.meta_path.insert(0, Interrupting())
from pyfrc_cli.start import main

main()
"""


def test_ctrl_c_while_it_is_still_starting_is_told_in_a_word() -> None:
    command = [sys.executable, "-c", INTERRUPTED_AT_ONCE, "--help"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert (done.returncode, done.stdout, done.stderr) == (130, "", "interrupted\n")


INTERRUPTED_AT_ITS_END = """
import atexit, os, signal, sys, threading
import pyfrc_cli.main
from pyfrc_cli.start import main

def interrupt():
    os.kill(os.getpid(), signal.SIGINT)
    threading.Event().wait()

def run(run=pyfrc_cli.main.run):
    atexit.register(interrupt)
    run()

pyfrc_cli.main.run = run
main()
"""


@pytest.mark.skipif(sys.platform == "win32", reason="Windows has no SIGINT for one process")
def test_ctrl_c_after_the_result_ends_without_a_traceback() -> None:
    command = [sys.executable, "-c", INTERRUPTED_AT_ITS_END, "--help"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert (done.returncode, done.stderr) == (130, "")
    assert done.stdout.startswith("Usage: pyfrc ")


@pytest.mark.skipif(sys.platform == "win32", reason="there are no pseudo-terminals")
@pytest.mark.parametrize("no_color", sampled([None, "1"], None))
def test_colours_are_for_terminals_and_for_who_wants_them(no_color: str | None, make_project) -> None:
    project = make_project({})
    script = project.path / "in_a_terminal.py"
    script.write_text(IN_A_TERMINAL, "utf-8")
    environment = {name: value for name, value in os.environ.items() if name != "NO_COLOR"}
    environment |= {"NO_COLOR": no_color} if no_color else {}
    done = subprocess.run(
        [sys.executable, str(script)], cwd=project.path, env=environment, capture_output=True, stdin=subprocess.DEVNULL
    )
    assert done.returncode == 1, done.stdout + done.stderr
    assert b"problem" in done.stdout
    assert (b"\x1b[" in done.stdout) == (no_color is None)


def test_no_colours_where_there_is_no_terminal(make_project) -> None:
    result = make_project({}).run("doctor", "--no-robot", "--main", "none.py")
    assert "problem" in result.stdout
    assert "\x1b" not in result.output


def ask(make_project, shell: str, words: list[str], incomplete: str) -> list[str]:
    """What the script of this shell is answered, the way it asks."""
    environment = {
        "bash": {"COMP_WORDS": "\n".join([*words, incomplete]), "COMP_CWORD": str(len(words))},
        "zsh": {"COMP_WORDS": " ".join([*words, incomplete]), "COMP_CWORD": str(len(words))},
        "fish": {"COMP_WORDS": " ".join([*words, incomplete]), "COMP_CWORD": incomplete},
    }[shell]
    result = make_project({}).run(env=environment | {"_PYFRC_COMPLETE": f"{shell}_complete"})
    assert result.stderr == ""
    return result.stdout.strip().splitlines()


@pytest.mark.parametrize("shell", ["bash", "zsh", "fish"])
def test_commands_are_completed(shell: str, make_project) -> None:
    printed = "\n".join(ask(make_project, shell, ["pyfrc"], "dep"))
    assert "deploy" in printed
    assert "deploy-info" in printed
    assert "test" not in printed


def test_options_and_their_choices_are_completed(make_project) -> None:
    printed = "\n".join(ask(make_project, "bash", ["pyfrc", "test", "--isolation"], "re"))
    assert "reuse" in printed
    assert "fork" not in printed


@pytest.mark.skipif(sys.platform == "win32", reason="there is no bash")
def test_bash_completes_by_the_script(make_project) -> None:
    bash = shutil.which("bash")
    if bash is None:
        pytest.skip("there is no bash")
    project = make_project({"pyfrc": f'#!/bin/sh\nexec {sys.executable!r} -m pyfrc "$@"\n'})
    command = project.path / "pyfrc"
    command.chmod(0o755)
    program = f"""
{project.run(env={"_PYFRC_COMPLETE": "bash_source"}).stdout}
COMP_WORDS=(pyfrc co) COMP_CWORD=1
_pyfrc_completion {str(command)!r} co pyfrc
printf '%s\\n' "${{COMPREPLY[@]}}"
"""
    done = subprocess.run([bash, "-c", program], capture_output=True, text=True, stdin=subprocess.DEVNULL)
    assert done.stdout.split() == ["coverage", "console", "config"], done.stderr


@pytest.mark.parametrize("words", ["pyfrc\nde", "pyfrc\ntest\n--cov"])
def test_completing_loads_nothing_that_takes_time(words: str) -> None:
    """No command either, while it is names of commands that are completed."""
    asked = {"_PYFRC_COMPLETE": "bash_complete", "COMP_WORDS": words, "COMP_CWORD": str(words.count("\n"))}
    code = f"""
import atexit, json, os, sys
os.environ |= {asked!r}
sys.argv = ["pyfrc"]
atexit.register(lambda: print(json.dumps(sorted(sys.modules))))
from pyfrc_cli.main import run
run()
"""
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, stdin=subprocess.DEVNULL)
    *printed, modules = done.stdout.splitlines()
    assert printed, done.stderr
    loaded = set(json.loads(modules))
    assert not HEAVY & loaded
    commands = {module for module, _ in COMMANDS.values()}
    assert commands & loaded == ({"pyfrc_cli.test"} if "test" in words else set())


def test_ctrl_c_while_a_library_is_imported(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def interrupted(**_: object) -> None:
        raise ImportError("initialization failed") from KeyboardInterrupt()

    monkeypatch.setattr(cli, "main", interrupted)
    with pytest.raises(SystemExit) as ended:
        run()
    assert (ended.value.code, capsys.readouterr().err) == (2, "interrupted\n")
