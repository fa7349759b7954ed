"""Host keys: pinned when first seen, and a changed one is refused until it is accepted by its fingerprint."""

from __future__ import annotations

import base64
import shutil
import subprocess
from pathlib import Path

import pytest

from pyfrc_core.deploy.discovery import Address
from pyfrc_core.deploy.errors import HostKeyError
from pyfrc_core.deploy.host_keys import KNOWN_HOSTS, HostKey, HostKeys

RADIO, USB = Address("10.12.34.2"), Address("172.22.11.2")
ONE, TWO = HostKey("ssh-ed25519", b"one"), HostKey("ssh-ed25519", b"two")


def test_a_key_is_new_once(tmp_path: Path) -> None:
    assert HostKeys(tmp_path).check(RADIO, ONE)
    assert not HostKeys(tmp_path).check(RADIO, ONE)
    assert HostKeys(tmp_path).known(RADIO) == [ONE]


def test_a_changed_key_is_refused_with_the_option_that_accepts_it(tmp_path: Path) -> None:
    keys = HostKeys(tmp_path)
    keys.check(RADIO, ONE)
    with pytest.raises(HostKeyError) as caught:
        keys.check(RADIO, TWO)
    assert f"--accept-host-key {TWO.fingerprint}" in str(caught.value)
    assert ONE.fingerprint in str(caught.value)
    with pytest.raises(HostKeyError):
        keys.check(RADIO, TWO, accepted=ONE.fingerprint)  # another key than the one accepted
    assert HostKeys(tmp_path).known(RADIO) == [ONE]
    assert keys.check(RADIO, TWO, accepted=TWO.fingerprint)
    assert HostKeys(tmp_path).known(RADIO) == [ONE, TWO]  # two robots of a team take turns at one address


def test_outside_of_projects_each_robot_is_new_at_the_usb_cable_and_only_there(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    for name in ("HOME", "USERPROFILE"):
        monkeypatch.setenv(name, str(tmp_path))
    keys = HostKeys.of_user()
    assert keys.check(USB, ONE)
    assert keys.check(USB, TWO)
    assert not HostKeys.of_user().check(USB, ONE)
    assert keys.check(RADIO, HostKey("ssh-ed25519", b"three"))
    with pytest.raises(HostKeyError):
        keys.check(RADIO, HostKey("ssh-ed25519", b"four"))
    assert (tmp_path / KNOWN_HOSTS).is_file()


def test_the_same_robot_at_another_address_is_no_news(tmp_path: Path) -> None:
    keys = HostKeys(tmp_path)
    keys.check(RADIO, ONE)
    keys.check(USB, TWO)
    assert not keys.check(USB, ONE)
    assert keys.known(USB) == [TWO, ONE]


def test_ports_are_robots_of_their_own(tmp_path: Path) -> None:
    keys = HostKeys(tmp_path)
    keys.check(Address("127.0.0.2", 2222), ONE)
    assert keys.check(Address("127.0.0.2", 2223), TWO)
    assert (tmp_path / KNOWN_HOSTS).read_text().startswith("[127.0.0.2]:2222 ssh-ed25519 ")


@pytest.mark.skipif(shutil.which("ssh-keygen") is None, reason="needs OpenSSH's ssh-keygen")
def test_the_file_is_not_committed_and_openssh_reads_it(tmp_path: Path) -> None:
    made = tmp_path / "key"
    subprocess.run(["ssh-keygen", "-q", "-t", "ed25519", "-N", "", "-f", str(made)], check=True)
    said = subprocess.run(["ssh-keygen", "-lf", f"{made}.pub"], capture_output=True, text=True, check=True).stdout
    key = HostKey("ssh-ed25519", base64.b64decode(made.with_suffix(".pub").read_text().split()[1]))
    HostKeys(tmp_path).check(RADIO, key)
    assert key.fingerprint in said
    found = subprocess.run(
        ["ssh-keygen", "-F", RADIO.host, "-l", "-f", str(tmp_path / KNOWN_HOSTS)], capture_output=True, text=True
    )
    assert key.fingerprint in found.stdout
    assert (tmp_path / KNOWN_HOSTS).with_name(".gitignore").read_text() == "*\n"


def test_a_line_that_is_no_key_is_told_by_its_number(tmp_path: Path) -> None:
    file = tmp_path / KNOWN_HOSTS
    file.parent.mkdir()
    file.write_text("# mine\n\n10.12.34.2 ssh-ed25519 ***\n")
    with pytest.raises(HostKeyError, match=r"\.pyfrc/known_hosts:3: .*\n.*Remove the line"):
        HostKeys(tmp_path)
