#!/usr/bin/env python3
"""Types commands and the Tab key into a shell, and checks what the shell makes of them.

    type_in_shell.py PROGRAM SHELL...

PROGRAM: the program spawnfield. SHELL: bash, zsh or fish. Each shell runs in a terminal, as for a person, and loads the
script that `spawnfield completion SHELL` prints.
"""

import os
import pty
import select
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

# What is typed after `spawnfield`, before the Tab key, and what the line must be after it.
EXPECTED = {
    "bak": "bake",
    "--vers": "--version",
    "completion z": "completion zsh",
    "bake --occ": "bake --occupancy-resolution",
    "bake --unknown bl": "bake --unknown blocked",
    "bake --unknown=bl": "bake --unknown=blocked",
    "bake --threads 2 --label a=b --up y wor": "bake --threads 2 --label a=b --up y world_file.sdf",
    "bake world_file.sdf --quiet -o resu": "bake world_file.sdf --quiet -o result_file.csv",
    "check map_": "check map_folder/",
    "check map_folder --robot box:1,2,3 --format jun": "check map_folder --robot box:1,2,3 --format junit",
    "check map_folder --robot=box:1,2,3 --format=jun": "check map_folder --robot=box:1,2,3 --format=junit",
    "export map_folder --format ros2-launch-p": "export map_folder --format ros2-launch-py",
    "info world_file.sdf --drive leg": "info world_file.sdf --drive legged",
    "sample map_folder --near a 0:1 --stance sett": "sample map_folder --near a 0:1 --stance settled",
    "clean map_": "clean map_folder/",
    "bake --confine map_": "bake --confine map_folder/",
}
FILES = ["world_file.sdf", "result_file.csv", "map_file.txt", "map_folder/inside.txt"]

COMMANDS = {
    "bash": ["bash", "--norc", "--noprofile", "-i"],
    "zsh": ["zsh", "-f", "-i"],
    "fish": ["fish", "--no-config", "-i"],
}
SET_UP = {
    "bash": "bind 'set enable-bracketed-paste off'; eval \"$(spawnfield completion bash)\"",
    "zsh": "mkdir .z && spawnfield completion zsh >.z/_spawnfield; fpath=($PWD/.z $fpath); autoload -U compinit;"
    " compinit -u -D",
}


def lines():
    return [(f"spawnfield {typed}", f"spawnfield {expected}") for typed, expected in EXPECTED.items()]


def fail(shell, text):
    sys.exit(f"type_in_shell.py: {shell}: {text}")


class Terminal:
    """A shell in a terminal of its own, in the folder."""

    def __init__(self, shell, folder, environment):
        self.shell, self.folder, self.output = shell, folder, ""
        self.child, self.file = pty.fork()
        if self.child == 0:
            os.chdir(folder)
            os.execvpe(shell, COMMANDS[shell], environment)

    def type(self, text):
        os.write(self.file, text.encode())

    def result(self, seconds=20):
        """Returns what the program `show` wrote, as soon as it has written it."""
        end, file = time.monotonic() + seconds, Path(self.folder, ".shown")
        while not file.exists():
            if time.monotonic() > end:
                fail(self.shell, f"after {seconds} s the terminal shows {self.output!r}")
            if select.select([self.file], [], [], 0.01)[0]:
                self.output += os.read(self.file, 65536).decode(errors="replace")
        text = file.read_text()
        file.unlink()
        return text.removesuffix("\n")

    def close(self):
        os.kill(self.child, signal.SIGKILL)
        os.waitpid(self.child, 0)
        os.close(self.file)


def check_typing(shell, folder, environment):
    """Types each line with Tab and @. Then puts `show` before the line and lets the shell run it."""
    terminal = Terminal(shell, folder, environment)
    terminal.type(SET_UP[shell] + "; show ready\n")
    terminal.result()
    for typed, expected in lines():
        terminal.type(typed + "\t@\x01show \x05\n")  # Ctrl-A and Ctrl-E: to the start and the end of the line
        shown = terminal.result()
        # zsh adds = to the name of an option that has a value.
        if not shown.endswith("@") or shown.removesuffix("@").rstrip(" =") != expected:
            fail(shell, f"{typed}<Tab>@ becomes {shown!r}, needs {expected!r}")
    terminal.close()


def check_fish(folder, environment):
    """Asks fish for its completions of each line."""
    script = subprocess.run(["spawnfield", "completion", "fish"], check=True, capture_output=True, text=True,
                            env=environment).stdout
    for typed, expected in lines():
        word = typed.split(" ")[-1]
        wanted = expected[len(typed) - len(word):]
        run = subprocess.run(["fish", "--no-config", "-c", script + "\ncomplete -C " + repr(typed)], cwd=folder,
                             env=environment, capture_output=True, text=True)
        found = [line.split("\t")[0] for line in run.stdout.splitlines()]
        if found != [wanted] or run.stderr:
            fail("fish", f"{typed}<Tab> gives {found}, needs {[wanted]}; {run.stderr}")


def main():
    program, shells = Path(sys.argv[1]).resolve(), sys.argv[2:]
    with tempfile.TemporaryDirectory() as folder:
        for name in FILES:
            Path(folder, name).parent.mkdir(exist_ok=True)
            Path(folder, name).write_text("")
        tools = Path(folder, ".tools")
        tools.mkdir()
        (tools / "show").write_text("#!/bin/sh\necho \"$*\" >\"$0.new\" && mv \"$0.new\" \"${0%/*/*}/.shown\"\n")
        (tools / "show").chmod(0o755)
        environment = {"PATH": f"{program.parent}:{tools}:/usr/bin:/bin", "HOME": folder, "TERM": "dumb",
                       "LC_ALL": "C.UTF-8"}
        for shell in shells:
            if shell == "fish":
                check_fish(folder, environment)
            else:
                check_typing(shell, folder, environment)
            print(f"{shell}: {len(EXPECTED)} lines are completed as expected")


main()
