"""What `pyfrc deploy` and its relatives say on this computer, in process; over SSH, `test_deploy_command` has a few."""

from __future__ import annotations

import io
import subprocess
from pathlib import Path
from typing import Any

import paramiko
import pytest
from conftest import MakeProject
from skips import missing_programs, require

from pyfrc_core.deploy import local_checks, login
from pyfrc_core.deploy.discovery import Address
from pyfrc_core.deploy.errors import ConnectionFailedError, RefusedError
from pyfrc_core.deploy.facts import Plan
from pyfrc_core.deploy.host_keys import HostKey
from pyfrc_core.deploy.local_checks import DeployOptions, ImportCheck, prepare
from pyfrc_core.deploy.login import Credentials, log_in
from pyfrc_core.deploy.progress import DeployProgress, Questions, UserInterface, ask_to_continue
from pyfrc_core.deploy.session import _confirm, _deployed, _plan_as_text
from pyfrc_core.deploy.targets.roborio import ROBORIO
from pyfrc_core.deploy.targets.systemcore import SYSTEMCORE
from pyfrc_core.errors import UsageError
from pyfrc_core.project import find_project

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
    :param key: the one key that it accepts
    """

    def __init__(self, allowed: list[str], key: paramiko.PKey | None = None) -> None:
        self.allowed, self.key = allowed, key
        self.offered: list[str] = []
        self._lets_in = False

    def is_authenticated(self) -> bool:
        return self._lets_in

    def auth_none(self, user: str) -> None:
        raise paramiko.BadAuthenticationType("", self.allowed)

    def auth_password(self, user: str, password: str, fallback: bool) -> None:
        self.offered.append(password)
        raise paramiko.AuthenticationException

    def auth_publickey(self, user: str, key: paramiko.PKey) -> None:
        self.offered.append(key.get_name())
        if key != self.key:
            raise paramiko.AuthenticationException
        self._lets_in = True


@pytest.fixture
def alone(monkeypatch: pytest.MonkeyPatch) -> None:
    """No other controller is at this address."""
    monkeypatch.setattr(login, "_refuse_other_controller", lambda address, controller: None)


def refused(server: Server, credentials: Credentials = login.NONE_OFFERED, controller: Any = ROBORIO) -> str:
    with pytest.raises(ConnectionFailedError) as caught:
        log_in(server, Address("10.0.0.2"), controller, "lvuser", credentials, HostKey("kind", b"key"))  # type: ignore[arg-type]
    return str(caught.value)


@pytest.fixture
def keys(tmp_path: Path) -> Path:
    for name, passphrase in (("right", None), ("wrong", None), ("locked", "secret")):
        key = paramiko.ECDSAKey.generate()
        key.write_private_key_file(str(tmp_path / name), passphrase)
        (tmp_path / f"{name}.pub").write_text(f"{key.get_name()} {key.get_base64()} me@here\n")
    return tmp_path


@pytest.mark.usefixtures("alone")
def test_a_login_that_the_robot_refuses(keys: Path) -> None:
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
    assert "lets lvuser in only with a key, and none was offered" in said
    assert "Offer a key of yours: --identity FILE; or ssh-add FILE and --ssh-agent." in said
    said = refused(Server(["publickey"]), Credentials(identity=keys / "wrong"))
    assert f"the robot refuses lvuser with {keys / 'wrong'}" in said


def test_the_key_in_the_file_is_offered_and_no_other(keys: Path) -> None:
    server = Server(["publickey", "password"], paramiko.PKey.from_path(keys / "right"))
    log_in(server, Address("10.0.0.2"), ROBORIO, "lvuser", Credentials(keys / "right"), HostKey("kind", b"key"))  # type: ignore[arg-type]
    assert server.offered == ["", "ecdsa-sha2-nistp256"]


@pytest.mark.parametrize(
    ("name", "sentence"),
    [
        ("locked", "this key has a passphrase"),
        ("right.pub", "this is not a private key"),
        ("none", "this key cannot be read: No such file"),
    ],
)
def test_a_file_that_has_no_key(name: str, sentence: str, keys: Path) -> None:
    with pytest.raises(RefusedError) as caught:
        list(Credentials(identity=keys / name).load())
    assert str(caught.value).startswith(f"{keys / name}: {sentence}")


def test_the_keys_of_the_ssh_agent_are_offered_only_with_the_option(monkeypatch: pytest.MonkeyPatch) -> None:
    class Agent:
        def get_keys(self) -> list[str]:
            return [f"key {number}" for number in range(9)]

        def close(self) -> None:
            pass

    monkeypatch.setattr(paramiko, "Agent", Agent)
    assert list(Credentials().load()) == []
    assert list(Credentials(ssh_agent=True).load()) == [f"key {number}" for number in range(5)]
    assert Credentials(ssh_agent=True).offered(2) == "2 of your SSH agent's keys"
    assert Credentials(Path("mine"), ssh_agent=True).offered(2) == "mine and 1 of your SSH agent's keys"
    assert Credentials(ssh_agent=True).offered(0) == "there is none in your SSH agent"


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
    project = find_project(made.path)
    if passed:
        checked = prepare(project, DeployOptions(builtin=True), NOT_ASKED)
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


def test_undeploying_has_to_be_meant() -> None:
    with pytest.raises(UsageError, match=r"^confirmation needed: the code will be removed\n  Confirm with --yes\.$"):
        _confirm("the code will be removed", NOT_ASKED, confirmed=False)
    asked: list[str] = []
    with pytest.raises(RefusedError, match=r"^nothing was removed$"):
        _confirm("the code will be removed", asking(False, asked), confirmed=False)
    assert asked == ["The code will be removed from the robot. Continue?"]
    _confirm("the code will be removed", asking(True), confirmed=False)
    _confirm("the code will be removed", NOT_ASKED, confirmed=True)
