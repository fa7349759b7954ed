"""The environments that are like Windows and macOS (`other_systems`) lack what these lack, for our code and robots'."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from textwrap import dedent

import pytest
from on_another_system import environment_of
from skips import missing_python, require

# Without it, no names are known to be absent.
mypy = pytest.importorskip("mypy")

require("environments like other systems'", [*(["Linux"] if sys.platform != "linux" else []), *missing_python()])

#: What they stand for is tested when the suite runs in them, at night.
pytestmark = pytest.mark.slow

Run = Callable[..., str]


def run_on(system: str, directory: Path, code: str, name: str = "program.py") -> str:
    """Run a program there, and return what it prints."""
    file = directory / name
    file.parent.mkdir(exist_ok=True)
    file.write_text(dedent(code), encoding="utf-8")
    environment = environment_of(system, directory, dict(os.environ))
    done = subprocess.run([sys.executable, str(file)], env=environment, cwd=directory, capture_output=True, check=False)
    assert done.returncode == 0, done.stderr.decode(errors="replace")
    return done.stdout.decode("cp1252").replace("\r\n", "\n")


@pytest.fixture
def windows(tmp_path: Path) -> Run:
    return lambda code, **options: run_on("windows", tmp_path.resolve(), code, **options)


@pytest.fixture
def macos(tmp_path: Path) -> Run:
    return lambda code, **options: run_on("macos", tmp_path.resolve(), code, **options)


REFUSALS = """
    from pathlib import Path

    def refused(call, *arguments, **options):
        try:
            call(*arguments, **options)
        except OSError as error:
            return type(error).__name__, getattr(error, "winerror", error.errno)
        return "done"
"""


def test_names_and_modules_that_windows_lacks(windows: Run) -> None:
    code = """
        import os, select, signal, socket, sys, time
        from importlib.util import find_spec
        print(sys.platform, os.name, repr(os.linesep))
        print([name for name in ("fork", "getuid", "killpg", "pread", "register_at_fork") if hasattr(os, name)])
        print([name for name in ("SIGKILL", "SIGHUP", "SIGALRM", "setitimer") if hasattr(signal, name)])
        print(hasattr(select, "poll"), hasattr(socket, "AF_UNIX"), hasattr(time, "clock_gettime"))
        print(sorted(each.name for each in signal.Signals if each.name.startswith("SIG")))
        for name in ("fcntl", "pwd", "resource", "termios"):
            try:
                __import__(name, globals())
                print(name)
            except ModuleNotFoundError:
                pass
        import msvcrt
    """
    assert windows(code).splitlines() == [
        r"win32 nt '\r\n'",
        "[]",
        "[]",
        "False False False",
        "['SIGABRT', 'SIGBREAK', 'SIGFPE', 'SIGILL', 'SIGINT', 'SIGSEGV', 'SIGTERM']",
    ]


def test_the_standard_library_and_packages_keep_linux(windows: Run) -> None:
    code = "import os\nprint(os.name, hasattr(os, 'fork'))\n"
    assert windows(code, name="site-packages/package.py") == "posix True\n"
    module = "import sys\nsys.path.insert(0, 'site-packages')\nimport package, subprocess\nprint(subprocess._mswindows)"
    assert windows(module) == "posix True\nFalse\n"


def test_a_file_that_is_open_stays(windows: Run) -> None:
    code = (
        REFUSALS
        + """
    import os
    Path("kept").mkdir()
    file, other = Path("kept/open.txt"), Path("other.txt")
    other.write_text("other")
    with file.open("w") as stream:
        print(refused(file.unlink), refused(other.replace, file), refused(file.replace, "new.txt"))
        print(refused(Path("kept").replace, "moved"), refused(file.rename, other))
    print(refused(file.rename, other), refused(other.replace, file), refused(file.unlink))
    os.chdir("kept")
    print(refused(Path("../kept").rmdir))
    """
    )
    assert windows(code).splitlines() == [
        "('PermissionError', 32) ('PermissionError', 5) ('PermissionError', 32)",
        "('PermissionError', 5) ('FileExistsError', 183)",
        "('FileExistsError', 183) done done",
        "('PermissionError', 32)",
    ]


def test_a_file_that_another_process_has_open_stays(windows: Run) -> None:
    code = (
        REFUSALS
        + """
    import subprocess, sys
    Path("open.txt").write_text("")
    reads = "file = open('open.txt'); print(flush=True); input()"
    with subprocess.Popen([sys.executable, "-c", reads], stdin=subprocess.PIPE, stdout=subprocess.PIPE) as process:
        process.stdout.readline()
        print(refused(Path("open.txt").unlink))
        process.communicate(b"\\n")
    print(refused(Path("open.txt").unlink))
    """
    )
    assert windows(code) == "('PermissionError', 32)\ndone\n"


def test_names_on_windows(windows: Run) -> None:
    code = (
        REFUSALS
        + """
    Path("Robot.py").write_text("here")
    print(Path("robot.PY").read_text(), Path("ROBOT.py").is_file())
    print([refused(Path(name).write_text, "") for name in ("con", "aux.txt", "a:b", "why?", "dot.")])
    print(refused(Path("link").symlink_to, "Robot.py"), refused(Path("Robot.py", "below").open), refused(Path().open))
    print(refused(lambda: list(Path("/proc").iterdir())), Path("/proc/self/status").exists())
    """
    )
    assert windows(code).splitlines() == [
        "here True",
        str([("OSError", 123)] * 5),
        "('OSError', 1314) ('FileNotFoundError', 3) ('PermissionError', 13)",
        "('FileNotFoundError', 2) False",
    ]


def test_text_on_windows(windows: Run) -> None:
    code = """
        import os, subprocess, sys
        from pathlib import Path
        Path("a.txt").write_text("é\\n")
        print(Path("a.txt").read_bytes(), ascii(Path("a.txt").read_text()), sys.stdout.encoding, sys.stdout.errors)
        child = [sys.executable, "-c", "print('é')"]
        print(subprocess.run(child, capture_output=True).stdout)
        print(ascii(subprocess.run(child, capture_output=True, text=True).stdout))
        try:
            print("→")
        except UnicodeEncodeError:
            print("not in cp1252")
        descriptor = os.open("b.txt", os.O_WRONLY | os.O_CREAT)
        os.write(descriptor, b"text\\n")
        os.close(descriptor)
        print(Path("b.txt").read_bytes())
    """
    assert windows(code).splitlines() == [
        r"b'\xe9\r\n' '\xe9\n' cp1252 strict",
        r"b'\xe9\r\n'",
        r"'\xe9\n'",
        "not in cp1252",
        r"b'text\r\n'",
    ]


def test_processes_on_windows(windows: Run) -> None:
    code = """
        import multiprocessing, os, select, signal, subprocess, sys, time
        waits = "import signal; signal.signal(signal.SIGTERM, print); print(flush=True); input()"
        waits = [sys.executable, "-c", waits]
        for end in (lambda process: process.terminate(), lambda process: os.kill(process.pid, signal.SIGTERM)):
            with subprocess.Popen(waits, stdin=subprocess.PIPE, stdout=subprocess.PIPE) as process:
                process.stdout.readline()
                end(process)
                print(process.wait())
        print(hex(subprocess.run([sys.executable, "-c", "import ctypes; ctypes.string_at(0)"]).returncode))
        for call in (
            lambda: os.kill(os.getpid(), 0),
            lambda: select.select([], [], [], 0),
            lambda: select.select([0], [], [], 0),
            lambda: signal.signal(1, signal.SIG_IGN),
            lambda: subprocess.run([sys.executable], preexec_fn=print),
        ):
            try:
                call()
            except (OSError, ValueError) as error:
                print(getattr(error, "winerror", error))
        print(multiprocessing.get_start_method(), multiprocessing.get_all_start_methods)
    """
    *printed, last = windows(code).splitlines()
    assert printed == [
        *("1", "1", "0xc0000005", "87", "10022", "10038", "invalid signal value"),
        "preexec_fn is not supported on Windows platforms",
    ]
    assert last.startswith("spawn ")


def test_clocks_on_windows(windows: Run) -> None:
    code = """
        import time
        print([time.monotonic() % 0.015625, time.time_ns() % 15_625_000], time.get_clock_info("monotonic").resolution)
    """
    assert windows(code) == "[0.0, 0] 0.015625\n"


def test_what_macos_has_and_lacks(macos: Run) -> None:
    code = (
        REFUSALS
        + """
    import multiprocessing, os, signal, socket, sys, tempfile
    Path("Robot.py").write_text("here", encoding="utf-8")
    print(sys.platform, os.name, hasattr(os, "fork"), hasattr(os, "pidfd_open"), hasattr(signal, "SIGKILL"))
    print(Path("robot.py").is_file(), multiprocessing.get_start_method(), Path("/proc/self").exists())
    temporary = Path(tempfile.gettempdir())
    print(temporary == temporary.resolve(), "private" in temporary.resolve().parts)
    bind = socket.socket(socket.AF_UNIX).bind
    print(refused(bind, "\\0name"), refused(bind, "n" * 104))
    """
    )
    assert macos(code).splitlines() == [
        "darwin posix True False True",
        "True spawn False",
        "False True",
        "('FileNotFoundError', 2) ('OSError', 63)",
    ]
