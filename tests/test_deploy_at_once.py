"""Small changes: their contents follow the request, without waiting for the robot to ask for them."""

from __future__ import annotations

import contextlib
from pathlib import Path
from typing import Any

import pytest
from roborio.fixtures import local_robot  # noqa: F401 - `robot`
from roborio.local import Agents, LocalRobot, project_of

from pyfrc_core.deploy.agent_client import AgentClient, DeployRequest
from pyfrc_core.deploy.errors import ConnectionFailedError, DeployError, RefusedError
from pyfrc_core.deploy.facts import Deployed
from pyfrc_core.deploy.recovery_hints import explain_interruption

FILES = {"robot.py": "A = 1\n", "b.py": "B = 1\n", "c.py": "C = 1\n"}


class Deploys:
    """Deploys files with the first message's manifest, and notes what was sent at once and what on request."""

    def __init__(self, robot: LocalRobot, agents: Agents, directory: Path, monkeypatch: pytest.MonkeyPatch) -> None:
        self.robot = robot
        self._agents = agents
        self._directory = directory
        self.sent: list[list[str]] = []
        send_contents = AgentClient._send_contents

        def noting(client: AgentClient, entries: list[Any], *others: Any) -> None:
            self.sent.append([each.path for each in entries])
            send_contents(client, entries, *others)

        monkeypatch.setattr(AgentClient, "_send_contents", noting)

    def __call__(self, files: dict[str, str], *, in_place: bool = False) -> Deployed:
        self.sent.clear()
        project = project_of(self._directory / "project", {**files})
        with contextlib.closing(self.robot.start(self._agents, project)) as session:
            asked = session._stream.read_message

            def read_message(parse: Any) -> Any:
                self.sent.append(["asked"])
                return asked(parse)

            session._stream.read_message = read_message  # type: ignore[method-assign]
            deployed = session.deploy(project, DeployRequest("robot.py", {}, in_place=in_place))
        assert self.robot.startable() == {name: text.encode() for name, text in files.items()}
        return deployed


@pytest.fixture
def deploy(robot: LocalRobot, agents: Agents, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Deploys:
    return Deploys(robot, agents, tmp_path, monkeypatch)


def test_what_changed_follows_the_request(deploy: Deploys) -> None:
    deploy(FILES)
    assert deploy.sent == [["asked"], ["b.py", "c.py", "robot.py"]]
    assert not deploy(FILES).files_sent
    assert deploy.sent == [["asked"]]
    changed = {**FILES, "b.py": "B = 2\n", "d.py": "D = 1\n", "same_as_d.py": "D = 1\n"}
    deployed = deploy(changed)
    assert deploy.sent == [["b.py", "d.py", "same_as_d.py"], ["asked"]]
    assert (deployed.release, deployed.files_sent, deployed.bytes_sent) == (2, 3, 18)
    pyc = {each.name.split(".")[0] for each in (deploy.robot.home / "py/__pycache__").iterdir()}
    assert pyc == {"robot", "b", "c", "d", "same_as_d"}


def test_a_file_that_the_program_has_changed_is_asked_for(deploy: Deploys) -> None:
    deploy(FILES)
    (deploy.robot.home / "py/c.py").write_text("C = 3\n")
    deployed = deploy({**FILES, "b.py": "B = 2\n"})
    assert deploy.sent == [["b.py"], ["asked"], ["c.py"]]
    assert deployed.files_sent == 2


def test_what_an_earlier_release_has_is_not_written_into_its_file(deploy: Deploys) -> None:
    deploy(FILES)
    deploy({**FILES, "b.py": "B = 2\n"})
    deploy({**FILES, "c.py": "C = 2\n"})
    assert deploy.sent == [["b.py", "c.py"], ["asked"]]
    releases = deploy.robot.home / ".pyfrc/releases"
    assert [(releases / f"{number}/b.py").read_text() for number in (1, 2, 3)] == ["B = 1\n", "B = 2\n", "B = 1\n"]
    assert not (releases / "3/b.py").samefile(releases / "1/b.py")
    assert (releases / "3/robot.py").samefile(releases / "1/robot.py")


def test_large_changes_and_in_place_wait_for_the_request(deploy: Deploys) -> None:
    deploy(FILES)
    large = {**FILES, "b.py": "B = 2\n" * 3000}
    deploy(large)
    assert deploy.sent == [["asked"], ["b.py"]]
    deploy({**large, "c.py": "C = 2\n"}, in_place=True)
    assert deploy.sent == [["asked"], ["c.py"]]


def test_a_refusal_before_the_contents_are_read(deploy: Deploys, agents: Agents, tmp_path: Path) -> None:
    deploy(FILES)
    project = project_of(tmp_path / "project", {**FILES, "b.py": "B = 2\n"})
    with contextlib.closing(deploy.robot.start(agents, project)) as session:
        with pytest.raises(RefusedError, match=r"no other\.py"):
            session.deploy(project, DeployRequest("other.py", {}))
        assert session.info().current == 1, "what was sent is skipped"
        assert session.deploy(project, DeployRequest("robot.py", {})).release == 2


def test_a_file_that_changes_while_it_is_sent(deploy: Deploys, agents: Agents, tmp_path: Path) -> None:
    deploy(FILES)
    project = project_of(tmp_path / "project", {**FILES, "b.py": "B = 2\n"})
    with contextlib.closing(deploy.robot.start(agents, project)) as session:
        (tmp_path / "project/b.py").write_text("B = 3\n")
        with pytest.raises(RefusedError, match="changed while it was sent"):
            session.deploy(project, DeployRequest("robot.py", {}))
    assert deploy.robot.startable() == {name: text.encode() for name, text in FILES.items()}


@pytest.mark.parametrize("changed", [True, False], ids=["changed", "unchanged"])
@pytest.mark.parametrize(
    ("error", "code"),
    [(ConnectionFailedError("the connection to the robot was lost"), 4), (KeyboardInterrupt(), 2)],
    ids=["connection", "Ctrl-C"],
)
def test_an_end_before_the_robots_list_arrives_may_come_after_the_switch(
    error: BaseException, code: int, changed: bool, deploy: Deploys, agents: Agents, tmp_path: Path
) -> None:
    """The robot needs nothing more from this computer: it switches and restarts."""
    deploy(FILES)
    files = {**FILES, "b.py": "B = 2\n"} if changed else FILES
    project = project_of(tmp_path / "project", files)
    with contextlib.closing(deploy.robot.start(agents, project)) as session:

        def read_message(parse: Any) -> Any:
            session._stream.read_response(lambda fields: None, lambda fields: None)  # until the robot has switched
            raise error

        session._stream.read_message = read_message  # type: ignore[method-assign]
        with pytest.raises(DeployError) as caught, explain_interruption(session):
            session.deploy(project, DeployRequest("robot.py", {}, restart=True))
    assert deploy.robot.startable() == {name: text.encode() for name, text in files.items()}
    assert caught.value.exit_code == code
    assert "the robot may have switched to the new release" in caught.value.message
    assert "it may already run the new one" in caught.value.message
