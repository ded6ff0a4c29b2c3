"""Who does the work: GNU make on this machine, or Slurm job arrays each of whose tasks runs a slice of the same make file."""
import os
import shlex
import subprocess
import sys
import time

from . import plan as planning

ROUNDS = 3  # of submission: a task that was killed comes back by itself; what is missing after that is submitted again


def write_make_file(out, plan, script):
    """batch.mk: a rule for each body and each cell; a target is the status that stands in a folder renamed into place."""
    one = f"@{shlex.quote(sys.executable)} {shlex.quote(script)} --one {shlex.quote(out)}"
    cache = os.path.relpath(plan["cache"], out)
    text = "# Made by retarget-batch: make -k -j N -C THIS-FOLDER -f batch.mk\n.DELETE_ON_ERROR:\n.SUFFIXES:\n"
    text += "all: " + " ".join(f"cells/{key}/status.json" for key in plan["cells"]) + "\n"
    for key in plan["bodies"]:
        text += f"{cache}/{key}/status.json:\n\t{one} body {key}\n"
    for key, cell in plan["cells"].items():
        text += f"cells/{key}/status.json: | {cache}/{cell['body']}/status.json\n\t{one} cell {key}\n"
    temporary = os.path.join(out, f"batch.mk.{os.getpid()}.tmp")
    with open(temporary, "w") as file:
        file.write(text)
    os.replace(temporary, os.path.join(out, "batch.mk"))


def missing_cells(out, plan):
    return [key for key in plan["cells"] if not os.path.exists(os.path.join(out, "cells", key, "status.json"))]


class Progress:
    """One line on a terminal, with the time that is left; nothing elsewhere."""

    def __init__(self, out, plan, quiet):
        self.out, self.plan = out, plan
        self.shown = sys.stderr.isatty() and not quiet
        self.begun = time.monotonic()
        self.at_start = len(plan["cells"]) - len(missing_cells(out, plan))

    def show(self):
        if not self.shown:
            return
        total, done = len(self.plan["cells"]), len(self.plan["cells"]) - len(missing_cells(self.out, self.plan))
        left = ""
        if done > self.at_start:
            seconds = (time.monotonic() - self.begun) / (done - self.at_start) * (total - done)
            left = f", {int(seconds) // 60}:{int(seconds) % 60:02d} left"
        sys.stderr.write(f"\rretarget-batch: {done} of {total} cells{left}\033[K")
        sys.stderr.flush()

    def end(self):
        if self.shown:
            sys.stderr.write("\r\033[K")


def run_make(out, plan, options, progress):
    command = ["make", "-k", "-s", f"-j{options.jobs}", "--no-print-directory", "-C", out, "-f", "batch.mk", "all"]
    environment = {k: v for k, v in os.environ.items() if k not in ("MAKEFLAGS", "MFLAGS", "MAKELEVEL")}
    with open(os.path.join(out, "batch.log"), "a") as log:
        process = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=log, stderr=log, env=environment)
        try:
            while process.poll() is None:
                progress.show()
                time.sleep(0.3)
        except KeyboardInterrupt:
            process.terminate()
            process.wait()
            raise
    progress.end()


def slices(keys, size):
    return [keys[i:i + size] for i in range(0, len(keys), size)]


def submit(out, keys, chunk, script, name, slurm_options):
    """One job array over slices of the missing cells, and a summary after it however it ended; the array's id."""
    folder = os.path.join(out, "slurm")
    os.makedirs(folder, exist_ok=True)
    for old in os.listdir(folder):
        if old.startswith(f"{name}."):
            os.remove(os.path.join(folder, old))
    parts = slices(keys, chunk)
    for i, part in enumerate(parts):
        with open(os.path.join(folder, f"{name}.{i}"), "w") as file:
            file.write(" ".join(f"cells/{key}/status.json" for key in part) + "\n")
    array = os.path.join(folder, f"{name}.sh")
    with open(array, "w") as file:
        file.write(f"#!/bin/bash\nunset MAKEFLAGS MFLAGS MAKELEVEL\nread -r -a targets < {shlex.quote(folder)}/{name}.\"$SLURM_ARRAY_TASK_ID\"\n"
                   f"exec make -k -s -j\"${{SLURM_CPUS_PER_TASK:-1}}\" --no-print-directory -C {shlex.quote(out)} -f batch.mk \"${{targets[@]}}\"\n")
    common = ["--parsable", f"--chdir={out}", *slurm_options]
    job = subprocess.run(["sbatch", *common, f"--job-name=sloper-{name}", f"--array=0-{len(parts) - 1}", "--requeue", "--open-mode=append", f"--output={folder}/{name}.%a.log", array],
                         check=True, capture_output=True, text=True).stdout.strip().split(";")[0]
    summary = f"{shlex.quote(sys.executable)} {shlex.quote(script)} --summary {shlex.quote(out)}"
    # afterany, not afterok: one bad scan must not take the summary away.
    last = subprocess.run(["sbatch", *common, f"--job-name=sloper-{name}-summary", f"--dependency=afterany:{job}", f"--output={folder}/{name}.summary.log", "--wrap", summary],
                          check=True, capture_output=True, text=True).stdout.strip().split(";")[0]
    return job, last


def still_there(jobs):
    done = subprocess.run(["squeue", "-h", "-o", "%i %T", "-j", ",".join(jobs)], capture_output=True, text=True)
    if done.returncode != 0:  # "Invalid job id" once all are forgotten; anything else may pass
        return "Invalid job id" not in done.stderr
    return bool(done.stdout.strip())


def run_slurm(out, plan, options, progress, script):
    for number in range(ROUNDS):
        keys = missing_cells(out, plan)
        if not keys:
            break
        try:
            jobs = submit(out, keys, options.chunk, script, f"round{number}", options.slurm_option)
        except (OSError, subprocess.CalledProcessError) as error:
            raise planning.Mistake(f"sbatch: {(getattr(error, 'stderr', None) or str(error)).strip()}", 4) from None
        if options.no_wait:
            print(" ".join(jobs))
            return
        while still_there(jobs):
            progress.show()
            time.sleep(options.poll_s)
            if not missing_cells(out, plan):
                break
    progress.end()
