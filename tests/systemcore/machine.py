"""The look-alike of a SystemCore from outside."""

from __future__ import annotations

import os
import shlex
import shutil
import socket
import sys
from pathlib import Path

from roborio.computer import Computer, bound, crypted, missing_here

from pyfrc_core.deploy.targets.systemcore import SYSTEMCORE

HERE = Path(__file__).parent
_SUDO = "/usr/bin/sudo"
_PASSWD = """\
root:x:0:0::/root:/usr/sbin/nologin
systemcore:{password}:1000:1000::/home/systemcore:/bin/bash
sshd:x:74:74::/run/sshd:/usr/sbin/nologin
"""
_SUDOERS = """\
Defaults secure_path="/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin"
root ALL=(ALL:ALL) ALL
systemcore ALL=(ALL) NOPASSWD: ALL
"""
_PAM = "".join(f"{kind} required pam_permit.so\n" for kind in ("auth", "account", "session"))


def require_systemcore() -> None:
    """Skip the test where there can be no look-alike."""
    from skips import require

    require("deploying to a look-alike of a SystemCore", missing_here(_SUDO))


class Systemcore(Computer):
    """A SystemCore look-alike that is switched on, until the end of the ``with`` block.

    :param host:          see `Computer` for this parameter, and for others that are not here
    :param wpilib:        the version of `wpilib` on it; none: not installed
    :param password:      of its user
    """

    controller = SYSTEMCORE
    user_id = 1000

    def __init__(
        self,
        *,
        host: str | None = None,
        port: int | None = None,
        wpilib: str | None = "2027.0.0a7",
        python: str | Path | None = sys.executable,
        disk_size: str = "64m",
        password: str = "systemcore",
    ) -> None:
        if missing_here(_SUDO):
            require_systemcore()  # here, so that no test can go without it
        self._wpilib, self._password = wpilib, password
        super().__init__(host=host, port=port, python=python, disk_size=disk_size)

    def _listeners(self) -> list[socket.socket]:
        return []

    def _program(self) -> list[str]:
        return [str(HERE / "inside.py"), str(self._root)]

    def _python_mounts(self, prefix: Path, hidden: list[str]) -> list[str]:
        place = f"{self.home_directory}/.python"
        lines = bound(prefix, place.lstrip("/"), hidden)
        if not prefix.is_relative_to("/usr"):  # its shared library may be looked for where it was installed
            own = str(prefix).lstrip("/")
            lines += [f"mkdir -p {shlex.quote(str(Path(own).parent))}", f"ln -s {place} {shlex.quote(own)}"]
        return lines

    def _install(self) -> None:
        shutil.copytree(HERE / "files/usr/local", self.disk / "usr/local", dirs_exist_ok=True)
        (self.disk / "var/run").symlink_to("/run")
        for script in (self.disk / "usr/local/bin").iterdir():
            script.chmod(0o755)
        wants = self.disk / "etc/systemd/system/multi-user.target.wants"
        wants.mkdir(parents=True)
        (wants / "robot.service").symlink_to("/usr/lib/systemd/system/robot.service")  # as an image comes
        (self.disk / "root").mkdir(exist_ok=True)
        self.home.mkdir(exist_ok=True)
        os.chown(self.home, self.user_id, self.user_id)
        self.put("etc/passwd", _PASSWD.format(password=crypted(self._password)), owner=0)
        self.put("etc/group", "root:x:0:\nsystemcore:x:1000:\nsshd:x:74:\n", owner=0)
        self.put("etc/hosts", f"127.0.0.1 localhost {socket.gethostname()}\n", owner=0)
        self.put("etc/sudoers", _SUDOERS, owner=0, mode=0o440)
        self.put("etc/pam.d/sudo", _PAM, owner=0)
        if self.executable is not None and self.prefix is not None:
            self._make_environment(f"{self.home_directory}/.python/{self.executable.relative_to(self.prefix)}")

    def _make_environment(self, python: str) -> None:
        """Make the environment ``venv`` as the module `venv` does it, with stand-ins for the robot's packages.

        :param python: the path of its Python
        """
        version = Path(python).name.removeprefix("python")
        packages = f"{self.home_directory}/venv/lib/python{version}/site-packages"
        self.put(f"{packages}/.keep", "")
        self.put(
            f"{self.home_directory}/venv/pyvenv.cfg",
            f"home = {Path(python).parent}\ninclude-system-site-packages = false\nversion = {version}\n",
        )
        binaries = self.home / "venv/bin"
        binaries.mkdir()
        for name in ("python3", "python"):
            (binaries / name).symlink_to(python)
        if self._wpilib is not None:
            for file in (HERE / "site-packages").rglob("*.py"):
                self.put(f"{packages}/{file.relative_to(HERE / 'site-packages')}", file.read_text(encoding="utf-8"))
            self.put(f"{packages}/wpilib/version.py", f'version = "{self._wpilib}"\n')
            for name in ("wpilib", "robotpy"):
                about = f"Metadata-Version: 2.1\nName: {name}\nVersion: {self._wpilib}\n"
                self.put(f"{packages}/{name}-{self._wpilib}.dist-info/METADATA", about)
