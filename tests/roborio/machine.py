"""The look-alike of a roboRIO from outside."""

from __future__ import annotations

import io
import os
import shutil
import socket
import sys
import tarfile
from pathlib import Path
from random import Random

from pyfrc_core.deploy.targets.roborio import ROBORIO

from .computer import PATIENCE, Computer, bound, listener, missing_here

__all__ = [
    "KILL_SCRIPT",
    "LETS_PROGRAMS_SURVIVE",
    "PATIENCE",
    "Roborio",
    "missing_here",
    "python_package",
]

HERE = Path(__file__).parent
#: Files to take for ``frcKillRobot.sh``; the first is the default one, which takes no time.
KILL_SCRIPT = HERE / "files/usr/local/frc/bin/frcKillRobot.sh"
LETS_PROGRAMS_SURVIVE = HERE / "kill_scripts/lets_programs_survive.sh"
_LVUSER = 500
_PASSWD = """\
root:x:0:0::/:/usr/sbin/nologin
admin::0:0::/home/admin:/bin/bash
lvuser::500:500::/home/lvuser:/bin/bash
sshd:x:74:74::/run/sshd:/usr/sbin/nologin
"""


def require_roborio() -> None:
    """Skip the test where there can be no look-alike: for tests with much to do before they make one."""
    from skips import require  # which the tests can import; `python -m tests.roborio` starts elsewhere

    require("deploying to a look-alike of a roboRIO", missing_here())


def python_package(version: str) -> bytes:
    """A package for opkg with a Python for a blank look-alike: this machine's, which is there under its own path.

    :param version: its version
    """
    library = f"lib/python{sys.version_info.major}.{sys.version_info.minor}"
    links = []
    for name, target in (("bin/python3", os.path.realpath(sys.executable)), (library, f"{sys.base_prefix}/{library}")):
        link = tarfile.TarInfo(f"./usr/local/{name}")
        link.type, link.linkname = tarfile.SYMTYPE, target
        links.append((link, b""))
    more = Random(1).randbytes(200_000)  # so that it takes a while to arrive
    return _tar(
        _file("./debian-binary", b"2.0\n"),
        _file("./control.tar.gz", _tar(_file("./control", f"Package: python314\nVersion: {version}\n".encode()))),
        _file("./data.tar.gz", _tar(*links, _file("./usr/local/share/python.bin", more))),
    )


def _file(name: str, content: bytes) -> tuple[tarfile.TarInfo, bytes]:
    member = tarfile.TarInfo(name)
    member.size = len(content)
    return member, content


def _tar(*members: tuple[tarfile.TarInfo, bytes]) -> bytes:
    packed = io.BytesIO()
    with tarfile.open(fileobj=packed, mode="w:gz", compresslevel=1) as tar:
        for member, content in members:
            tar.addfile(member, io.BytesIO(content))
    return packed.getvalue()


class Roborio(Computer):
    """A roboRIO look-alike that is switched on, until the end of the ``with`` block.

    :param host:           see `Computer` for this parameter, and for others that are not here
    :param wpilib:         the version of `wpilib` on it
    :param blank:          whether it was just imaged: it has neither Python nor packages. What `python_package` makes
                           is a Python for it
    :param image:          its image's version
    :param kill_script:    a file to take for ``frcKillRobot.sh``
    """

    controller = ROBORIO
    user_id = _LVUSER

    def __init__(
        self,
        *,
        host: str | None = None,
        port: int | None = None,
        wpilib: str = "2026.2.2",
        blank: bool = False,
        image: str = "FRC_roboRIO_2026_v1.2",
        python: str | Path | None = sys.executable,
        disk_size: str = "64m",
        kill_script: Path | None = None,
    ) -> None:
        if missing_here():
            require_roborio()  # here, so that no test can go without it
        self._wpilib, self._blank, self._image, self._kill_script = wpilib, blank, image, kill_script
        super().__init__(host=host, port=port, python=python, disk_size=disk_size)

    def _listeners(self) -> list[socket.socket]:
        return [listener(self.host, port) for port in (1740, 1741)]

    def _program(self) -> list[str]:
        return [str(HERE / "inside.py"), str(self._root)]

    def _python_mounts(self, prefix: Path, hidden: list[str]) -> list[str]:
        if prefix.is_relative_to("/usr") and not prefix.is_relative_to("/usr/local"):
            return [f"[ ! -d .{prefix}/{each} ] || mount -t tmpfs -o ro tmpfs .{prefix}/{each}" for each in hidden]
        return bound(prefix, str(prefix).lstrip("/"), hidden)

    def _install(self) -> None:
        shutil.copytree(HERE / "files/etc", self.disk / "etc", dirs_exist_ok=True)
        shutil.copytree(HERE / "files/usr/local", self.disk / "usr/local", dirs_exist_ok=True)
        (self.disk / "var/run").symlink_to("/run")
        for directory in ("bin", "frc/bin", "natinst/bin"):
            for script in (self.disk / "usr/local" / directory).iterdir():
                script.chmod(0o755)
        if (awk := shutil.which("awk")) is not None:  # scripts use it; the host's may be a link by way of /etc
            (self.disk / "usr/local/bin/awk").symlink_to(Path(awk).resolve())
        metadata = self.disk / "etc/natinst/share/scs_imagemetadata.ini"
        os.chown(self.disk / "etc/natinst/share/lvrt.conf", _LVUSER, _LVUSER)
        metadata.write_text(metadata.read_text().replace("@IMAGE_VERSION@", self._image))
        packages = self.disk / "usr/local/lib/python3.14/site-packages"
        if self._blank:
            shutil.rmtree(packages.parent)
        else:
            with (packages / "wpilib/__init__.py").open("a") as file:
                file.write(f'\n__version__ = "{self._wpilib}"\n')
            for name in ("wpilib", "robotpy"):
                about = packages / f"{name}-{self._wpilib}.dist-info"
                about.mkdir()
                (about / "METADATA").write_text(f"Metadata-Version: 2.1\nName: {name}\nVersion: {self._wpilib}\n")
        python3 = self.disk / "usr/local/bin/python3"
        if self.executable is None or self._blank:
            python3.unlink()
        else:
            python3.write_text(python3.read_text().replace("@PYTHON@", str(self.executable)))
        if self._kill_script is not None:
            copied = shutil.copy(self._kill_script, self.disk / "usr/local/frc/bin/frcKillRobot.sh")
            copied.chmod(0o755)
        self.put("etc/passwd", _PASSWD, owner=0)
        self.put("etc/group", "root:x:0:\nadministrators:x:0:\nni:x:500:\nsshd:x:74:\n", owner=0)
        for name, owner in (("lvuser", _LVUSER), ("admin", 0)):
            (self.disk / "home" / name).mkdir()
            os.chown(self.disk / "home" / name, owner, owner)
