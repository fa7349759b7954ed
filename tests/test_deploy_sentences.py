"""What `pyfrc deploy` and its relatives say on this computer, in process; over SSH, `test_deploy_command` has a few."""

from __future__ import annotations

import contextlib
import hashlib
import io
import json
import subprocess
import threading
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any
from zipfile import ZipFile

import paramiko
import pytest
from conftest import MakeProject
from skips import missing_programs, require

from pyfrc_core.deploy import installing, local_checks, login, session
from pyfrc_core.deploy.discovery import Address
from pyfrc_core.deploy.errors import ConnectionFailedError, DeployError, RefusedError
from pyfrc_core.deploy.facts import Deployed, DeployRequest, Plan
from pyfrc_core.deploy.host_keys import HostKey
from pyfrc_core.deploy.installing import Environment
from pyfrc_core.deploy.local_checks import DeployOptions, ImportCheck, prepare
from pyfrc_core.deploy.login import Credentials, log_in
from pyfrc_core.deploy.manifest import Entry
from pyfrc_core.deploy.progress import DeployProgress, JsonProgress, Phase, Questions, UserInterface, ask_to_continue
from pyfrc_core.deploy.robot_checks import carry_out
from pyfrc_core.deploy.session import _confirm, _deployed, _plan_as_text, _replace_program, _upload
from pyfrc_core.deploy.targets import AdministratorTask
from pyfrc_core.deploy.targets.roborio import ROBORIO
from pyfrc_core.deploy.targets.systemcore import SYSTEMCORE
from pyfrc_core.errors import UsageError
from pyfrc_core.project import find_project
from pyfrc_core.sync import Lock, LockedFile

ROBOT = "import wpilib\n\n\nclass MyRobot(wpilib.TimedRobot):\n    pass\n"


def asking(response: bool, asked: list[str] | None = None) -> UserInterface:
    """A user at a terminal, whose response is the same each time."""

    def yes(question: str) -> bool:
        if asked is not None:
            asked.append(question)
        return response

    return UserInterface(DeployProgress(io.StringIO()), Questions(text=lambda question: "", yes=yes))


NOT_ASKED = UserInterface(DeployProgress(io.StringIO()))


# -- logging in --------------------------------------------------------------------------------------------------------


class Server:
    """The server's side of a login, as `paramiko.Transport` shows it.

    :param allowed: the ways to log in
    """

    def __init__(self, allowed: list[str]) -> None:
        self.allowed = allowed

    def is_authenticated(self) -> bool:
        return False

    def auth_none(self, user: str) -> None:
        raise paramiko.BadAuthenticationType("", self.allowed)

    def auth_password(self, user: str, password: str, fallback: bool) -> None:
        raise paramiko.AuthenticationException


@pytest.fixture
def alone(monkeypatch: pytest.MonkeyPatch) -> None:
    """No other controller is at this address."""
    monkeypatch.setattr(login, "_refuse_other_controller", lambda address, controller: None)


def refused(server: Server, credentials: Credentials = login.NONE_OFFERED, controller: Any = ROBORIO) -> str:
    with pytest.raises(ConnectionFailedError) as caught:
        log_in(server, Address("10.0.0.2"), controller, "lvuser", credentials, HostKey("kind", b"key"))  # type: ignore[arg-type]
    return str(caught.value)


@pytest.mark.usefixtures("alone")
def test_a_login_that_the_robot_refuses() -> None:
    said = refused(Server(["password"]))
    assert "10.0.0.2: the robot refuses lvuser with an empty password, which is the default on robots" in said
    assert "as admin on the robot: passwd -d lvuser; or image the robot again." in said
    said = refused(Server(["password"]), controller=SYSTEMCORE)
    assert f"the robot refuses lvuser with the password {SYSTEMCORE.password}" in said
    assert "At a terminal, you are asked for it." in said
    asked: list[str] = []
    said = refused(
        Server(["password"]), Credentials(ask_password=lambda robot: asked.append(robot) or "typed"), SYSTEMCORE
    )
    assert "with this password, and with the default one" in said
    assert len(asked) == 1
    assert asked[0].startswith("lvuser@10.0.0.2 (its key: SHA256:")
    # A robot without a password asks nothing: none would help.
    refused(Server(["password"]), Credentials(ask_password=lambda robot: asked.append(robot) or "typed"))
    assert len(asked) == 1
    said = refused(Server(["publickey"]))
    assert "does not let lvuser in with a password, and pyfrc logs in only with one" in said


# -- what is checked before --------------------------------------------------------------------------------------------


def test_a_failure_prevents_the_deploy_unless_the_user_confirms() -> None:
    with pytest.raises(RefusedError, match=r"^not deployed: the tests failed\n  Try this$"):
        ask_to_continue("the tests failed", None, "Try this")
    asked: list[str] = []
    with pytest.raises(RefusedError, match=r"^not deployed: the tests failed$"):
        ask_to_continue("the tests failed", asking(False, asked).ask, "Try this")
    ask_to_continue("the tests failed", asking(True, asked).ask, "Try this")
    assert asked == ["The tests failed. Deploy anyway?"] * 2


@pytest.mark.parametrize("passed", [True, False])
def test_the_projects_tests_are_run_with_its_options(
    passed: bool, make_project: MakeProject, monkeypatch: pytest.MonkeyPatch
) -> None:
    made = make_project({"robot.py": ROBOT, "tests/test_it.py": ""})
    commands: list[list[str]] = []

    def run(command: list[str], output: object, quiet: bool) -> bool:
        commands.append(command)
        return passed

    monkeypatch.setattr(local_checks, "_run", run)
    project, own_output = find_project(made.path), list[str]()

    class Progress(DeployProgress):
        """As at a terminal, on which the tests print."""

        @contextlib.contextmanager
        def _shown(self, phase: Phase, own: bool) -> Iterator[Phase]:
            own_output.extend([phase.name] * own)
            yield phase

    if passed:
        checked = prepare(project, DeployOptions(builtin=True), UserInterface(Progress(io.StringIO())))
        assert own_output == ["tests"]
        assert (checked.main, checked.importing) == ("robot.py", None)
    else:
        with pytest.raises(RefusedError, match=r"^not deployed: the tests failed\n.*--skip-tests$"):
            prepare(project, DeployOptions(builtin=True), NOT_ASKED)
    (command,) = commands
    assert command == ["-m", "pyfrc", "test", "--main", str(made.path / "robot.py"), "--builtin"]


def test_a_program_that_cannot_be_imported_is_not_deployed(make_project: MakeProject) -> None:
    project = find_project(make_project({"robot.py": ROBOT + "\nimport no_such_library\n"}).path)
    check = ImportCheck(project)
    with pytest.raises(RefusedError) as caught:
        check.refuse_failure(NOT_ASKED)
    assert "the robot program cannot be imported: robot.py:7" in str(caught.value)
    assert "no_such_library" in str(caught.value)
    check.refuse_failure(asking(True))


def test_another_main_file_has_to_be_meant(make_project: MakeProject) -> None:
    made = make_project({"our_robot.py": ROBOT})
    project = find_project(None, made.path / "our_robot.py")
    options = DeployOptions(dry_run=True)
    with pytest.raises(
        RefusedError, match=r"our_robot\.py: the main file must be called robot\.py[^\n]*\n.*--nonstandard"
    ):
        prepare(project, options, NOT_ASKED)
    assert prepare(project, DeployOptions(dry_run=True, nonstandard=True), NOT_ASKED).main == "our_robot.py"


def test_a_checkout_is_recorded_with_its_commit(make_project: MakeProject) -> None:
    require("which commit was deployed", missing_programs("git"))
    made = make_project({"robot.py": ROBOT})
    assert set(local_checks._deploy_json(made.path)) == {"deploy-host", "deploy-user", "deploy-date", "code-path"}
    git = ["git", "-C", str(made.path), "-c", "user.name=x", "-c", "user.email=x@example.org"]
    for arguments in (["init", "-q", "-b", "main"], ["add", "robot.py"], ["commit", "-qm", "it works"]):
        subprocess.run([*git, *arguments], check=True)
    record = local_checks._deploy_json(made.path)
    commit = record["git-hash"]
    assert (len(commit), record["git-desc"], record["git-branch"]) == (40, commit[:7], "main")
    assert dict(_deployed(record))["commit"] == f"{commit[:7]} on main"
    made.write({"robot.py": "# changed\n"})
    record = local_checks._deploy_json(made.path)
    assert record["git-desc"] == f"{commit[:7]}-dirty"
    assert dict(_deployed(record))["commit"] == f"{commit[:7]} on main, with uncommitted changes"


def test_the_plan_as_text() -> None:
    assert _plan_as_text(Plan(("new.py",), ("robot.py",), ("old.py",), 2, 15_000)) == (
        "+ new.py\n~ robot.py\n- old.py\n"
        "1 to add, 1 to change, 1 to remove; 15 kB to send. Nothing was changed on the robot."
    )


def test_what_an_upload_says() -> None:
    requests: list[DeployRequest] = []
    deployed = Deployed(2, 1, 1, 1, False, 3, 15_000, ("pipe",), ("logs.release-1",))

    def upload(deployed: Deployed, **options: Any) -> str:
        shown = io.StringIO()
        robot: Any = SimpleNamespace(facts=SimpleNamespace(environment="a" * 16))
        robot.deploy = lambda manifest, request, work: requests.append(request) or deployed
        program: Any = SimpleNamespace(main="robot.py", deploy_json={}, manifest=None)
        program.imports = SimpleNamespace(program=lambda: ["robot.py"])
        _upload(robot, program, DeployOptions(**options), UserInterface(DeployProgress(shown)))
        return shown.getvalue()

    said = upload(deployed, debug=True)
    assert "upload     3 files, 15 kB; release 2 " in said
    assert "  the program of another tool is kept as release 1\n" in said
    assert "written, which is kept as 'logs.release-1'\n" in said
    assert "  not carried over (pipes, sockets, devices): 'pipe'\n" in said
    assert "nothing has changed; release 2 " in upload(replace(deployed, unchanged=True), reinstall=True)
    first, again = requests
    assert first == DeployRequest("robot.py", {}, True, ["robot.py"], True, "a" * 16)
    assert (again.reinstall, again.debug, again.restart) == (True, False, True)


@pytest.mark.parametrize("environment", ["a" * 16, None])
def test_a_program_that_ends_is_sent_again_with_its_packages(
    environment: str | None, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The packages are sent again only if they are pyfrc's."""
    sent: list[str] = []
    deployed = Deployed(2, 1, 1, None, False, 1, 1)

    def upload(robot: object, program: object, options: DeployOptions, talk: object) -> Deployed:
        sent.append(f"program, {'reinstall' if options.reinstall else ''}")
        return replace(deployed, fallback=len(sent))

    def start(robot: object, talk: object, fallback: int, auto_rollback: bool, reinstall: Any) -> str:
        assert (fallback, auto_rollback, reinstall()) == (1, True, len(sent))
        return "running"

    monkeypatch.setattr(session, "_upload", upload)
    monkeypatch.setattr(session, "install_packages", lambda robot, wanted, phase: sent.append("packages"))
    monkeypatch.setattr("pyfrc_core.deploy.starting.start", start)
    facts = SimpleNamespace(environment=environment, wastes_memory=False, remains=False)
    robot: Any = SimpleNamespace(facts=facts, program_survived=False)
    connection: Any = SimpleNamespace(controller=SYSTEMCORE, host="10.0.0.2")
    wanted: Any = SimpleNamespace(name="a" * 16)
    shown = io.StringIO()
    options = DeployOptions(auto_rollback=True)
    _replace_program(robot, connection, None, wanted, options, UserInterface(JsonProgress(shown)))  # type: ignore[arg-type]
    assert sent == ["program, ", *(["packages"] if environment else []), "program, reinstall"]
    result = json.loads(shown.getvalue().splitlines()[-1])
    assert (result["release"], result["fallback"], result["program"]) == (2, len(sent), "running")


def test_private_files_are_uploaded_only_if_they_are_meant(make_project: MakeProject) -> None:
    project = find_project(make_project({"robot.py": ROBOT, "id_rsa": ""}).path)
    what = "files would be uploaded that seem to be private: id_rsa (files of this name hold keys or passwords)"
    with pytest.raises(RefusedError) as caught:
        prepare(project, DeployOptions(skip_tests=True), NOT_ASKED)
    assert str(caught.value).startswith(
        f"not deployed: {what}\n  Under [tool.pyfrc.deploy] in pyproject.toml, leave them"
    )
    shown = io.StringIO()
    prepare(project, DeployOptions(dry_run=True), UserInterface(DeployProgress(shown)))
    assert f"warning: {what}\n" in shown.getvalue()


def test_tests_that_have_passed_are_not_run_again_and_a_project_without_any_is_imported(
    make_project: MakeProject, monkeypatch: pytest.MonkeyPatch
) -> None:
    project, shown = find_project(make_project({"robot.py": ROBOT}).path), io.StringIO()
    monkeypatch.setattr(local_checks, "ImportCheck", lambda project: project)
    monkeypatch.setattr(local_checks, "_passed_already", lambda project, builtin: "16:40" if builtin else None)
    talk = UserInterface(DeployProgress(shown))
    assert prepare(project, DeployOptions(), talk).importing is project
    assert "this project has no tests; the ready-made ones run with --builtin\n" in shown.getvalue()
    assert prepare(project, DeployOptions(builtin=True), talk).importing is None
    assert "tests      passed at 16:40; the project's files, Python and packages have" in shown.getvalue()
    assert prepare(project, DeployOptions(builtin=True, skip_tests=True), talk).importing is project


def test_files_that_change_while_the_tests_run(make_project: MakeProject, monkeypatch: pytest.MonkeyPatch) -> None:
    made = make_project({"robot.py": ROBOT, "tests/test_it.py": "", "data.json": "1"})
    project, writes = find_project(made.path), dict[str, str]()
    shown = io.StringIO()

    def run(command: list[str], output: object, quiet: bool) -> bool:
        made.write(writes)
        return True

    monkeypatch.setattr(local_checks, "_run", run)
    monkeypatch.setattr(local_checks, "_passed_already", lambda project, builtin: None)
    writes |= {"data.json": "2", "new.log": ""}
    assert "new.log" in {
        each.path for each in prepare(project, DeployOptions(), UserInterface(DeployProgress(shown))).manifest.entries
    }
    assert "warning: files have changed since the tests began: data.json\n" in shown.getvalue()
    writes |= {"arm.py": "", "robot.py": ROBOT + "\n"}
    with pytest.raises(
        RefusedError, match=r"have changed since the tests began, and were not tested: arm\.py, robot\.py\n"
    ):
        prepare(project, DeployOptions(), NOT_ASKED)


# -- what is done meanwhile, and installed -----------------------------------------------------------------------------


def test_a_task_of_the_administrator_causes_only_a_note_or_a_warning() -> None:
    shown = io.StringIO()
    task = AdministratorTask("script", "it was done", "it could not be done")
    for problem in (None, "no connection"):
        connection: Any = SimpleNamespace(administer=lambda task, problem=problem: problem)
        carry_out(task, connection, DeployProgress(shown))
        carry_out(None, connection, DeployProgress(shown))
    assert shown.getvalue() == "  it was done\nwarning: it could not be done: no connection\n"


def locked(name: str, version: str, content: str) -> LockedFile:
    return LockedFile(
        name, version, f"{name}-{version}.whl", len(content), hashlib.sha256(content.encode()).hexdigest()
    )


LOCK = Lock(
    2027, "SystemCore", (), locked("python", "3.14.3", "p"), (locked("wpilib", "1", "w"), locked("six", "2", "s"))
)


def test_when_a_robot_has_all_that_the_lock_asks_for() -> None:
    wanted = Environment(LOCK, SYSTEMCORE)
    assert wanted.name == Environment(replace(LOCK, season=2026), SYSTEMCORE).name
    assert wanted.name != Environment(replace(LOCK, packages=LOCK.packages[::-1]), SYSTEMCORE).name
    assert wanted.python == f"/home/systemcore/.pyfrc/pythons/{LOCK.python.sha256[:16]}/bin/python3"
    assert Environment(LOCK, ROBORIO).python == ROBORIO.python
    there = {"wpilib": "1", "six": "2", "more": "3"}

    def is_met(environment: str | None, python: str = "3.14.3", packages: dict[str, str] = there) -> bool:
        return wanted.is_met_by(SimpleNamespace(environment=environment, python=python, packages=packages))  # type: ignore[arg-type]

    assert is_met(wanted.name, "3.9", {}), "it is checked when it is made"
    assert is_met(None)
    assert not is_met("b" * 16)
    assert not is_met(None, "3.14.2")
    assert not is_met(None, packages={"wpilib": "1"})
    assert not is_met(None, packages={**there, "six": "1"})


def test_what_a_wheel_takes_on_the_disk(tmp_path: Path) -> None:
    """Whole blocks of 4096 bytes, and for a source as many again for its compiled file."""
    wheel = tmp_path / "x-1-py3-none-any.whl"
    with ZipFile(wheel, "w") as archive:
        for name, size in (("a.py", 1), ("b.py", 4096), ("c.bin", 8191), ("d.txt", 0)):
            archive.writestr(name, bytes(size))
    entry = Entry(wheel.name, 1, "", False, wheel)
    assert installing._unpacked_size(entry) == 4096 * (2 + 4 + 2 + 1)
    wheel.write_bytes(b"PK")
    with pytest.raises(RefusedError, match=r"x-1-py3-none-any\.whl is not a wheel: .*\n  Remove it; then: pyfrc sync"):
        installing._unpacked_size(entry)


class PythonChannel:
    """A robot's script that installs Python."""

    def __init__(self, reply: str, status: int = 0) -> None:
        self.reply, self.status, self.received = reply, status, b""
        self.status_event = threading.Event()
        self.status_event.set()

    def makefile(self, mode: str) -> io.StringIO:
        if self.reply == "lost":
            raise TimeoutError
        return io.StringIO(f"{self.reply}\n")

    def sendall(self, data: bytes) -> None:
        self.received += data

    def shutdown_write(self) -> None:
        self.received += b"."

    def recv_exit_status(self) -> int:
        return self.status

    def recv_stderr(self, count: int) -> bytes:
        return b"one\nno such file\n" if self.status == 1 else b""


def test_python_is_sent_unless_it_is_there_or_the_disk_is_full(tmp_path: Path) -> None:
    archive = tmp_path / "python.ipk"
    archive.write_bytes(b"x" * 100_000)
    scripts: list[str] = []

    def send(reply: str, status: int = 0) -> tuple[bool, bytes]:
        channel = PythonChannel(reply, status)

        @contextlib.contextmanager
        def opened(script: str) -> Iterator[PythonChannel]:
            scripts.append(script)
            yield channel

        connection: Any = SimpleNamespace(address="10.0.0.2", opened=opened)
        sent = installing._send_python(connection, Environment(LOCK, ROBORIO), archive, 1_000_000, Phase("install"))
        return sent, channel.received

    assert send("there") == (False, b"")
    assert send("send") == (True, archive.read_bytes() + b".")
    needed = 100_000 * 5 + 1_000_000
    assert f'[ "$4" -ge {needed // 1024} ]' in scripts[0]
    with pytest.raises(
        RefusedError, match=f"too full to install Python and packages: {needed // 1000:,} kB are needed, 12"
    ):
        send("full 12")
    with pytest.raises(DeployError, match=r"Python could not be installed on the robot: no such file\n"):
        send("send", 1)
    with pytest.raises(DeployError, match=r"Python could not be installed on the robot: exit code 2\n"):
        send("send", 2)
    with pytest.raises(ConnectionFailedError, match=r"^10.0.0.2: the connection to the robot was lost: no response\n"):
        send("lost")


def test_undeploying_has_to_be_meant() -> None:
    with pytest.raises(UsageError, match=r"^confirmation needed: the code will be removed\n  Confirm with --yes\.$"):
        _confirm("the code will be removed", NOT_ASKED, confirmed=False)
    asked: list[str] = []
    with pytest.raises(RefusedError, match=r"^nothing was removed$"):
        _confirm("the code will be removed", asking(False, asked), confirmed=False)
    assert asked == ["The code will be removed from the robot. Continue?"]
    _confirm("the code will be removed", asking(True), confirmed=False)
    _confirm("the code will be removed", NOT_ASKED, confirmed=True)
