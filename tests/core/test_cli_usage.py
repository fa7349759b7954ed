"""Options that exclude each other: refused before anything is imported or done."""

from __future__ import annotations

import pytest
from click.testing import CliRunner
from loops import for_each

from pyfrc_cli.deploy import command

_ROLLBACK = "--rollback excludes --dry-run and --auto-rollback: it deploys nothing."
_REINSTALL = "--reinstall excludes --dry-run and --rollback."


@for_each(
    "options, sentence",
    [
        ("--netconsole --json", "--netconsole and --json are mutually exclusive."),
        ("--netconsole-ds --json", "--netconsole and --json are mutually exclusive."),
        ("--netconsole --dry-run", "--netconsole and --dry-run are mutually exclusive."),
        ("--netconsole-ds --dry-run", "--netconsole and --dry-run are mutually exclusive."),
        ("--rollback=1 --dry-run", _ROLLBACK),
        ("--rollback=1 --auto-rollback", _ROLLBACK),
        ("--reinstall --dry-run", _REINSTALL),
        ("--reinstall --rollback", _REINSTALL),
        ("--rollback=last", "--rollback 'last': a release is a number; pyfrc deploy-info lists them."),
    ],
)
def test_options_of_a_deploy_that_exclude_each_other(
    options: str, sentence: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    from pyfrc_core.deploy import session

    for name in ("deploy", "rollback"):
        monkeypatch.setattr(session, name, lambda *args: pytest.fail("something was done"))
    result = CliRunner().invoke(command, options.split())
    assert result.exit_code == 2
    assert sentence in " ".join(result.stderr.split())
