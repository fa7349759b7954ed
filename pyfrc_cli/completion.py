"""The command `pyfrc completion`, and the completions that its scripts request when the user presses Tab."""

from __future__ import annotations

import os
from typing import Any

import click
from click.shell_completion import CompletionItem, ShellComplete, add_completion_class, get_completion_class

from . import COMPLETE_VARIABLE

_POWERSHELL = """\
Register-ArgumentCompleter -Native -CommandName %(prog_name)s -ScriptBlock {
    param($wordToComplete, $commandAst, $cursorPosition)
    $words = $commandAst.CommandElements | Where-Object { $_.Extent.EndOffset -le $cursorPosition }
    $env:COMP_WORDS = ($words | ForEach-Object { $_.ToString() }) -join "`n"
    $env:COMP_CWORD = $wordToComplete
    $env:%(complete_var)s = "powershell_complete"
    try {
        & %(prog_name)s | Where-Object { $_ } | ForEach-Object {
            $value, $help = $_ -split "`t", 2
            [System.Management.Automation.CompletionResult]::new($value, $value, "ParameterValue", $help)
        }
    } finally {
        Remove-Item Env:COMP_WORDS, Env:COMP_CWORD, Env:%(complete_var)s
    }
}
"""


class PowerShellComplete(ShellComplete):
    """Completion in PowerShell, which click does not support."""

    name = "powershell"
    source_template = _POWERSHELL

    def get_completion_args(self) -> tuple[list[str], str]:
        words, incomplete = os.environ["COMP_WORDS"].split("\n")[1:], os.environ["COMP_CWORD"]
        if incomplete and words[-1:] == [incomplete]:
            words.pop()
        return words, incomplete

    def format_completion(self, item: CompletionItem) -> str:
        # PowerShell also shows the help, which must not be empty.
        return f"{item.value}\t{item.help or item.value}"

    def complete(self) -> str:
        """Return one completion per line; none for files, which PowerShell completes itself."""
        found = self.get_completions(*self.get_completion_args())
        return "\n".join(self.format_completion(item) for item in found if item.type == "plain")


#: The shells, and the line that loads the script at each start.
SHELLS = {
    "bash": 'eval "$(pyfrc completion bash)"   in ~/.bashrc',
    "zsh": 'eval "$(pyfrc completion zsh)"   in ~/.zshrc, after compinit',
    "fish": "pyfrc completion fish | source   in ~/.config/fish/config.fish",
    "powershell": "pyfrc completion powershell | Out-String | Invoke-Expression   in your $PROFILE",
}

_HELP = f"""Print a script for SHELL that completes pyfrc's commands and options when you press Tab.

To load it whenever the shell starts, add its line:

\b
{chr(10).join(SHELLS.values())}

\b
Exit codes: 0 printed, 2 wrong usage."""


@click.command("completion", help=_HELP)
@click.argument("shell", type=click.Choice(list(SHELLS)))
@click.pass_context
def command(context: click.Context, shell: str) -> None:
    complete: Any = get_completion_class(shell)
    click.echo(complete(context.find_root().command, {}, "pyfrc", COMPLETE_VARIABLE).source())


add_completion_class(PowerShellComplete)
