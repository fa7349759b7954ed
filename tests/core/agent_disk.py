"""The agent in this process, on a directory that stands for a robot's disk."""

from __future__ import annotations

import hashlib
import io
import os
import py_compile
import zlib
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from roborio.local import serve_to_the_end
from written_files import zip_of

from pyfrc_core.deploy.agent.activity import Activity
from pyfrc_core.deploy.agent.content_index import ContentIndex, parse_manifest
from pyfrc_core.deploy.agent.environment_files import EnvironmentFiles, Wheel
from pyfrc_core.deploy.agent.environments import Environments
from pyfrc_core.deploy.agent.host import RealRobot
from pyfrc_core.deploy.agent.layout import Layout
from pyfrc_core.deploy.agent.releases import Releases
from pyfrc_core.deploy.agent.robot_paths import RobotPaths
from pyfrc_core.deploy.agent.serve import Agent
from pyfrc_core.deploy.agent.wire import CONTENT, Wire, frame, message_frame, parse_message, read_frame
from pyfrc_core.deploy.targets.roborio import ROBORIO

Message = dict[str, Any]
#: The name of the Python that environments have, and where their packages are.
PYTHON = "0123456789abcdef"
PACKAGES = "lib/python3.14/site-packages"


def manifest(files: Mapping[str, str], executable: tuple[str, ...] = ()) -> list[list[Any]]:
    """The list of files as a laptop sends it."""
    return [
        [name, len(text.encode()), hashlib.sha256(text.encode()).hexdigest(), name in executable]
        for name, text in files.items()
    ]


def contents(*texts: str) -> bytes:
    """The frame with these contents."""
    return frame(CONTENT, zlib.compress("".join(texts).encode()))


def run_quickly(files: EnvironmentFiles, command: list[str], check: bool = True) -> None:
    """What `venv` and `compileall` do, in place of `EnvironmentFiles._run`, without the time that they take."""
    place = Path(command[-1])
    if "venv" in command:
        (place / PACKAGES).mkdir(parents=True)
        (place / "bin").mkdir()
        (place / "bin/python3").symlink_to(command[0])
        (place / "pyvenv.cfg").write_text(f"command = {command[0]} -m venv {place}\n")
        return
    for source in place.rglob("*.py"):
        target = source.parent / "__pycache__" / f"{source.stem}.cpython-314.opt-1.pyc"
        if not target.exists():
            py_compile.compile(str(source), str(target))


class AgentDisk:
    """A robot's disk, and an agent on it."""

    def __init__(self, root: Path, layout: Layout = ROBORIO.layout) -> None:
        self.root = root
        self.places = RobotPaths(layout, str(root))
        self.home = self.places.home
        self.home.mkdir(parents=True, exist_ok=True)
        (root / "tmp").mkdir(exist_ok=True)

    def ask(self, *requests: Message | bytes, hello: Message | None = None) -> list[Message]:
        """Send requests to an agent, and return its messages after the facts.

        Keep-alive messages, which a busy machine causes, are left out.
        """
        source, target = os.pipe()
        os.write(target, b"".join(each if isinstance(each, bytes) else message_frame(each) for each in requests))
        os.close(target)
        responses = io.BytesIO()
        with os.fdopen(source, "rb", buffering=0) as stream:
            serve_to_the_end(Agent(Wire(stream, responses), RealRobot(self.places), hello or {"who": "Ada"}))
        responses.seek(0)
        messages = []
        while responses.tell() < len(responses.getvalue()):
            messages.append(parse_message(*read_frame(responses.read)))
        return [each for each in messages if "alive" not in each][1:]

    def deploy(self, files: Mapping[str, str], *sent: str, main: str = "robot.py", **more: Any) -> list[Message]:
        """Deploy these files, and send the contents that are expected to be asked for."""
        request = {"op": "deploy", "files": manifest(files), "main": main, "deploy_json": {"by": "Ada"}, **more}
        return self.ask(request, *([contents(*sent)] if sent else []))

    def install(self, environment: str, wheels: Mapping[str, Mapping[str, str]]) -> list[str]:
        """Install an environment with these wheels, and return those that were sent."""
        python = PYTHON if self.places.layout.installing.endswith("/pythons") else None
        interpreter = self.places.of(self.places.layout.python)
        if python is not None:
            interpreter = self.places.own / "pythons" / python / "bin/python3"
        interpreter.parent.mkdir(parents=True, exist_ok=True)
        interpreter.touch()
        content = {file: zip_of(files) for file, files in wheels.items()}
        listed = [[file, len(each), hashlib.sha256(each).hexdigest(), 0] for file, each in content.items()]
        sent: list[str] = []

        def receive(missing: Sequence[Wheel], files: Sequence[Path]) -> None:
            for each, file in zip(missing, files, strict=True):
                file.write_bytes(content[each.file])
                sent.append(each.file)

        self.environments.install({"environment": environment, "python": python, "wheels": listed}, receive)
        return sent

    @property
    def environments(self) -> Environments:
        """Its environments, as an agent finds them."""
        return Environments(self.places, Activity(lambda **said: None))

    def needed(self, files: Mapping[str, str]) -> list[str]:
        """The contents that a deploy of these files asks for; remains of an interrupted one are removed."""
        releases = Releases(self.places, Activity(lambda **said: None))
        releases.recover()
        wanted = parse_manifest(manifest(files))
        return [files[each.path] for each in ContentIndex(releases, wanted, releases.activity).missing(wanted)]

    def read(self, name: str) -> str | None:
        """The text of a file in the robot's home; None without one."""
        file = self.home / name
        return file.read_text() if file.is_file() else None

    def startable(self) -> str:
        """What the robot would start: the start command's main file, and the first line of that."""
        text = self.places.start_command()
        if not text:
            return "nothing"
        name = text.partition("--main ")[2].split()[0].removeprefix(f"{self.places.layout.home}/")
        return f"{name}: {(self.home / name).read_text().partition(chr(10))[0]}"

    def tree(self, directory: str = ".pyfrc/releases") -> list[str]:
        """The names of the files, below a directory of the robot's home."""
        place = self.home / directory
        return sorted(
            each.relative_to(place).as_posix()
            for each in place.rglob("*")
            if each.is_file() and "__pycache__" not in each.parts
        )
