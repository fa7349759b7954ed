"""The commands for the program on a robot: deploy, rollback, undeploy, console."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass, field
from typing import TYPE_CHECKING

from ..config.robotpy import load_robot_packages
from ..errors import UsageError
from ..project import Project
from ..wording import counted
from .connection import Connection, load_in_background
from .console import follow_console
from .discovery import Address
from .errors import RefusedError
from .local_checks import (
    ImportCheck,
    ask_to_continue,
    passed_already,
    refuse_other_main_files,
    refuse_untested,
    run_tests,
)
from .progress import DeployProgress, UserInterface
from .robot_setup import other_languages_notice
from .target_connection import (
    RobotChoice,
    choose_target,
    connected,
    connected_agent,
    console_address,
    find,
)

if TYPE_CHECKING:
    from .agent_client import AgentClient
    from .facts import Deployed, Plan, RobotFacts
    from .manifest import Manifest


@dataclass(frozen=True)
class DeployOptions:
    """The options of a deploy.

    :param choice: the robot to deploy to
    :param builtin: run the ready-made tests if the project has none
    :param skip_tests: run no tests
    :param large: also upload files over 250,000 bytes
    :param check_versions: refuse robots with another wpilib, without required packages, or with an old image
    :param nonstandard: allow a main file with another name than robot.py
    :param debug: start the program with debugging enabled
    :param in_place: overwrite the running program's files, delete nothing, do not restart
    :param dry_run: only show what would be done
    :param auto_rollback: roll back if the new program ends during the watch
    """

    choice: RobotChoice = field(default_factory=RobotChoice)
    builtin: bool = False
    skip_tests: bool = False
    large: bool = False
    check_versions: bool = True
    nonstandard: bool = False
    debug: bool = False
    in_place: bool = False
    dry_run: bool = False
    auto_rollback: bool = False


def deploy(project: Project, options: DeployOptions, talk: UserInterface) -> Address:
    """Deploy the project's program, start it, and return the robot's address.

    :raises DeployError: if the deploy fails; the robot still has a complete program
    :raises ProgramDiedError: if the program was deployed and ended during the watch
    """
    load_in_background()
    progress = talk.progress
    refuse_other_main_files(project, options.nonstandard)
    _ask_about_private_files(project, options, talk)
    target = choose_target(project, options.choice, talk.ask)
    checked = _Checked() if options.dry_run else _check_program(project, options, talk)
    from .manifest import build_manifest
    from .robot_checks import BackgroundTask, refuse_unfit_robot
    from .robot_packages import ImportSearch, check_packages
    from .starting import start

    with progress.phase("files") as phase:
        manifest = build_manifest(project.root, project.settings.deploy.exclude, options.large)
        phase.detail = f"{counted(len(manifest.entries), 'file')}, {_size(manifest.total_bytes)}"
    if checked.tested is not None:
        refuse_untested(checked.tested, manifest, progress)
    packages = load_robot_packages(project.pyproject)
    imports = ImportSearch(manifest, project.root, project.main_file.name)
    with connected_agent(project, target, options.choice, progress, imports.modules) as (connection, robot):
        if robot.facts.other_languages:
            progress.note("  {}. {}".format(*other_languages_notice(robot.facts.other_languages)))
        _note_unfit_releases(robot.facts, progress)
        refuse_unfit_robot(robot.facts, connection.controller, str(connection.address), options.check_versions)
        check_packages(imports, packages, robot.facts, talk, dry_run=options.dry_run, refuse=options.check_versions)
        if checked.importing is not None:
            _refuse_unimportable(checked.importing, talk)
        if options.dry_run:
            with progress.phase("compare") as phase:
                plan = robot.plan(manifest, phase.work)
            progress.result({"host": connection.host, "plan": asdict(plan)}, _plan_as_text(plan), requested=True)
            return connection.address
        memory = BackgroundTask(connection.controller.save_memory if robot.facts.wastes_memory else None, connection)
        deployed = _upload(robot, project, manifest, options, talk, imports.program())
        verdict = None
        try:
            if not options.in_place:
                verdict = start(robot, talk, deployed.fallback, options.auto_rollback)
        finally:
            _repair_stop(robot, connection, progress)
            memory.report(progress)  # last, since a failing login as administrator may take half a minute
        _report_deployed(deployed, verdict, connection, options, talk)
    return connection.address


def rollback(project: Project | None, choice: RobotChoice, release: int | None, talk: UserInterface) -> Address:
    """Make an earlier release current, start it, and return the robot's address.

    :param release: its number; default: the release that the robot selects
    """
    from .starting import go_back

    with connected_agent(project, choose_target(project, choice, talk.ask), choice, talk.progress) as (
        connection,
        robot,
    ):
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
        from .robot_checks import BackgroundTask

        BackgroundTask(connection.controller.repair_stop(), connection).report(progress)


def undeploy_other_languages(
    project: Project | None, choice: RobotChoice, talk: UserInterface, confirmed: bool
) -> None:
    """Remove programs in Java and C++ from the robot. A program in Python stays.

    :param confirmed: whether the user has already confirmed this
    """
    from .other_languages import remove_other_languages

    target = choose_target(project, choice, talk.ask)
    _confirm(f"{target.controller.leftovers} will be removed", talk, confirmed)
    found = find(target, choice, talk.progress)
    with connected(project, target, found, choice, talk.progress) as connection:
        with talk.progress.phase("remove"):
            removed = remove_other_languages(connection)
        text = (
            "\n".join(["Removed:", *(f"  {each}" for each in removed)]) if removed else "There was nothing to remove."
        )
        talk.progress.result({"host": connection.host, "removed": removed}, text)


def undeploy(project: Project | None, choice: RobotChoice, talk: UserInterface, confirmed: bool) -> None:
    """Remove the program from the robot, with all releases.

    :param confirmed: whether the user has already confirmed this
    """
    target = choose_target(project, choice, talk.ask)
    _confirm("the robot program and all of its releases will be removed", talk, confirmed)
    with connected_agent(project, target, choice, talk.progress) as (connection, robot):
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
    project: Project | None, choice: RobotChoice, talk: UserInterface, without_driver_station: bool
) -> None:
    """Show the robot program's output until Ctrl-C."""
    address = console_address(choose_target(project, choice, talk.ask), choice, talk.progress)
    follow_console(address, without_driver_station, talk.progress.quiet)


def _upload(
    robot: AgentClient,
    project: Project,
    manifest: Manifest,
    options: DeployOptions,
    talk: UserInterface,
    program: Sequence[str],
) -> Deployed:
    from .deploy_json import deploy_json
    from .facts import DeployRequest

    request = DeployRequest(
        main=project.main_file.name,
        deploy_json=deploy_json(project.root),
        debug=options.debug,
        in_place=options.in_place,
        program=program,
        restart=not options.in_place,
    )
    with talk.progress.phase("upload") as phase:
        deployed = robot.deploy(manifest, request, phase.work)
        if deployed.unchanged:
            phase.detail = "nothing has changed"
        else:
            phase.detail = f"{counted(deployed.files_sent, 'file')}, {_size(deployed.bytes_sent)}"
        if deployed.release is not None:
            phase.detail += f"; release {deployed.release}"
    if deployed.taken is not None:
        talk.progress.note(f"  the program of another tool is kept as release {deployed.taken}")
    if deployed.renamed:
        kept = ", ".join(map(ascii, deployed.renamed))
        talk.progress.note(f"  the project has taken names of what the program had written, which is kept as {kept}")
    if deployed.skipped:
        talk.progress.note(f"  not carried over (pipes, sockets, devices): {', '.join(map(ascii, deployed.skipped))}")
    return deployed


def _report_deployed(
    deployed: Deployed, verdict: str | None, connection: Connection, options: DeployOptions, talk: UserInterface
) -> None:
    result = {"host": connection.host, **asdict(deployed), "in_place": options.in_place, "program": verdict}
    text = "Its files were overwritten; the program was not restarted." if options.in_place else "Deployed."
    talk.progress.result(result, text)


@dataclass(frozen=True)
class _Checked:
    """What was checked before the connection.

    :param importing: the check that the program can be imported; None if the tests run
    :param tested: the files that a deploy would have sent when the tests began, if these passed now
    """

    importing: ImportCheck | None = None
    tested: Manifest | None = None


def _check_program(project: Project, options: DeployOptions, talk: UserInterface) -> _Checked:
    """Run the tests. Without tests, import the program in the background."""
    if options.skip_tests or (project.find_tests() is None and not options.builtin):
        if not options.skip_tests:
            talk.progress.note("this project has no tests; the ready-made ones run with --builtin")
        return _Checked(importing=ImportCheck(project))
    if (since := passed_already(project, options.builtin)) is not None:
        with talk.progress.phase("tests") as phase:
            phase.detail = f"passed at {since}; nothing has changed since"
        return _Checked()
    from .manifest import build_manifest

    before = build_manifest(project.root, project.settings.deploy.exclude, options.large)
    with talk.progress.phase("tests", own_output=True) as phase:
        passed = run_tests(project, options.builtin, talk.progress.child_output, talk.progress.quiet)
        phase.detail = "passed" if passed else "failed"
    if not project.main_file.is_file():
        raise RefusedError("not deployed: it was removed while the tests ran", where=project.main_file)
    if not passed:
        ask_to_continue("the tests failed", talk.ask, "Correct the failures, or deploy without tests: --skip-tests")
    return _Checked(tested=before if passed else None)


def _ask_about_private_files(project: Project, options: DeployOptions, talk: UserInterface) -> None:
    from .manifest import ascii_path, listed, private_files

    settings = project.settings.deploy
    private = private_files(project.root, settings.exclude, settings.private)
    if not private:
        return
    named = listed([f"{ascii_path(path)} ({private[path]})" for path in sorted(private)])
    what = f"files would be uploaded that seem to be private: {named}"
    if options.dry_run:
        talk.progress.warning(what)
        return
    remedy = "Under [tool.pyfrc.deploy] in pyproject.toml, leave them out with exclude = [...], or upload them with "
    ask_to_continue(what, talk.ask, f"{remedy}private = [...].")


def _refuse_unimportable(importing: ImportCheck, talk: UserInterface) -> None:
    error = importing.result()
    if error is not None:
        failure = f"the robot program cannot be imported: {error}"
        ask_to_continue(failure, talk.ask, "On the robot, it would end immediately.", error)


def _plan_as_text(plan: Plan) -> str:
    from .manifest import ascii_path

    lines = [
        f"{sign} {ascii_path(path)}"
        for sign, paths in (("+", plan.added), ("~", plan.changed), ("-", plan.removed))
        for path in paths
    ]
    counts = f"{len(plan.added)} to add, {len(plan.changed)} to change, {len(plan.removed)} to remove"
    return "\n".join([*lines, f"{counts}; {_size(plan.bytes_to_send)} to send. Nothing was changed."])


def _size(count: int) -> str:
    if count < 10_000:
        return f"{count} bytes"
    return f"{count / 1000:.0f} kB" if count < 10_000_000 else f"{count / 1e6:.1f} MB"
