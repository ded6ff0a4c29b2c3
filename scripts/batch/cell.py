"""One body or one cell, made in a folder of its own that is renamed into place when it is whole. A
failed cell is a result too."""
import contextlib
import glob
import gzip
import io
import os
import shlex
import shutil
import signal
import subprocess
import tarfile
import threading
import time

from . import plan as planning
from .engines import PROGRESS

CANNOT_WRITE = 5  # exit status of the programs: the disk's fault, not the cell's


def work_folder(parent, key):
    """A new folder of this process in PARENT/work, on the disk to which it is renamed."""
    path = os.path.join(parent, "work", f"{key}.{os.uname().nodename}.{os.getpid()}")
    shutil.rmtree(path, ignore_errors=True)
    os.makedirs(path)
    return path


def put_in_place(folder, target):
    """The folder becomes `target`, whole; where another process was first, its result stays."""
    os.makedirs(os.path.dirname(target), exist_ok=True)
    for root, _, files in os.walk(folder):
        for name in files:
            with open(os.path.join(root, name), "rb") as file:
                os.fsync(file.fileno())
    try:
        os.rename(folder, target)
    except OSError:
        if not os.path.exists(os.path.join(target, "status.json")):
            raise
        shutil.rmtree(folder, ignore_errors=True)


def run(command, timeout_s, folder):
    """Exit code (or "time out", "signal 9"), last line of stderr, {wall_s, cpu_s, peak_mb}, and
    the warnings without the program's name."""
    start = time.monotonic()
    environment = dict(os.environ, LC_ALL="C.UTF-8")
    late = threading.Event()
    process = subprocess.Popen(
        command,
        stdin=subprocess.DEVNULL,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
        cwd=folder,
        env=environment,
    )

    def stop():
        late.set()
        process.kill()

    timer = threading.Timer(timeout_s, stop)
    timer.start()
    with process.stderr:
        lines = process.stderr.read().decode(errors="replace").strip().splitlines()
    _, ended, used = os.wait4(process.pid, 0)  # the use of this one child
    timer.cancel()
    code = process.returncode = os.waitstatus_to_exitcode(ended)
    if late.is_set() and code == -signal.SIGKILL:
        code, lines = "time out", []
    elif code in (-signal.SIGINT, -signal.SIGTERM):
        raise OSError(f"{os.path.basename(command[0])} was interrupted")  # the cell stays missing
    elif code < 0:
        code = f"signal {-code}"
    cost = {
        "wall_s": round(time.monotonic() - start, 3),
        "cpu_s": round(used.ru_utime + used.ru_stime, 3),
        "peak_mb": round(used.ru_maxrss / 1024, 1),
    }
    folders = [folder, *(os.path.dirname(word) for word in command[1:] if word.startswith("/"))]
    for path in folders:
        lines = [line.replace(path + "/", "") for line in lines]
    warnings = [line.split(": warning: ", 1)[1] for line in lines if ": warning: " in line]
    return code, lines[-1] if lines else "", cost, warnings


def refuse_full_disk(code, message):
    """What cannot be written is not a result: the cell stays missing and is made when there is
    room."""
    if code == CANNOT_WRITE:
        raise OSError(f"cannot write: {message}")


def make_body(plan, number):
    """The body document of one scan, below the cache; what it says is in its status.json."""
    body = plan.scan(number)
    target = os.path.join(plan.cache, body["key"])
    if os.path.exists(os.path.join(target, "status.json")):
        return
    os.makedirs(plan.cache, exist_ok=True)
    folder = work_folder(plan.cache, body["key"])
    if body["is_body"]:
        shutil.copy(body["scan"], os.path.join(folder, "body.json"))
        shutil.copy(os.path.splitext(body["scan"])[0] + ".obj", os.path.join(folder, "body.obj"))
        code, message = 0, ""
        # The document names its mesh; ours is called body.obj here.
        document = planning.read_json(os.path.join(folder, "body.json"))
        document["mesh"] = "body.obj"
        planning.write_json(os.path.join(folder, "body.json"), document)
    else:
        settings = plan.settings
        command = [
            plan.programs["scan-landmarks"]["path"],
            "--threads",
            "1",
            "--unit",
            settings["unit"],
            "--up",
            settings["up"],
            "-o",
            "body.json",
            body["scan"],
        ]
        code, message, _, _ = run(command, settings["timeout_s"], folder)
        refuse_full_disk(code, message)
    planning.write_json(
        os.path.join(folder, "status.json"),
        {
            "exit": code,
            "message": message,
            "usable": os.path.exists(os.path.join(folder, "body.json")),
        },
    )
    put_in_place(folder, target)


def cause_of(code, fit, report):
    """The class of a cell: dressed, or why it is not."""
    if code == "time out":
        return "time out"
    if isinstance(code, str) or code == 70:
        return "crash"
    if fit and fit.get("fits") is False and code in (1, 4):
        return (
            "cannot go on" if not fit.get("girths") and not fit.get("regions") else "does not fit"
        )
    if code == 0:
        return "dressed"
    if code == 4:
        quality = (report or {}).get("quality") or {}
        if quality.get("faces_through_body") or quality.get("vertices_inside_body"):
            return "in the body"
        if quality.get("self_intersections"):
            return "through itself"
        return "not at rest"
    return {1: "does not fit", 2: "wrong command line", 3: "bad input", 5: "cannot write"}.get(
        code, "crash"
    )


def add_bytes(archive, name, data, mode=0o644):
    info = tarfile.TarInfo(name)
    info.size, info.mode = len(data), mode
    archive.addfile(info, io.BytesIO(data))


def write_bundle(path, files, command, code, message, versions):
    """Inputs, the command and what came of it: unpack, `sh replay` does it again. The same bytes
    every time."""
    stem = "repro"
    replay = (
        "#!/bin/sh\n# Does the failed cell again; the programs are taken from PATH. It ended with: "
        f"{code}\n"
        + "".join(f"# {v}\n" for v in versions)
        + 'cd "$(dirname "$0")" || exit 70\n'
        + shlex.join(command)
        + '\nstatus=$?\necho "exit $status; the batch had '
        + str(code)
        + '"\n'
    )
    raw = io.BytesIO()
    with tarfile.open(fileobj=raw, mode="w", format=tarfile.USTAR_FORMAT) as archive:
        for name, source in sorted(files.items()):
            with open(source, "rb") as file:
                add_bytes(archive, f"{stem}/{name}", file.read())
        add_bytes(archive, f"{stem}/message.txt", (message + "\n").encode())
        add_bytes(archive, f"{stem}/replay", replay.encode(), 0o755)
    with open(path, "wb") as file, gzip.GzipFile(
        filename="", fileobj=file, mode="wb", mtime=0
    ) as zipped:
        zipped.write(raw.getvalue())


def optional_json(path):
    try:
        return planning.read_json(path)
    except (OSError, ValueError):
        return None


def make_cell(plan, number):
    """One garment on one scan, below OUT/cells. Nothing is done where it is there."""
    cell, settings, tools = plan.cell(number), plan.settings, plan.programs
    target = plan.folder(cell["key"])
    if os.path.exists(os.path.join(target, "status.json")):
        return
    scan_number = number // len(plan.garments)
    make_body(plan, scan_number)
    body_folder = os.path.join(plan.cache, cell["body"])
    body_status = planning.read_json(os.path.join(body_folder, "status.json"))
    folder = work_folder(plan.out, cell["key"])
    status = {k: cell[k] for k in ("name", "garment", "size", "scan")}
    versions = [tools[p]["version"] for p in ("scan-landmarks", "retarget-garment")]
    if not body_status["usable"]:
        status.update(
            exit=body_status["exit"],
            cause="bad scan",
            message=body_status["message"],
            dressed=False,
        )
        scan = plan.scan(scan_number)["scan"]
        name = os.path.basename(scan)
        write_bundle(
            os.path.join(folder, "failure.repro.tgz"),
            {name: scan},
            [
                "scan-landmarks",
                "--unit",
                settings["unit"],
                "--up",
                settings["up"],
                "-o",
                "body.json",
                name,
            ],
            body_status["exit"],
            body_status["message"],
            versions,
        )
        planning.write_json(os.path.join(folder, "status.json"), status)
        put_in_place(folder, target)
        return
    options = ["--mode", settings["mode"], "--accuracy", settings["accuracy"]]
    for assignment in settings["set"]:
        options += ["--set", assignment]
    if cell["sizes"]:
        options.append("--nearest-size")
    is_mesh = not cell["garment_file"].endswith(".json")
    if is_mesh:
        options += [
            "--from",
            settings["from"],
            *(["--fabric", settings["fabric"]] if settings.get("fabric") else []),
        ]
    command = [
        tools["retarget-garment"]["path"],
        "--threads",
        "1",
        "--cache",
        plan.skins,
        "--garment",
        cell["garment_file"],
        "--to",
        os.path.join(body_folder, "body.json"),
        *options,
        *(["--policy", settings["policy"]] if settings["policy"] else []),
        "--fit",
        "fit.json",
        "--fit-page",
        "fit.html",
        "--report",
        "report.json",
        "-o",
        "garment.json",
    ]
    code, message, cost, warnings = run(command, settings["timeout_s"], folder)
    refuse_full_disk(code, message)
    fit, report = optional_json(os.path.join(folder, "fit.json")), optional_json(
        os.path.join(folder, "report.json")
    )
    cause = cause_of(code, fit, report)
    status.update(exit=code, cause=cause, message=message, dressed=cause == "dressed")
    if status["dressed"]:  # of the others the reason says more
        status["warnings"] = [text.replace("body.json", cell["scan"]) for text in warnings]
    if fit:
        status.update(
            fits=fit["fits"],
            verdict=fit["verdict"],
            reason=fit["reason"],
            margin_cm=fit["margin_cm"]["value"],
            margin_at=fit["margin_cm"]["girth"],
            margin_uncertainty_cm=fit["girths"]
            .get(fit["margin_cm"]["girth"], {})
            .get("ease_cm", {})
            .get("uncertainty"),
            ease_percent={name: g["ease_percent"]["value"] for name, g in fit["girths"].items()},
            # cloth that was only placed has no strain
            strain_p99=fit["strain"]["p99"] if "at rest" in fit.get("state", "") else None,
        )
    if fit and "probability" in fit:
        status["probability"] = fit["probability"]["fits"]
    if report and cell["sizes"]:
        ranking = report["sizes"]
        status.update(
            size=planning.stem(ranking["nearest_first"][0]["file"]).partition("@")[2],
            nearest_sureness=ranking["sureness"],
        )
    if report:
        quality = report.get("quality") or {}
        status["quality"] = {
            k: quality[k]
            for k in ("faces_through_body", "vertices_inside_body", "self_intersections")
            if k in quality
        }
        status["steps"] = report.get("steps")
    if cause not in ("dressed", "does not fit", "cannot go on"):
        files = {
            "body.json": os.path.join(body_folder, "body.json"),
            "body.obj": os.path.join(body_folder, "body.obj"),
        }
        worn = os.path.basename(cell["garment_file"]) if is_mesh else "garment.json"
        files[worn] = cell["garment_file"]
        if is_mesh:
            mesh = os.path.splitext(settings["from"])[0] + ".obj"
            files.update({"from.json": settings["from"], os.path.basename(mesh): mesh})
            options[options.index("--from") + 1] = "from.json"
        elif cell["sizes"]:
            del files[worn]
            worn = os.path.basename(cell["garment_file"])
            files.update(
                {
                    os.path.basename(path): path
                    for size in cell["sizes"]
                    for path in planning.checked(size)
                }
            )
        else:
            mesh = os.path.splitext(cell["garment_file"])[0] + ".obj"
            files[os.path.basename(mesh)] = mesh
        replay = ["retarget-garment", "--garment", worn, "--to", "body.json", *options]
        if settings["policy"] == planning.BUILT_IN_POLICY:
            replay += ["--policy", settings["policy"]]
        elif settings["policy"]:
            files["policy.json"] = settings["policy"]
            replay += ["--policy", "policy.json"]
        write_bundle(
            os.path.join(folder, "failure.repro.tgz"),
            files,
            [*replay, "--report", "report.json", "-o", "out.json"],
            code,
            message,
            versions,
        )
    if settings["pictures"] and os.path.exists(os.path.join(folder, "garment.json")):
        run(
            [
                tools["render-png"]["path"],
                "--threads",
                "1",
                "--size",
                "240x360",
                "-o",
                "thumbnail.png",
                os.path.join(body_folder, "body.json"),
                "garment.json",
            ],
            60,
            folder,
        )
    # What differs from run to run stands apart from the results.
    times = os.path.join(plan.out, "timings", plan.place(cell["key"]))
    os.makedirs(times, exist_ok=True)
    if report:
        os.replace(os.path.join(folder, "report.json"), os.path.join(times, "report.json"))
    planning.write_json(
        os.path.join(times, "timing.json"),
        {
            "name": cell["name"],
            "cause": cause,
            "host": os.uname().nodename,
            "steps": (report or {}).get("steps"),
            **cost,
        },
    )
    planning.write_json(os.path.join(folder, "status.json"), status)
    put_in_place(folder, target)


def make_slice(plan, kind, first, last):
    """Bodies or cells first to last, last excluded. A full disk ends a slice with one line and exit
    status 5; what is made stays."""
    try:
        for number in range(first, last):
            if kind == "bodies":
                make_body(plan, number)
            elif not plan.is_made(number):
                make_cell(plan, number)
                with contextlib.suppress(OSError), open(
                    os.path.join(plan.out, "work", PROGRESS), "ab"
                ) as file:
                    file.write(b".")
    except OSError as error:
        for parent in (plan.out, plan.cache):
            for left in glob.glob(
                os.path.join(parent, "work", f"*.{os.uname().nodename}.{os.getpid()}")
            ):
                shutil.rmtree(left, ignore_errors=True)
        print(
            f"retarget-batch: {kind} {first} to {last - 1}: {error}; they are made when the batch "
            f"is started again",
            flush=True,
        )
        return CANNOT_WRITE
    return 0
