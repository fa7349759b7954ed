"""The agent in this process, on a directory that stands for a robot's disk."""

from __future__ import annotations

import hashlib
import io
import os
import zlib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from pyfrc_core.deploy.agent.host import RealRobot
from pyfrc_core.deploy.agent.layout import Layout
from pyfrc_core.deploy.agent.robot_paths import RobotPaths
from pyfrc_core.deploy.agent.serve import Agent
from pyfrc_core.deploy.agent.wire import CONTENT, Wire, frame, message_frame, parse_message, read_frame
from pyfrc_core.deploy.targets.roborio import ROBORIO

Message = dict[str, Any]


def manifest(files: Mapping[str, str], executable: tuple[str, ...] = ()) -> list[list[Any]]:
    """The list of files as a laptop sends it."""
    return [
        [name, len(text.encode()), hashlib.sha256(text.encode()).hexdigest(), name in executable]
        for name, text in files.items()
    ]


def contents(*texts: str) -> bytes:
    """The frame with these contents."""
    return frame(CONTENT, zlib.compress("".join(texts).encode()))


class AgentDisk:
    """A robot's disk, and an agent on it."""

    def __init__(self, root: Path, layout: Layout = ROBORIO.layout) -> None:
        self.root = root
        self.places = RobotPaths(layout, str(root))
        self.home = self.places.home
        self.home.mkdir(parents=True)
        (root / "tmp").mkdir()

    def ask(self, *requests: Message | bytes, hello: Message | None = None) -> list[Message]:
        """Send requests to an agent, and return its messages after the facts.

        Keep-alive messages, which a busy machine causes, are left out.
        """
        source, target = os.pipe()
        os.write(target, b"".join(each if isinstance(each, bytes) else message_frame(each) for each in requests))
        os.close(target)
        responses = io.BytesIO()
        with os.fdopen(source, "rb", buffering=0) as stream:
            agent = Agent(Wire(stream, responses), RealRobot(self.places), hello or {"who": "Ada"})
            try:
                agent.serve()
            finally:
                if agent._lock is not None:  # which ends with the agent's process
                    agent._lock.close()
        responses.seek(0)
        messages = []
        while responses.tell() < len(responses.getvalue()):
            messages.append(parse_message(*read_frame(responses.read)))
        return [each for each in messages if "alive" not in each][1:]

    def deploy(self, files: Mapping[str, str], *sent: str, main: str = "robot.py", **more: Any) -> list[Message]:
        """Deploy these files, and send the contents that are expected to be asked for."""
        request = {"op": "deploy", "files": manifest(files), "main": main, "deploy_json": {"by": "Ada"}, **more}
        return self.ask(request, *([contents(*sent)] if sent else []))

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
