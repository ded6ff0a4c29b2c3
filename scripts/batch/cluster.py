"""Slurm: job arrays, each task of which makes a slice of the missing cells. Chunks and arrays
follow the limits of the cluster."""
import os
import re
import shlex
import subprocess
import sys
import time

from . import plan as planning

ROUNDS = 3  # of submission: a task that was killed comes back by itself; what is missing after that is submitted again
# Slurm's own defaults, where scontrol does not say.
MAX_ARRAY_SIZE = 1001
MAX_JOB_COUNT = 10_000
SHARE_OF_JOBS = 0.5  # of MaxJobCount that one batch takes: each task of an array counts as a job once it is pending by itself
POOLED = 8  # ranges for each processor of a task: a slow cell does not keep the others waiting


def limits():
    """{"array": most tasks of an array, "jobs": most tasks of a batch} as `scontrol show config`
    tells them."""
    try:
        text = subprocess.run(
            ["scontrol", "show", "config"], capture_output=True, text=True, check=True
        ).stdout
    except (OSError, subprocess.CalledProcessError):
        text = ""

    def number(name, default):
        found = re.search(rf"\b{name}\s*=\s*(\d+)", text, re.IGNORECASE)
        return int(found.group(1)) if found else default

    array = number("MaxArraySize", MAX_ARRAY_SIZE)
    if array == 0:
        raise planning.Mistake(
            "the cluster's MaxArraySize is 0: it takes no job arrays; use --engine make inside "
            "one job",
            4,
        )
    array = min(array, number("max_array_tasks", array))
    return {
        "array": array,
        "jobs": max(1, int(number("MaxJobCount", MAX_JOB_COUNT) * SHARE_OF_JOBS)),
    }


def tasks_of(missing, chunk, processors):
    """One line a task: the ranges of its cells, as FIRST-LAST with the last excluded. A task of
    several processors gets shorter ranges.

    missing: [first, last) ranges of cell numbers."""
    most = max(1, chunk // (POOLED * processors)) if processors > 1 else chunk
    task, count = [], 0
    for first, last in missing:
        while first < last:
            end = min(last, first + chunk - count)
            task += [f"{i}-{min(i + most, end)}" for i in range(first, end, most)]
            count += end - first
            first = end
            if count == chunk:
                yield " ".join(task) + "\n"
                task, count = [], 0
    if task:
        yield " ".join(task) + "\n"


def sbatch(arguments):
    return (
        subprocess.run(["sbatch", *arguments], check=True, capture_output=True, text=True)
        .stdout.strip()
        .split(";")[0]
    )


def processors_of(slurm_options):
    """CPUs of a task as the user asks for them."""
    found = re.search(r"(?:^|\s)(?:--cpus-per-task[= ]|-c\s*)(\d+)", " ".join(slurm_options))
    return int(found.group(1)) if found else 1


def submit(plan, missing, options, script, name):
    """Job arrays over the missing cells, and a summary after them however they ended; the jobs'
    ids.

    missing: [first, last) ranges of cell numbers."""
    folder = os.path.join(plan.out, "slurm")
    os.makedirs(folder, exist_ok=True)
    for old in os.listdir(folder):
        if old.startswith(f"{name}."):
            os.remove(os.path.join(folder, old))
    limit = limits()
    chunk = max(options.chunk, -(-sum(last - first for first, last in missing) // limit["jobs"]))
    if chunk > options.chunk:
        print(
            f"retarget-batch: {chunk} cells in a task instead of {options.chunk}, since the "
            f"cluster holds {2 * limit['jobs']} jobs (MaxJobCount)",
            file=sys.stderr,
        )
    tasks = os.path.join(folder, f"{name}.tasks")
    count = 0
    with open(tasks, "w") as file:
        for line in tasks_of(missing, chunk, processors_of(options.slurm_option)):
            file.write(line)
            count += 1
    one = (
        f"{shlex.quote(sys.executable)} {shlex.quote(script)} --slice {shlex.quote(plan.out)} cells"
    )
    array = os.path.join(folder, f"{name}.sh")
    with open(array, "w") as file:
        file.write(
            f'#!/bin/bash\nsed -n "$(($1 + SLURM_ARRAY_TASK_ID + 1))p" {shlex.quote(tasks)} | tr '
            f"' ' '\\n' | xargs -r -n 1 -P \"${{SLURM_CPUS_PER_TASK:-1}}\" {one}\n"
        )
    common = ["--parsable", f"--chdir={plan.out}", *options.slurm_option]
    jobs = []
    for first in range(0, count, limit["array"]):
        size = min(limit["array"], count - first)
        jobs.append(
            sbatch(
                [
                    *common,
                    f"--job-name=sloper-{name}",
                    f"--array=0-{size - 1}",
                    "--requeue",
                    "--open-mode=append",
                    f"--output={folder}/{name}.{first}.%a.log",
                    array,
                    str(first),
                ]
            )
        )
    summary = (
        f"{shlex.quote(sys.executable)} {shlex.quote(script)} --summary {shlex.quote(plan.out)}"
    )
    # afterany, not afterok: one bad scan must not take the summary away.
    jobs.append(
        sbatch(
            [
                *common,
                f"--job-name=sloper-{name}-summary",
                f"--dependency=afterany:{':'.join(jobs)}",
                f"--output={folder}/{name}.summary.log",
                "--wrap",
                summary,
            ]
        )
    )
    return jobs


def still_there(jobs):
    done = subprocess.run(
        ["squeue", "-h", "-o", "%i %T", "-j", ",".join(jobs)], capture_output=True, text=True
    )
    if done.returncode != 0:  # "Invalid job id" once all are forgotten; anything else may pass
        return "Invalid job id" not in done.stderr
    return bool(done.stdout.strip())


def run(plan, missing, options, progress, script):
    """missing: [first, last) ranges of cell numbers, at least one."""
    for number in range(ROUNDS):
        try:
            jobs = submit(plan, missing, options, script, f"round{number}")
        except (OSError, subprocess.CalledProcessError) as error:
            raise planning.Mistake(
                f"sbatch: {(getattr(error, 'stderr', None) or str(error)).strip()}", 4
            ) from None
        if options.no_wait:
            print(" ".join(jobs))
            return
        while still_there(jobs):
            progress.show()
            time.sleep(options.poll_s)
            if progress.is_done():
                break
        missing = plan.missing()
        if not missing:
            break
    progress.end()
