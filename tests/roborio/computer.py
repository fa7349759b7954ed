"""What look-alikes of controllers have in common, from outside: their disk, their power, their SSH server.

The disk is a tmpfs in a mount namespace that a process of ours holds; the processes live in namespaces of their own
(mounts, processes, network) above that. So nothing of the host is changed, all is gone with those processes, several of
them can run side by side, and pulling the power is one SIGKILL.
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
from typing import TYPE_CHECKING, ClassVar, TypeVar

if TYPE_CHECKING:
    from pyfrc_core.deploy.targets import ControllerKind

#: Seconds after which a test gives up. Decides nothing else: a busy machine may take its time.
PATIENCE = 120.0
_SSHD = """\
HostKey /etc/ssh/host_key
UsePAM no
PermitRootLogin yes
StrictModes no
PermitEmptyPasswords yes
PasswordAuthentication yes
KbdInteractiveAuthentication no
MaxSessions 20
Subsystem sftp internal-sftp
"""

T = TypeVar("T", bound="Computer")


@functools.cache
def missing_here(*programs: str) -> tuple[str, ...]:
    """Return what this machine lacks of what a look-alike needs.

    :param programs: paths of further programs
    """
    if sys.platform != "linux":
        return ("Linux",)
    missing = [] if os.geteuid() == 0 else ["root"]
    missing += [Path(each).name for each in ("/usr/sbin/sshd", *programs) if not Path(each).exists()]
    if (
        not missing
        and subprocess.run(["unshare", "-m", "-p", "-n", "-f", "true"], capture_output=True, check=False).returncode
    ):
        missing.append("namespaces")  # a system may forbid them even to root
    return tuple(missing)


class Computer:
    """A look-alike that is switched on, until the end of the ``with`` block.

    :param host:           the loopback address at which it is found; none: a free one
    :param port:           of its SSH server; none: 22, or 2222 where an SSH server of this machine has 22 everywhere
    :param python:         a Python (3.9 or newer) of this machine, which serves as its own; none: it has no Python
    :param disk_size:      as tmpfs takes it: ``"4m"``
    """

    controller: ClassVar[ControllerKind]
    #: The number of the user who runs the robot program, and of the user's group.
    user_id: ClassVar[int]

    def __init__(
        self,
        *,
        host: str | None,
        port: int | None,
        python: str | Path | None,
        disk_size: str,
    ) -> None:
        self._base = Path(tempfile.mkdtemp(prefix="look-alike-"))
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
            self.prefix, self.executable, hidden = _interpreter(python)
            self._holder = self._mount(disk_size, hidden)
            #: Its root directory, as it can be looked at from outside, also while it has no power.
            self.disk = Path(f"/proc/{self._holder.pid}/root{self._root}")
            self.put("etc/ssh/sshd_config", _SSHD, owner=0)
            self._install()
            self.new_host_key()
            self.power_on()
        except BaseException:
            self.close()
            raise

    def _install(self) -> None:
        """Write what an image has."""
        raise NotImplementedError

    def _python_mounts(self, prefix: Path, hidden: list[str]) -> list[str]:
        """Return the lines of a shell script that mount a Python of this machine, in the look-alike's root.

        :param hidden: the directories in it with this machine's packages
        """
        raise NotImplementedError

    def _program(self) -> list[str]:
        """Return the program that runs inside, with its arguments except for the listeners."""
        raise NotImplementedError

    def _listeners(self) -> list[socket.socket]:
        """Return what listens outside, besides the SSH server, for the program inside."""
        raise NotImplementedError

    @property
    def user(self) -> str:
        """The user who runs the robot program."""
        return self.controller.layout.user

    @property
    def home_directory(self) -> str:
        """The home directory of this user, on the robot."""
        return self.controller.layout.home

    def __enter__(self: T) -> T:
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
        """The home directory of the program's user, from outside."""
        return self.disk / self.home_directory.lstrip("/")

    @property
    def is_on(self) -> bool:
        """Whether it has power."""
        return self._inside is not None

    def power_on(self) -> None:
        """Switch it on: it listens when this returns, and starts the robot program that it finds on its disk."""
        listeners = [listener(self.host, self.port), *self._listeners()]
        numbers = [str(each.fileno()) for each in listeners]
        self._said = ""
        into = ["nsenter", f"--mount=/proc/{self._holder.pid}/ns/mnt"]
        apart = ["unshare", "-m", "-p", "-n", "-f", f"--mount-proc={self._root}/proc"]
        errors = (self._base / "errors").open("w")
        self._inside = subprocess.Popen(
            [*into, *apart, sys.executable, "-I", "-S", *self._program(), *numbers],
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
        assert ready == "ready\n", (
            f"the look-alike does not start:\n{(self._base / 'errors').read_text(encoding='utf-8')}"
        )
        threads = Path(f"/proc/{self._inside.pid}/task/{self._inside.pid}/children").read_text(encoding="utf-8")
        self._init = int(threads.split()[0])
        self._listening = threading.Thread(target=self._listen, args=(self._inside.stdout,), daemon=True)
        self._listening.start()

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
            if self._init is not None:
                self._listening.join()  # nothing that this program has printed is there after the next start
            self._inside = self._init = None

    def run(self, *command: str, user: str = "admin") -> subprocess.CompletedProcess[str]:
        """Run a command on it, past the SSH server; by default as the administrator."""
        into = ["nsenter", f"--target={self._init}", "--mount", "--pid", "--net"]
        ids = f"{self.user_id}:{self.user_id}" if user == self.user else "0:0"
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

    def put(self, name: str, content: str | bytes, *, owner: int | None = None, mode: int = 0o644) -> Path:
        """Write a file on its disk (`name` counts from its root). By default, it belongs to the program's user."""
        number = self.user_id if owner is None else owner
        file = self.disk / name.lstrip("/")
        for directory in reversed(file.parents):
            if not directory.exists():
                directory.mkdir()
                os.chown(directory, number, number)
        file.write_bytes(content.encode() if isinstance(content, str) else content)
        file.chmod(mode)
        os.chown(file, number, number)
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

    def _mount(self, disk_size: str, hidden: tuple[Path, ...]) -> subprocess.Popen[bytes]:
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
        if self.prefix is not None:
            inside = [str(each.relative_to(self.prefix)) for each in hidden if each.is_relative_to(self.prefix)]
            lines += self._python_mounts(self.prefix, inside)
        lines += ["echo ready", "exec cat"]
        holder = subprocess.Popen(
            ["unshare", "-m", "--propagation", "private", "sh", "-c", "\n".join(lines)],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
        )
        assert holder.stdout is not None
        ready = holder.stdout.readline()
        assert ready == b"ready\n", "the look-alike's disk cannot be mounted"
        return holder


def bound(source: Path, target: str, hidden: list[str]) -> list[str]:
    """Return the lines of a shell script that show a directory of this machine, without some directories in it."""
    quoted = shlex.quote(target)
    lines = [f"mkdir -p {quoted}", f"mount --bind {shlex.quote(str(source))} {quoted}"]
    lines.append(f"mount -o remount,ro,bind {quoted}")
    inside = [shlex.quote(f"{target}/{each}") for each in hidden]
    return lines + [f"[ ! -d {each} ] || mount -t tmpfs -o ro tmpfs {each}" for each in inside]


@functools.cache
def _interpreter(python: str | Path | None) -> tuple[Path | None, Path | None, tuple[Path, ...]]:
    """Return the directory in which a Python is installed; its true file; the directories of its packages.

    The robot has packages of its own. Starting a Python can cost more for this machine's packages than all else does.
    """
    if python is None:
        return None, None, ()
    question = "import os, site, sys; print(sys.base_prefix); print(os.path.realpath(sys.executable))"
    question += "; print(*site.getsitepackages([sys.base_prefix]), sep='\\n')"
    said = subprocess.run([str(python), "-c", question], capture_output=True, text=True, check=True).stdout.splitlines()
    return Path(said[0]).resolve(), Path(said[1]), tuple(map(Path, said[2:]))


def crypted(password: str) -> str:
    """Return a password as ``/etc/passwd`` has it."""
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
                listener(address, port).close()
            except OSError as error:
                failure = error
            else:
                return address, port
    raise failure


def listener(host: str, port: int) -> socket.socket:
    """Return a socket that listens."""
    return socket.create_server((host, port))
