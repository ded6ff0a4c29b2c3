"""GNU make does the work on this machine: a target of batch.mk is a slice of the cells, one cell
where there are few."""
import os
import shlex
import subprocess
import sys
import time

from . import plan as planning

PROGRESS = "progress"  # OUT/work/progress grows by one byte for each cell that is made


def write_make_file(plan, missing, script):
    """batch.mk: a target for each slice of bodies and of cells; `todo` are those in which something
    is missing.

    missing: [first, last) ranges of cell numbers, ascending."""
    one = f"@{shlex.quote(sys.executable)} {shlex.quote(script)} --slice {shlex.quote(plan.out)}"
    slices = plan.slices()
    names, todo, i = [], [], 0
    path = os.path.join(plan.out, "batch.mk")
    temporary = f"{path}.{os.getpid()}.tmp"
    with open(temporary, "w") as file:
        file.write(
            "# Made by retarget-batch: make -k -j N -C THIS-FOLDER -f batch.mk\n# "
            "bodies-FIRST-LAST and cells-FIRST-LAST make what is missing of "
            "these.\n.SUFFIXES:\n.PHONY: all todo\nall:\n"
        )
        for first, last in slices["bodies"]:
            file.write(f"bodies-{first}-{last}:\n\t{one} bodies {first}-{last}\n")
        for first, last, body in slices["cells"]:
            name = f"cells-{first}-{last}"
            names.append(name)
            while i < len(missing) and missing[i][1] <= first:
                i += 1
            if i < len(missing) and missing[i][0] < last:
                todo.append(name)
            file.write(
                f"{name}: | "
                f"bodies-{slices['bodies'][body][0]}-{slices['bodies'][body][1]}\n\t{one} cells "
                f"{first}-{last}\n"
            )
        file.write(f"all: {' '.join(names)}\ntodo: {' '.join(todo)}\n")
    os.replace(temporary, path)


class Progress:
    """One line on a terminal, with the time that is left; nothing elsewhere."""

    def __init__(self, plan, missing, quiet):
        """missing: count of the cells that are to be made."""
        self.path = os.path.join(plan.out, "work", PROGRESS)
        self.total, self.at_start = plan.cell_count, plan.cell_count - missing
        self.shown = sys.stderr.isatty() and not quiet
        self.begun = time.monotonic()
        os.makedirs(os.path.dirname(self.path), exist_ok=True)
        with open(self.path, "w"):
            pass

    def made(self):
        try:
            return os.path.getsize(self.path)
        except OSError:
            return 0

    def is_done(self):
        return self.at_start + self.made() >= self.total

    def show(self):
        if not self.shown:
            return
        made = self.made()
        left = ""
        if made:
            seconds = (time.monotonic() - self.begun) / made * (self.total - self.at_start - made)
            left = f", {int(seconds) // 60}:{int(seconds) % 60:02d} left"
        sys.stderr.write(
            f"\rretarget-batch: {self.at_start + made} of {self.total} cells{left}\033[K"
        )
        sys.stderr.flush()

    def end(self):
        if self.shown:
            sys.stderr.write("\r\033[K")
        if os.path.exists(self.path):
            os.remove(self.path)


def run_make(plan, options, progress):
    command = [
        "make",
        "-k",
        "-s",
        f"-j{options.jobs}",
        "--no-print-directory",
        "-C",
        plan.out,
        "-f",
        "batch.mk",
        "todo",
    ]
    environment = {
        k: v for k, v in os.environ.items() if k not in ("MAKEFLAGS", "MFLAGS", "MAKELEVEL")
    }
    with open(os.path.join(plan.out, "batch.log"), "a") as log:
        process = subprocess.Popen(
            command, stdin=subprocess.DEVNULL, stdout=log, stderr=log, env=environment
        )
        try:
            while process.poll() is None:
                progress.show()
                time.sleep(0.1)
        except KeyboardInterrupt:
            process.terminate()
            process.wait()
            raise
    progress.end()
