"""The commands for the program on a robot: deploy, rollback, undeploy, console, deploy-info."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, replace
from typing import TYPE_CHECKING

from ..errors import UsageError
from ..project import Project
from ..wording import counted, size_text
from .connection import Connection, load_in_background
from .console import follow_console, follow_output
from .discovery import Address
from .errors import RefusedError
from .facts import Release, RobotFacts
from .installing import Environment, install_packages, wanted_environment
from .local_checks import CheckedProgram, DeployOptions, prepare
from .manifest import ascii_path
from .progress import DeployProgress, UserInterface
from .robot_checks import carry_out, refuse_unfit_robot
from .robot_packages import check_packages
from .target_connection import connected, connected_agent, console_address, find, reconnected
from .team import RobotChoice, choose_target

if TYPE_CHECKING:
    from .agent_client import AgentClient
    from .facts import Deployed, Plan

__all__ = ["DeployOptions", "deploy", "rollback", "show_console", "undeploy"]


def deploy(project: Project, options: DeployOptions, talk: UserInterface) -> Address:
    """Deploy the project's program, start it, and return the robot's address.

    :raises DeployError: if the deploy fails; the robot still has a complete program
    :raises ProgramDiedError: if the program was deployed and ended during the watch
    """
    load_in_background()
    target = choose_target(project, options.choice, talk.ask)
    program = prepare(project, options, talk)
    progress = talk.progress
    installs = options.check_versions and not options.dry_run
    wanted = wanted_environment(project, target.controller) if installs else None
    modules, reinstall = program.imports.modules, options.reinstall
    with connected_agent(target, options.choice, progress, modules, wanted, reinstall) as (connection, robot):
        _note_unfit_releases(robot.facts, progress)
        refuse_unfit_robot(robot.facts, connection.controller, str(connection.address), options.check_versions)
        check_packages(
            program.imports,
            program.packages,
            robot.facts,
            talk,
            dry_run=options.dry_run,
            refuse=options.check_versions,
        )
        if program.importing is not None:
            program.importing.refuse_failure(talk)
        if options.dry_run:
            with progress.phase("compare") as phase:
                plan = robot.plan(program.manifest, phase.work)
            progress.result({"host": connection.host, "plan": asdict(plan)}, _plan_as_text(plan), requested=True)
        else:
            _replace_program(robot, connection, program, wanted, options, talk)
    return connection.address


def _replace_program(
    robot: AgentClient,
    connection: Connection,
    program: CheckedProgram,
    wanted: Environment | None,
    options: DeployOptions,
    talk: UserInterface,
) -> None:
    """Upload the program, and start it."""
    from .starting import start

    controller = connection.controller
    deployed = _upload(robot, program, options, talk)

    def reinstall() -> int | None:
        nonlocal deployed
        if wanted is not None and robot.facts.environment == wanted.name:
            with talk.progress.phase("install") as phase:
                install_packages(robot, wanted, phase)
        deployed = _upload(robot, program, replace(options, reinstall=True), talk)
        return deployed.fallback

    try:
        verdict = start(robot, talk, deployed.fallback, options.auto_rollback, reinstall)
    finally:
        _repair_stop(robot, connection, talk.progress)
        # Last, since a failing login as administrator may take half a minute.
        carry_out(controller.save_memory if robot.facts.wastes_memory else None, connection, talk.progress)
        carry_out(controller.remove_remains if robot.facts.remains else None, connection, talk.progress)
    talk.progress.result({"host": connection.host, **asdict(deployed), "program": verdict}, "Deployed.")


def rollback(project: Project | None, choice: RobotChoice, release: int | None, talk: UserInterface) -> Address:
    """Make an earlier release current, start it, and return the robot's address.

    :param release: its number; default: the release that the robot selects
    """
    from .starting import go_back

    with connected_agent(choose_target(project, choice, talk.ask), choice, talk.progress) as (connection, robot):
        _note_unfit_releases(robot.facts, talk.progress)
        try:
            restored = go_back(robot, talk, release)
        finally:
            _repair_stop(robot, connection, talk.progress)
        result = {"host": connection.host, "release": restored}
        talk.progress.result(result, f"The robot runs release {restored} again.")
    return connection.address


def _note_unfit_releases(facts: RobotFacts, progress: DeployProgress) -> None:
    for each in facts.releases:
        if each.damaged:
            progress.note(f"  the record of release {each.number} on the robot is damaged: it cannot be started again")
        elif each.number == facts.current and each.ran and each.ended:
            back = f"only --rollback {each.number} selects it"
            progress.note(f"  release {each.number} ended after its last start: {back}")


def _repair_stop(robot: AgentClient, connection: Connection, progress: DeployProgress) -> None:
    """Replace the robot's stop command if it has not ended the program."""
    if robot.program_survived:
        carry_out(connection.controller.repair_stop(), connection, progress)


def undeploy(project: Project | None, choice: RobotChoice, talk: UserInterface, confirmed: bool) -> None:
    """Remove the program from the robot, with all releases.

    :param confirmed: whether the user has already confirmed this
    """
    target = choose_target(project, choice, talk.ask)
    _confirm("the robot program and all of its releases will be removed", talk, confirmed)
    with connected_agent(target, choice, talk.progress) as (connection, robot):
        with talk.progress.phase("remove") as phase:
            removed = robot.undeploy(phase.work)
        text = "The robot program was removed." if removed else "There was no robot program to remove."
        talk.progress.result({"host": connection.host, "removed": removed}, text)


def _confirm(what: str, talk: UserInterface, confirmed: bool) -> None:
    """Ask the user to confirm, if necessary.

    :raises UsageError: if the user cannot be asked
    :raises RefusedError: if the user does not confirm
    """
    if confirmed:
        return
    if talk.ask is None:
        raise UsageError(f"confirmation needed: {what}", remedy="Confirm with --yes.")
    if not talk.ask.yes(f"{what[:1].upper()}{what[1:]} from the robot. Continue?"):
        raise RefusedError("nothing was removed")


def show_console(
    project: Project | None,
    choice: RobotChoice,
    talk: UserInterface,
    without_driver_station: bool,
    address: Address | None = None,
) -> None:
    """Show the robot program's output until Ctrl-C.

    :param without_driver_station: imitate a Driver Station, if the robot needs one for this
    :param address: the robot's address, if it was found already
    :raises NoConsoleError: if the robot does not send it
    """
    target, progress = choose_target(project, choice, talk.ask), talk.progress
    if not target.controller.layout.output:
        address = address or console_address(target, choice, progress)
        follow_console(address, without_driver_station, progress.quiet)
        return
    found = find(target if address is None else replace(target, robot=str(address)), choice, progress)
    with connected(target, found, choice, progress) as connection:
        is_virtual = connection.is_virtual_robot
    if is_virtual:
        follow_console(found.address, quiet=progress.quiet)
    else:
        follow_output(lambda: reconnected(target, found.address, choice), progress.quiet)


def _upload(robot: AgentClient, program: CheckedProgram, options: DeployOptions, talk: UserInterface) -> Deployed:
    from .facts import DeployRequest

    request = DeployRequest(
        main=program.main,
        deploy_json=program.deploy_json,
        debug=options.debug,
        program=program.imports.program(),
        restart=True,
        environment=robot.facts.environment,
        reinstall=options.reinstall,
    )
    with talk.progress.phase("upload") as phase:
        deployed = robot.deploy(program.manifest, request, phase.work)
        if deployed.unchanged:
            phase.detail = "nothing has changed"
        else:
            phase.detail = f"{counted(deployed.files_sent, 'file')}, {size_text(deployed.bytes_sent)}"
        phase.detail += f"; release {deployed.release}"
    if deployed.taken is not None:
        talk.progress.note(f"  the program of another tool is kept as release {deployed.taken}")
    if deployed.renamed:
        kept = ", ".join(map(ascii, deployed.renamed))
        talk.progress.note(f"  the project has taken names of what the program had written, which is kept as {kept}")
    if deployed.skipped:
        talk.progress.note(f"  not carried over (pipes, sockets, devices): {', '.join(map(ascii, deployed.skipped))}")
    return deployed


def _plan_as_text(plan: Plan) -> str:
    lines = [
        f"{sign} {ascii_path(path)}"
        for sign, paths in (("+", plan.added), ("~", plan.changed), ("-", plan.removed))
        for path in paths
    ]
    counts = f"{len(plan.added)} to add, {len(plan.changed)} to change, {len(plan.removed)} to remove"
    return "\n".join([*lines, f"{counts}; {size_text(plan.bytes_to_send)} to send. Nothing was changed on the robot."])


_ENDED = "ended after its last start"


def show_info(project: Project | None, choice: RobotChoice, talk: UserInterface) -> None:
    """Show the robot's program, who deployed it, and the kept releases."""
    with connected_agent(choose_target(project, choice, talk.ask), choice, talk.progress) as (connection, robot):
        name, key = connection.recognized.name, connection.key.fingerprint
        info = {"host": connection.host, "robot_name": name or None, "host_key": key, **asdict(robot.facts)}
        talk.progress.result(info, info_text(robot.facts, name), requested=True)


def info_text(facts: RobotFacts, name: str) -> str:
    """Return the information as text.

    :param name: the robot's name; empty if it has none
    """
    lines = [
        *([f"name       {name}"] if name else []),
        f"robot      {facts.image or 'unknown image'}, Python {facts.python}, wpilib {facts.wpilib or 'missing'}",
        f"disk       {facts.free_bytes / 1e6:.1f} MB free",
    ]
    if facts.current is None and not facts.other_code:
        lines.append("program    none")
    else:
        by_whom = "deployed by another tool" if facts.current is None else f"release {facts.current}"
        lines.append(f"program    {by_whom}, {_program_state(facts)}")
        lines += [f"  {key:<12} {value}" for key, value in _deployed(facts.deploy_json)]
    lines += [_release_line(release, facts.current) for release in reversed(facts.releases)]
    return "\n".join(lines)


def _program_state(facts: RobotFacts) -> str:
    """Return the program's state. Robots restart a crashing program forever, so a process alone proves little."""
    age = "" if facts.program_age is None else f"{facts.program_age:.{0 if facts.program_age >= 10 else 1}f} s"
    if any(each.number == facts.current and each.ended for each in facts.releases):
        now = f"started again {age} ago" if age else "started again"
        return f"{_ENDED}; {now if facts.running else 'not running'}"
    if not facts.running:
        return "not running"
    return f"running for {age}" if age else "running"


def _release_line(release: Release, current: int | None) -> str:
    deployed = dict(_deployed(release.deploy_json))
    parts = [deployed.get("date", "date unknown"), deployed.get("by"), deployed.get("commit")]
    parts += ["left by another tool"] if release.taken else []
    if release.ran or release.ended:
        parts.append(_ENDED if release.ended else "seen to run")
    parts += ["its record is damaged"] if release.damaged else []
    mark = "*" if release.number == current else " "
    return f"{mark} release {release.number:<4}" + ", ".join(part for part in parts if part)


def _deployed(record: Mapping[str, str]) -> list[tuple[str, str]]:
    """Return the rows to show for a ``deploy.json``."""
    rows = []
    if "deploy-user" in record:
        rows.append(("by", f"{record['deploy-user']} on {record.get('deploy-host', 'an unknown computer')}"))
    if "deploy-date" in record:
        rows.append(("date", record["deploy-date"]))
    if "code-path" in record:
        rows.append(("from", record["code-path"]))
    if "git-desc" in record:
        description = record["git-desc"]
        dirty = ", with uncommitted changes" if description.endswith("-dirty") else ""
        branch = f" on {record['git-branch']}" if "git-branch" in record else ""
        rows.append(("commit", f"{description.removesuffix('-dirty')}{branch}{dirty}"))
    return rows
