"""The look-alike from outside: makes its disk, switches its power, looks at what is on it.

Its disk is a tmpfs in a mount namespace that a process of ours holds; its processes live in namespaces of their own
(mounts, processes, network) above that. So nothing of the host is changed, all is gone with those processes, several of
them can run side by side, and pulling its power is one SIGKILL.
"""

from __future__ import annotations

import contextlib
import functools
import os
import shlex
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import threading
from pathlib import Path
from types import TracebackType

HERE = Path(__file__).parent
#: Seconds after which a test gives up. Decides nothing else: a busy machine may take its time.
PATIENCE = 120.0
LVUSER, NI = 500, 500
#: Files to take for ``frcKillRobot.sh``; the first is the default one, which takes no time.
KILL_SCRIPT = HERE / "files/usr/local/frc/bin/frcKillRobot.sh"
TAKES_TWO_SECONDS = HERE / "kill_scripts/takes_two_seconds.sh"
LETS_PROGRAMS_SURVIVE = HERE / "kill_scripts/lets_programs_survive.sh"
_PASSWD = """\
root:x:0:0::/:/usr/sbin/nologin
admin:{password}:0:0::/home/admin:/bin/bash
lvuser:{password}:500:500::/home/lvuser:/bin/bash
sshd:x:74:74::/run/sshd:/usr/sbin/nologin
"""

_SSHD = """\
HostKey /etc/ssh/host_key
UsePAM no
PermitRootLogin yes
StrictModes no
PermitEmptyPasswords yes
PasswordAuthentication {passwords}
KbdInteractiveAuthentication no
AuthorizedKeysFile /etc/ssh/authorized_keys
MaxSessions 20
Subsystem sftp internal-sftp
"""


@functools.cache
def missing_here() -> tuple[str, ...]:
    """Return what this machine lacks of what a look-alike needs."""
    if sys.platform != "linux":
        return ("Linux",)
    missing = [] if os.geteuid() == 0 else ["root"]
    if shutil.which("sshd", path="/usr/sbin") is None:
        missing.append("sshd")
    if (
        not missing
        and subprocess.run(["unshare", "-m", "-p", "-n", "-f", "true"], capture_output=True, check=False).returncode
    ):
        missing.append("namespaces")  # a system may forbid them even to root
    return tuple(missing)


def require_roborio() -> None:
    """Skip the test where there can be no look-alike: for tests with much to do before they make one."""
    from skips import require  # which the tests can import; `python -m tests.roborio` starts elsewhere

    require("deploying to a look-alike of a roboRIO", missing_here())


class Roborio:
    """A roboRIO look-alike that is switched on, until the end of the ``with`` block.

    :param host:           the loopback address at which it is found; none: a free one
    :param port:           of its SSH server; none: 22, or 2222 where an SSH server of this machine has 22 everywhere
    :param wpilib:         the version of `wpilib` on it; none: not installed
    :param image:          its image's version; none: no image file, so that it is no roboRIO
    :param python:         a Python (3.9 or newer) of this machine, which serves as its own; none: it has no Python
    :param disk_size:      as tmpfs takes it: ``"4m"``
    :param password:       of both users
    :param authorized_key: a public key, in OpenSSH's form; only this key is let in then, no password
    :param kill_script:    a file to take for ``frcKillRobot.sh``
    :param driver_station: whether one is connected all the time; else the console is silent, except while packets such
                           as a Driver Station's arrive (UDP 1110)
    """

    def __init__(
        self,
        *,
        host: str | None = None,
        port: int | None = None,
        wpilib: str | None = "2026.2.2",
        image: str | None = "FRC_roboRIO_2026_v1.2",
        python: str | Path | None = sys.executable,
        disk_size: str = "64m",
        password: str = "",
        authorized_key: str | None = None,
        kill_script: Path | None = None,
        driver_station: bool = True,
    ) -> None:
        if missing_here():
            require_roborio()  # here, so that no test can go without it
        self._driver_station = driver_station
        self._base = Path(tempfile.mkdtemp(prefix="roborio-"))
        self._root = self._base / "root"
        self._root.mkdir()
        self.host, self.port = _free_address([host] if host else _addresses(), [port] if port else [22, 2222])
        self._inside: subprocess.Popen[str] | None = None
        self._init: int | None = None
        self._said = ""
        self._news = threading.Condition()
        #: Whether what the robot program prints is printed here.
        self.echo = False
        try:
            prefix, executable, hidden = _interpreter(python)
            self._holder = self._mount(disk_size, prefix, hidden)
            #: Its root directory, as it can be looked at from outside, also while it has no power.
            self.disk = Path(f"/proc/{self._holder.pid}/root{self._root}")
            self._install(wpilib, image, executable, password, authorized_key, kill_script)
            self.new_host_key()
            self.power_on()
        except BaseException:
            self.close()
            raise

    @classmethod
    def unkind(cls, kill_script: Path = TAKES_TWO_SECONDS, driver_station: bool = False) -> Roborio:
        """One that spares us nothing: a kill that takes its time, no Driver Station."""
        return cls(kill_script=kill_script, driver_station=driver_station)

    def __enter__(self) -> Roborio:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, traceback: TracebackType | None
    ) -> None:
        self.close()

    @property
    def where(self) -> str:
        """As ``pyfrc deploy --robot`` takes it."""
        return self.host if self.port == 22 else f"{self.host}:{self.port}"

    @property
    def home(self) -> Path:
        """lvuser's home, from outside."""
        return self.disk / "home/lvuser"

    @property
    def is_on(self) -> bool:
        """Whether it has power."""
        return self._inside is not None

    def power_on(self) -> None:
        """Switch it on: it listens when this returns, and starts the robot program that it finds on its disk."""
        packets = socket.socket(type=socket.SOCK_DGRAM)
        packets.bind((self.host, 1110))
        listeners = [packets, *(_listener(self.host, port) for port in (self.port, 1740, 1741))]
        numbers = [str(each.fileno()) for each in listeners]
        self._said = ""
        into = ["nsenter", f"--mount=/proc/{self._holder.pid}/ns/mnt"]
        apart = ["unshare", "-m", "-p", "-n", "-f", f"--mount-proc={self._root}/proc"]
        inside = [str(HERE / "inside.py"), str(self._root)]
        inside.append("driver-station" if self._driver_station else "no-driver-station")
        errors = (self._base / "errors").open("w")
        self._inside = subprocess.Popen(
            [*into, *apart, sys.executable, "-I", "-S", *inside, *numbers],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=errors,
            text=True,
            errors="replace",
            pass_fds=[each.fileno() for each in listeners],
        )
        for each in (errors, *listeners):
            each.close()
        assert self._inside.stdout is not None
        ready = self._inside.stdout.readline()
        assert ready == "ready\n", f"the look-alike does not start:\n{(self._base / 'errors').read_text()}"
        threads = Path(f"/proc/{self._inside.pid}/task/{self._inside.pid}/children").read_text(encoding="utf-8")
        self._init = int(threads.split()[0])
        threading.Thread(target=self._listen, args=(self._inside.stdout,), daemon=True).start()

    def power_off(self) -> None:
        """Pull its power: everything in it ends at once, its disk stays. None of it is left when this returns."""
        if self._inside is not None:
            if self._init is None:  # it has not started
                self._inside.kill()
            else:
                with contextlib.suppress(ProcessLookupError):
                    os.kill(self._init, signal.SIGKILL)  # the end of a namespace's first process ends all others
            self._inside.wait()
            assert self._inside.stdin is not None
            self._inside.stdin.close()
            self._inside = self._init = None

    def run(self, *command: str, user: str = "admin") -> subprocess.CompletedProcess[str]:
        """Run a command on it, past the SSH server."""
        into = ["nsenter", f"--target={self._init}", "--mount", "--pid", "--net"]
        ids = "0:0" if user == "admin" else f"{LVUSER}:{NI}"
        change = ["chroot", f"--userspec={ids}", "--groups=", str(self._root), *command]
        return subprocess.run(into + change, capture_output=True, text=True, check=False)

    def said(self, text: str, seconds: float = PATIENCE) -> str:
        """Wait until the robot program has printed `text` since the power was switched on; all that it has printed."""
        with self._news:
            if not self._news.wait_for(lambda: text in self._said, seconds):
                raise AssertionError(f"the robot program has not said {text!r} in {seconds} s, but:\n{self._said}")
            return self._said

    def wait_for_end_of_deploy(self) -> None:
        """Wait until no agent holds the deploy lock: one whose laptop has gone may need a while to notice that."""
        import fcntl  # which Windows has not

        with contextlib.suppress(FileNotFoundError), (self.home / ".pyfrc/lock").open() as lock:
            fcntl.flock(lock, fcntl.LOCK_EX)

    def put(self, name: str, content: str | bytes, *, owner: int = LVUSER, mode: int = 0o644) -> Path:
        """Write a file on its disk (`name` counts from its root)."""
        file = self.disk / name.lstrip("/")
        for directory in reversed(file.parents):
            if not directory.exists():
                directory.mkdir()
                os.chown(directory, owner, owner)
        file.write_bytes(content.encode() if isinstance(content, str) else content)
        file.chmod(mode)
        os.chown(file, owner, owner)
        return file

    def new_host_key(self) -> None:
        """Give it another host key, as imaging it does."""
        key = self.disk / "etc/ssh/host_key"
        key.unlink(missing_ok=True)
        subprocess.run(["ssh-keygen", "-q", "-t", "ed25519", "-N", "", "-C", "", "-f", str(key)], check=True)

    def close(self) -> None:
        """Switch it off for good: its disk is gone as well."""
        self.power_off()
        holder = getattr(self, "_holder", None)
        if holder is not None:
            holder.stdin.close()
            holder.stdout.close()
            holder.wait()
        shutil.rmtree(self._base, ignore_errors=True)

    def _listen(self, stream) -> None:  # type: ignore[no-untyped-def]
        with stream:
            while piece := os.read(stream.fileno(), 65536):
                with self._news:
                    self._said += piece.decode(errors="replace")
                    self._news.notify_all()
                if self.echo:
                    print(piece.decode(errors="replace"), end="", flush=True)

    def _mount(self, disk_size: str, prefix: Path | None, hidden: tuple[Path, ...]) -> subprocess.Popen[bytes]:
        root = self._root
        lines = ["set -e", f"mount -t tmpfs -o size={disk_size},mode=755 tmpfs {root}", f"cd {root}"]
        lines += ["mkdir usr dev proc run tmp home etc var .local"]
        for name in ("bin", "sbin", "lib", "lib64"):
            source = Path("/", name)
            if source.is_symlink():
                lines.append(f"ln -s {source.readlink()} {name}")
            elif source.exists():
                lines.append(f"mkdir {name}; mount --bind {source} {name}; mount -o remount,ro,bind {name}")
        lines += ["mount --bind /usr usr", "mount -o remount,ro,bind usr", "mount --bind .local usr/local"]
        lines += ["mount --bind /dev dev"]
        if prefix is not None:
            inner = str(prefix).lstrip("/")
            lines += [f"mkdir -p {inner}", f"mount --bind {prefix} {inner}", f"mount -o remount,ro,bind {inner}"]
        inside = [shlex.quote(str(directory).lstrip("/")) for directory in hidden]
        lines += [f"[ ! -d {each} ] || mount -t tmpfs -o ro tmpfs {each}" for each in inside]
        holder = subprocess.Popen(
            ["unshare", "-m", "--propagation", "private", "sh", "-c", "\n".join([*lines, "echo ready", "exec cat"])],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
        )
        assert holder.stdout is not None
        ready = holder.stdout.readline()
        assert ready == b"ready\n", "the look-alike's disk cannot be mounted"
        return holder

    def _install(
        self,
        wpilib: str | None,
        image: str | None,
        executable: Path | None,
        password: str,
        authorized_key: str | None,
        kill_script: Path | None,
    ) -> None:
        shutil.copytree(HERE / "files/etc", self.disk / "etc", dirs_exist_ok=True)
        shutil.copytree(HERE / "files/usr/local", self.disk / "usr/local", dirs_exist_ok=True)
        (self.disk / "var/run").symlink_to("/run")
        for directory in ("bin", "frc/bin", "natinst/bin"):
            for script in (self.disk / "usr/local" / directory).iterdir():
                script.chmod(0o755)
        if (awk := shutil.which("awk")) is not None:  # scripts use it; the host's may be a link by way of /etc
            (self.disk / "usr/local/bin/awk").symlink_to(Path(awk).resolve())
        metadata = self.disk / "etc/natinst/share/scs_imagemetadata.ini"
        os.chown(self.disk / "etc/natinst/share/lvrt.conf", LVUSER, NI)
        if image is None:
            shutil.rmtree(self.disk / "etc/natinst")
        else:
            metadata.write_text(metadata.read_text().replace("@IMAGE_VERSION@", image))
        packages = self.disk / "usr/local/lib/python3.14/site-packages"
        if wpilib is None:
            for name in ("wpilib", "wpimath", "robotpy"):
                shutil.rmtree(packages / name)
        else:
            with (packages / "wpilib/__init__.py").open("a") as file:
                file.write(f'\n__version__ = "{wpilib}"\n')
            for name in ("wpilib", "robotpy"):
                about = packages / f"{name}-{wpilib}.dist-info"
                about.mkdir()
                (about / "METADATA").write_text(f"Metadata-Version: 2.1\nName: {name}\nVersion: {wpilib}\n")
        python3 = self.disk / "usr/local/bin/python3"
        if executable is None:
            python3.unlink()
        else:
            python3.write_text(python3.read_text().replace("@PYTHON@", str(executable)))
        if kill_script is not None:
            copied = shutil.copy(kill_script, self.disk / "usr/local/frc/bin/frcKillRobot.sh")
            copied.chmod(0o755)
        self.put("etc/passwd", _PASSWD.format(password=_crypted(password)), owner=0)
        self.put("etc/group", "root:x:0:\nadministrators:x:0:\nni:x:500:\nsshd:x:74:\n", owner=0)
        self.put("etc/ssh/sshd_config", _SSHD.format(passwords="no" if authorized_key else "yes"), owner=0)
        self.put("etc/ssh/authorized_keys", f"{authorized_key or ''}\n", owner=0)
        for name, owner in (("lvuser", LVUSER), ("admin", 0)):
            (self.disk / "home" / name).mkdir()
            os.chown(self.disk / "home" / name, owner, owner)


@functools.cache
def _interpreter(python: str | Path | None) -> tuple[Path | None, Path | None, tuple[Path, ...]]:
    """Return the directory that a Python needs to be seen, if it is not below /usr; its true file; its packages.

    The robot has packages of its own. Starting a Python can cost more for this machine's packages than all else does.
    """
    if python is None:
        return None, None, ()
    question = "import os, site, sys; print(sys.base_prefix); print(os.path.realpath(sys.executable))"
    question += "; print(*site.getsitepackages([sys.base_prefix]), sep='\\n')"
    said = subprocess.run([str(python), "-c", question], capture_output=True, text=True, check=True).stdout.splitlines()
    prefix, executable, packages = Path(said[0]).resolve(), Path(said[1]), tuple(map(Path, said[2:]))
    is_below_usr = prefix.is_relative_to("/usr") and not prefix.is_relative_to("/usr/local")
    return None if is_below_usr else prefix, executable, packages


def _crypted(password: str) -> str:
    if not password:
        return ""
    asked = ["openssl", "passwd", "-6", "-stdin"]
    return subprocess.run(asked, input=password, capture_output=True, text=True, check=True).stdout.strip()


def _addresses() -> list[str]:
    """Some loopback addresses that other processes will hardly choose; the first ones are left for people."""
    first = os.getpid() * 7
    return [f"127.{100 + n // 62500 % 100}.{n // 250 % 250}.{2 + n % 250}" for n in range(first, first + 50)]


def _free_address(addresses: list[str], ports: list[int]) -> tuple[str, int]:
    """Return the first of these that is not in use."""
    for port in ports:
        for address in addresses:
            try:
                _listener(address, port).close()
            except OSError as error:
                failure = error
            else:
                return address, port
    raise failure


def _listener(host: str, port: int) -> socket.socket:
    return socket.create_server((host, port))
