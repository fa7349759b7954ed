"""Host keys: pinned for all addresses of a team or for one address; other keys are refused until accepted."""

from __future__ import annotations

import base64
import shutil
import subprocess
from pathlib import Path

import pytest
from loops import for_each
from skips import missing_programs, require

from pyfrc_core.deploy.discovery import Address, addresses_of
from pyfrc_core.deploy.errors import HostKeyError, KeyFileError
from pyfrc_core.deploy.host_keys import KNOWN_HOSTS, HostKey, HostKeys, RobotKeys
from pyfrc_core.deploy.target_connection import load_robot_keys
from pyfrc_core.deploy.targets import team_of_host
from pyfrc_core.deploy.targets.roborio import ROBORIO
from pyfrc_core.deploy.team import find_target
from pyfrc_core.errors import UsageError
from pyfrc_core.project import Project

TEAM = 1234
RADIO, USB = Address("10.12.34.2"), Address("172.22.11.2")
#: What the Driver Station may report: an address that the team's list does not have.
REPORTED = Address("10.12.34.57")
OF_TEAM = [*(address for address, _ in addresses_of(TEAM, ROBORIO)), REPORTED]
#: Named by --robot, and none of the team's.
OWN = [Address("192.168.1.20"), Address("robot.example.org"), Address("127.0.0.1", 2222), Address("10.12.34.2", 2222)]
#: The team's robots, by what they are for; one of no robot of the team; one of another team's robot.
ONE, TWO, UNKNOWN, THEIRS = (HostKey("ssh-ed25519", name.encode()) for name in ("one", "two", "unknown", "theirs"))


@pytest.fixture
def home(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    for name in ("HOME", "USERPROFILE"):
        monkeypatch.setenv(name, str(tmp_path))
    return tmp_path


def at(directory: Path, address: Address = RADIO, team: int | None = TEAM) -> RobotKeys:
    """What the project knows of the robot there, as the next command reads it."""
    return HostKeys(directory).of_robot(address, ROBORIO, team)


def refused(keys: RobotKeys, key: HostKey, accepted: str | None = None) -> str:
    """The refusal; nothing is pinned by it."""
    before = keys.known()
    with pytest.raises(HostKeyError) as caught:
        keys.check(key, accepted)
    assert keys.known() == before
    assert str(caught.value).endswith(f"--accept-host-key {key.fingerprint}")
    return str(caught.value)


# -- the table: addresses and keys -------------------------------------------------------------------------------------


@for_each("seen_at", OF_TEAM)
def test_a_team_s_addresses_are_one(seen_at: Address, tmp_path: Path) -> None:
    """Wherever the team's robots were seen first, at each address they are known, and no other is."""
    shutil.rmtree(tmp_path / ".pyfrc", ignore_errors=True)
    assert at(tmp_path, seen_at).check(ONE).new_for == f"team {TEAM}"
    assert at(tmp_path, seen_at).check(TWO, accepted=TWO.fingerprint, name="practice").new_for
    for address in OF_TEAM:
        refused(at(tmp_path, address), UNKNOWN)
        for key, name in ((ONE, ""), (TWO, "practice")):
            recognized = at(tmp_path, address).check(key)
            assert (recognized.new_for, recognized.name) == (None, name), address


@for_each("first", [UNKNOWN, ONE])
def test_an_address_by_itself(first: HostKey, tmp_path: Path) -> None:
    shutil.rmtree(tmp_path / ".pyfrc", ignore_errors=True)
    at(tmp_path).check(ONE)
    for address in OWN:
        assert at(tmp_path, address, None).check(first).new_for is not None
        assert at(tmp_path, address, None).check(first).new_for is None
        for other in {UNKNOWN, ONE, TWO} - {first}:
            refused(at(tmp_path, address, None), other)


def test_what_is_known_by_itself_is_not_the_team_s(tmp_path: Path) -> None:
    """A virtual robot, say, whose key anyone can have."""
    at(tmp_path).check(ONE)
    for own in OWN:
        at(tmp_path, own, None).check(UNKNOWN)
    for address in OF_TEAM:
        refused(at(tmp_path, address), UNKNOWN)


def test_a_team_s_address_named_by_robot_is_the_team_s(tmp_path: Path) -> None:
    at(tmp_path, USB).check(ONE)
    named = [address for address in OF_TEAM if team_of_host(address.host)]
    assert named
    for address in named:
        assert at(tmp_path, address, None).check(ONE).new_for is None
        refused(at(tmp_path, address, None), UNKNOWN)


def test_the_usb_cable_named_by_robot_has_the_project_s_robots(tmp_path: Path) -> None:
    at(tmp_path).check(ONE)
    assert at(tmp_path, USB, None).check(ONE).new_for is None
    refused(at(tmp_path, USB, None), UNKNOWN)


def test_a_robot_seen_at_the_cable_before_the_team_was_known(tmp_path: Path) -> None:
    at(tmp_path, USB, None).check(ONE)
    assert at(tmp_path).check(ONE).new_for is None
    refused(at(tmp_path), UNKNOWN)


def test_another_team_s_robot(tmp_path: Path) -> None:
    """Also when none of this team's is known: its radio may have been given our number, but the user should know."""
    at(tmp_path, Address("10.56.78.2"), 5678).check(THEIRS)
    for address in OF_TEAM:
        assert "this key is pinned for 10.56.78.2" in refused(at(tmp_path, address), THEIRS)
    assert at(tmp_path).check(THEIRS, accepted=THEIRS.fingerprint).new_for == f"team {TEAM}"


@for_each("own_is_pinned", [True, False])
@for_each("named", [USB, *OWN])
def test_another_team_s_robot_named_by_robot_in_a_team_s_project(
    named: Address, own_is_pinned: bool, tmp_path: Path
) -> None:
    """The line of the other team has the USB cable's address, too."""
    shutil.rmtree(tmp_path / ".pyfrc", ignore_errors=True)
    (tmp_path / "robot.py").touch()
    (tmp_path / "pyproject.toml").write_text(f"[tool.pyfrc]\nteam = {TEAM}\n")
    project = Project(tmp_path / "robot.py")
    HostKeys(tmp_path).of_robot(Address("10.99.99.2"), ROBORIO).check(THEIRS)
    if own_is_pinned:
        at(tmp_path).check(ONE)
    keys = load_robot_keys(find_target(project, robot=str(named)), named)
    assert "this key is pinned for 10.99.99.2" in refused(keys, THEIRS)
    assert (keys.check(ONE).new_for is None) is (own_is_pinned and named == USB)
    if named == USB:
        assert at(tmp_path).check(ONE).new_for is None
        refused(keys, UNKNOWN)


# -- outside of projects -----------------------------------------------------------------------------------------------


@for_each(
    "address, team, key, accepted",
    [
        (RADIO, None, ONE, True),
        (RADIO, TEAM, ONE, True),
        (RADIO, None, UNKNOWN, False),
        (RADIO, None, THEIRS, False),
        (REPORTED, TEAM, UNKNOWN, False),
        (USB, None, ONE, True),
        (USB, None, THEIRS, True),
        (USB, None, UNKNOWN, True),
        (USB, TEAM, ONE, True),
        (USB, TEAM, THEIRS, False),
        (USB, TEAM, UNKNOWN, False),
        (USB, 99, UNKNOWN, True),
        (USB, 99, THEIRS, False),
        (Address("10.0.99.2"), None, THEIRS, False),
        (Address("10.0.99.2"), None, UNKNOWN, True),
    ],
)
def test_a_volunteer_meets_robots_of_many_teams(
    address: Address, team: int | None, key: HostKey, accepted: bool, home: Path
) -> None:
    """Two are known. Only at the end of a cable, where no team was named, any robot may be."""
    shutil.rmtree(home / ".pyfrc", ignore_errors=True)
    keys = HostKeys.of_this_user()
    keys.of_robot(RADIO, ROBORIO).check(ONE)
    keys.of_robot(Address("10.56.78.2"), ROBORIO).check(THEIRS)
    keys = HostKeys.of_this_user()
    if accepted:
        keys.of_robot(address, ROBORIO, team).check(key)
    else:
        refused(keys.of_robot(address, ROBORIO, team), key)


@for_each("team", [None, TEAM])
def test_what_was_at_the_volunteer_s_cable_is_known_nowhere_else(team: int | None, home: Path) -> None:
    shutil.rmtree(home / ".pyfrc", ignore_errors=True)
    assert HostKeys.of_this_user().of_robot(USB, ROBORIO, team).check(UNKNOWN).new_for == "the USB cable"
    assert HostKeys.of_this_user().of_robot(USB, ROBORIO, team).check(UNKNOWN).new_for is None
    assert HostKeys.of_this_user().of_robot(RADIO, ROBORIO).check(ONE).new_for == f"team {TEAM}"
    refused(HostKeys.of_this_user().of_robot(RADIO, ROBORIO), UNKNOWN)
    assert (home / KNOWN_HOSTS).is_file()


# -- accepting, and names ----------------------------------------------------------------------------------------------


def test_a_refusal_lists_the_known_robots_and_the_option_that_accepts(tmp_path: Path) -> None:
    at(tmp_path).check(ONE, name="competition")
    text = refused(at(tmp_path), TWO)
    assert text.startswith(
        f"{RADIO}: the robot's key has changed, or this is another robot: its key is {TWO.fingerprint}"
    )
    assert f"pinned for team 1234: {ONE.fingerprint} (competition)" in text
    refused(at(tmp_path), TWO, accepted=ONE.fingerprint)  # another key than the one accepted
    assert at(tmp_path).check(TWO, accepted=TWO.fingerprint, name="practice").name == "practice"
    assert [str(known) for known in at(tmp_path).known()] == [
        f"{ONE.fingerprint} (competition)",
        f"{TWO.fingerprint} (practice)",
    ]
    assert at(tmp_path, USB).check(ONE, accepted=TWO.fingerprint).name == "competition"


def test_a_first_key_that_is_not_the_accepted_one(tmp_path: Path) -> None:
    assert "pinned for team 1234: none" in refused(at(tmp_path), ONE, accepted=TWO.fingerprint)


def test_a_name_is_of_one_robot(tmp_path: Path) -> None:
    """An imaged robot that gets its name back makes its old key forgotten."""
    at(tmp_path).check(ONE)
    assert at(tmp_path).check(ONE, name="practice").new_for is None
    assert at(tmp_path).check(ONE).name == "practice"
    at(tmp_path).check(TWO, accepted=TWO.fingerprint, name="practice")
    assert [str(known) for known in at(tmp_path).known()] == [f"{TWO.fingerprint} (practice)"]
    refused(at(tmp_path), ONE)


def test_what_is_no_name(tmp_path: Path) -> None:
    for name in ("", "two words", "\x1b[31m", "-", "ü", "a" * 41):
        with pytest.raises(UsageError, match="--robot-name"):
            at(tmp_path).check(ONE, name=name)
    assert not (tmp_path / KNOWN_HOSTS).exists()


# -- the file ----------------------------------------------------------------------------------------------------------


def line(host: str, key: HostKey) -> str:
    return f"{host} {key.kind} {base64.b64encode(key.blob).decode()}\n"


def test_lines_that_are_not_pyfrcs_own_stay(tmp_path: Path) -> None:
    (tmp_path / KNOWN_HOSTS).parent.mkdir()
    (tmp_path / KNOWN_HOSTS).write_text("# ours\n" + line("127.0.0.1", UNKNOWN))
    at(tmp_path).check(ONE)
    assert (tmp_path / KNOWN_HOSTS).read_text().startswith("# ours\n" + line("127.0.0.1", UNKNOWN))


def test_a_directory_in_place_of_the_file(tmp_path: Path) -> None:
    """Found before a command connects."""
    (tmp_path / KNOWN_HOSTS).mkdir(parents=True)
    with pytest.raises(HostKeyError, match=r"known_hosts: this is a directory.*\n.*Remove it"):
        HostKeys(tmp_path)


def test_ports_are_robots_of_their_own(tmp_path: Path) -> None:
    at(tmp_path, Address("127.0.0.2", 2222), None).check(ONE)
    assert at(tmp_path, Address("127.0.0.2", 2223), None).check(TWO).new_for == "[127.0.0.2]:2223"
    assert (tmp_path / KNOWN_HOSTS).read_text().startswith("[127.0.0.2]:2222 ssh-ed25519 ")


def test_the_file_is_not_committed_and_openssh_reads_it(tmp_path: Path) -> None:
    require("host keys as OpenSSH reads them", missing_programs("ssh-keygen"))
    made = tmp_path / "key"
    subprocess.run(["ssh-keygen", "-q", "-t", "ed25519", "-N", "", "-f", str(made)], check=True)
    said = subprocess.run(["ssh-keygen", "-lf", f"{made}.pub"], capture_output=True, text=True, check=True).stdout
    key = HostKey("ssh-ed25519", base64.b64decode(made.with_suffix(".pub").read_text().split()[1]))
    at(tmp_path).check(key, name="practice")
    assert key.fingerprint in said
    for address in (RADIO, USB):
        found = subprocess.run(
            ["ssh-keygen", "-F", address.host, "-l", "-f", str(tmp_path / KNOWN_HOSTS)], capture_output=True, text=True
        )
        assert key.fingerprint in found.stdout
    assert (tmp_path / KNOWN_HOSTS).with_name(".gitignore").read_text() == "*\n"


@for_each("encoding", ["utf-8-sig", "utf-16"])
def test_a_file_that_windows_editors_have_saved(encoding: str, tmp_path: Path) -> None:
    """A byte-order mark is not part of the first host; another encoding is an error. Neither makes a pin void."""
    (tmp_path / KNOWN_HOSTS).parent.mkdir(exist_ok=True)
    (tmp_path / KNOWN_HOSTS).write_text(line(RADIO.host, ONE), encoding)
    if encoding == "utf-16":
        with pytest.raises(HostKeyError, match="known_hosts:1: "):
            at(tmp_path)
        return
    assert at(tmp_path).check(ONE).new_for is None
    refused(at(tmp_path), UNKNOWN)


@for_each(
    "bad",
    [
        "10.12.34.2 ssh-ed25519 ***",
        "|1|a|b ssh-ed25519 b25l",
        "@revoked h ssh-rsa b25l",
        "10.12.34.* ssh-ed25519 b25l",
        "roboRIO-1234-FRC?local ssh-ed25519 b25l",
        "!10.12.34.2 ssh-ed25519 b25l",
        "172.22.11.2,!10.12.34.2 ssh-ed25519 b25l",
        "10.12.34.2, ssh-ed25519 b25l",
        "\ufeff10.12.34.2 ssh-ed25519 b25l",
        "[10.12.34.2 ssh-ed25519 b25l",
        "[10.12.34.2]:ssh ssh-ed25519 b25l",
    ],
)
def test_an_invalid_line_is_reported_with_its_number(bad: str, tmp_path: Path) -> None:
    file = tmp_path / KNOWN_HOSTS
    file.parent.mkdir(exist_ok=True)
    file.write_text(f"# mine\n\n{bad}\n", "utf-8")
    with pytest.raises(HostKeyError, match=r"\.pyfrc/known_hosts:3: .*\n.*Remove the line"):
        HostKeys(tmp_path)
    file.write_bytes(b"10.12.34.2 ssh-ed25519 \xff\n")
    with pytest.raises(HostKeyError, match="known_hosts:1: this line is not a host key"):
        HostKeys(tmp_path)


@pytest.mark.parametrize("place", [".pyfrc", ".pyfrc/known_hosts", ".pyfrc/.gitignore"])
@pytest.mark.parametrize("whose", ["project", "user"])
@pytest.mark.parametrize("there", [True, False])
def test_a_link_is_not_followed(place: str, whose: str, there: bool, home: Path) -> None:
    elsewhere = home / "elsewhere"
    if there and place == ".pyfrc":
        elsewhere.mkdir()
    elif there:
        elsewhere.write_text("precious")
    link = home / place
    link.parent.mkdir(exist_ok=True)
    try:
        link.symlink_to(elsewhere)
    except OSError:
        pytest.skip("this user cannot make symbolic links")
    before = sorted(home.rglob("*"))
    with pytest.raises(HostKeyError, match="this is a link") as caught:
        HostKeys.of_this_user() if whose == "user" else HostKeys(home)
    assert str(link) in str(caught.value)
    assert sorted(home.rglob("*")) == before
    assert elsewhere.is_dir() or not there or elsewhere.read_text() == "precious"
    link.unlink()
    keys = HostKeys(home).of_robot(RADIO, ROBORIO)
    link.parent.mkdir(exist_ok=True)
    if place != ".pyfrc":
        link.symlink_to(elsewhere)  # between reading and writing
        with pytest.raises(HostKeyError, match="this is a link"):
            keys.check(ONE)


def test_a_file_that_cannot_be_written_is_named_with_what_to_do(home: Path) -> None:
    (home / ".pyfrc").write_text("no directory")
    for keys, whose in ((HostKeys(home), "the project's directory"), (HostKeys.of_this_user(), "your home directory")):
        with pytest.raises(KeyFileError, match="cannot write the file with the keys of robots: file exists") as caught:
            keys.of_robot(RADIO, ROBORIO).check(ONE)
        assert caught.value.where == str(home / ".pyfrc")
        assert f"Make sure that you can write {whose}" in str(caught.value.remedy)


def test_a_file_that_cannot_be_read_is_named_with_what_to_do(home: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(path: Path, *args: object, **how: object) -> str:
        raise PermissionError(13, "Permission denied", str(path))

    at(home).check(ONE)
    monkeypatch.setattr(Path, "read_text", refuse)
    with pytest.raises(KeyFileError, match="cannot read the file with the keys of robots: permission denied") as caught:
        HostKeys(home)
    assert caught.value.where == str(home / KNOWN_HOSTS)
