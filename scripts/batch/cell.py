"""One body or one cell, made in a folder of its own that is renamed into place when it is whole. A failed cell is a result too."""
import gzip
import io
import json
import os
import resource
import shlex
import shutil
import subprocess
import tarfile
import time

from . import plan as planning


def work_folder(out, key):
    path = os.path.join(out, "work", f"{key}.{os.uname().nodename}.{os.getpid()}")
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
    """Exit code (or "time out", "signal 9"), last line of stderr, and {wall_s, cpu_s, peak_mb}."""
    start, before = time.monotonic(), resource.getrusage(resource.RUSAGE_CHILDREN)
    environment = dict(os.environ, LC_ALL="C.UTF-8")
    try:
        done = subprocess.run(command, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, timeout=timeout_s, cwd=folder, env=environment)
        code = done.returncode if done.returncode >= 0 else f"signal {-done.returncode}"
        lines = done.stderr.decode(errors="replace").strip().splitlines()
    except subprocess.TimeoutExpired:
        code, lines = "time out", []
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    cost = {"wall_s": round(time.monotonic() - start, 3), "cpu_s": round(after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime, 3),
            "peak_mb": round(after.ru_maxrss / 1024, 1)}
    message = lines[-1] if lines else ""
    for path in [folder, *(os.path.dirname(word) for word in command[1:] if word.startswith("/"))]:
        message = message.replace(path + "/", "")
    return code, message, cost


def make_body(out, plan, key):
    body = plan["bodies"][key]
    target = os.path.join(plan["cache"], key)
    if os.path.exists(os.path.join(target, "status.json")):
        return
    os.makedirs(plan["cache"], exist_ok=True)
    folder = work_folder(out, key)
    if body["is_body"]:
        shutil.copy(body["scan"], os.path.join(folder, "body.json"))
        shutil.copy(os.path.splitext(body["scan"])[0] + ".obj", os.path.join(folder, "body.obj"))
        code, message = 0, ""
        # The document names its mesh; ours is called body.obj here.
        document = planning.read_json(os.path.join(folder, "body.json"))
        document["mesh"] = "body.obj"
        planning.write_json(os.path.join(folder, "body.json"), document)
    else:
        command = [plan["programs"]["scan-landmarks"]["path"], "--threads", "1", "--unit", plan["settings"]["unit"], "--up", plan["settings"]["up"], "-o", "body.json", body["scan"]]
        code, message, _ = run(command, plan["settings"]["timeout_s"], folder)
    planning.write_json(os.path.join(folder, "status.json"), {"exit": code, "message": message, "usable": os.path.exists(os.path.join(folder, "body.json"))})
    put_in_place(folder, target)


def cause_of(code, fit, report):
    """The class of a cell: dressed, or why it is not."""
    if code == "time out":
        return "time out"
    if isinstance(code, str) or code == 70:
        return "crash"
    if fit and fit.get("fits") is False and code in (1, 4):
        return "cannot go on" if not fit.get("girths") and not fit.get("regions") else "does not fit"
    if code == 0:
        return "dressed"
    if code == 4:
        quality = (report or {}).get("quality") or {}
        if quality.get("faces_through_body") or quality.get("vertices_inside_body"):
            return "in the body"
        if quality.get("self_intersections"):
            return "through itself"
        return "not at rest"
    return {1: "does not fit", 2: "wrong command line", 3: "bad input", 5: "cannot write"}.get(code, "crash")


def add_bytes(archive, name, data, mode=0o644):
    info = tarfile.TarInfo(name)
    info.size, info.mode = len(data), mode
    archive.addfile(info, io.BytesIO(data))


def write_bundle(path, files, command, code, message, versions):
    """Inputs, the command and what came of it: unpack, `sh replay` does it again. The same bytes every time."""
    stem = "repro"
    replay = ("#!/bin/sh\n# Does the failed cell again; the programs are taken from PATH. It ended with: "
              f"{code}\n" + "".join(f"# {v}\n" for v in versions) + 'cd "$(dirname "$0")" || exit 70\n' + shlex.join(command) + '\nstatus=$?\necho "exit $status; the batch had '
              + str(code) + '"\n')
    raw = io.BytesIO()
    with tarfile.open(fileobj=raw, mode="w", format=tarfile.USTAR_FORMAT) as archive:
        for name, source in sorted(files.items()):
            with open(source, "rb") as file:
                add_bytes(archive, f"{stem}/{name}", file.read())
        add_bytes(archive, f"{stem}/message.txt", (message + "\n").encode())
        add_bytes(archive, f"{stem}/replay", replay.encode(), 0o755)
    with open(path, "wb") as file, gzip.GzipFile(filename="", fileobj=file, mode="wb", mtime=0) as zipped:
        zipped.write(raw.getvalue())


def optional_json(path):
    try:
        return planning.read_json(path)
    except (OSError, ValueError):
        return None


def make_cell(out, plan, key):
    cell, settings, tools = plan["cells"][key], plan["settings"], plan["programs"]
    target = os.path.join(out, "cells", key)
    if os.path.exists(os.path.join(target, "status.json")):
        return
    make_body(out, plan, cell["body"])
    body_folder = os.path.join(plan["cache"], cell["body"])
    body_status = planning.read_json(os.path.join(body_folder, "status.json"))
    folder = work_folder(out, key)
    status = {k: cell[k] for k in ("name", "garment", "size", "scan")}
    versions = [tools[p]["version"] for p in ("scan-landmarks", "retarget-garment")]
    if not body_status["usable"]:
        status.update(exit=body_status["exit"], cause="bad scan", message=body_status["message"], dressed=False)
        scan = plan["bodies"][cell["body"]]["scan"]
        name = os.path.basename(scan)
        write_bundle(os.path.join(folder, "failure.repro.tgz"), {name: scan}, ["scan-landmarks", "--unit", settings["unit"], "--up", settings["up"], "-o", "body.json", name],
                     body_status["exit"], body_status["message"], versions)
        planning.write_json(os.path.join(folder, "status.json"), status)
        put_in_place(folder, target)
        return
    options = ["--mode", settings["mode"], "--accuracy", settings["accuracy"]]
    for assignment in settings["set"]:
        options += ["--set", assignment]
    command = [tools["retarget-garment"]["path"], "--threads", "1", "--cache", plan["skins"], "--garment", cell["garment_file"], "--to", os.path.join(body_folder, "body.json"), *options,
               *(["--policy", settings["policy"]] if settings["policy"] else []), "--fit", "fit.json", "--fit-page", "fit.html", "--report", "report.json", "-o", "garment.json"]
    code, message, cost = run(command, settings["timeout_s"], folder)
    fit, report = optional_json(os.path.join(folder, "fit.json")), optional_json(os.path.join(folder, "report.json"))
    cause = cause_of(code, fit, report)
    status.update(exit=code, cause=cause, message=message, dressed=cause == "dressed")
    if fit:
        status.update(fits=fit["fits"], verdict=fit["verdict"], reason=fit["reason"], margin_cm=fit["margin_cm"]["value"], margin_at=fit["margin_cm"]["girth"],
                      ease_percent={name: g["ease_percent"]["value"] for name, g in fit["girths"].items()}, strain_p99=fit["strain"]["p99"])
    if report:
        quality = report.get("quality") or {}
        status["quality"] = {k: quality[k] for k in ("faces_through_body", "vertices_inside_body", "self_intersections") if k in quality}
        status["steps"] = report.get("steps")
    if cause not in ("dressed", "does not fit", "cannot go on"):
        files = {"garment.json": cell["garment_file"], os.path.basename(os.path.splitext(cell["garment_file"])[0] + ".obj"): os.path.splitext(cell["garment_file"])[0] + ".obj",
                 "body.json": os.path.join(body_folder, "body.json"), "body.obj": os.path.join(body_folder, "body.obj")}
        replay = ["retarget-garment", "--garment", "garment.json", "--to", "body.json", *options]
        if settings["policy"]:
            files["policy.json"] = settings["policy"]
            replay += ["--policy", "policy.json"]
        write_bundle(os.path.join(folder, "failure.repro.tgz"), files, [*replay, "--report", "report.json", "-o", "out.json"], code, message, versions)
    if settings["pictures"] and os.path.exists(os.path.join(folder, "garment.json")):
        run([tools["render-png"]["path"], "--threads", "1", "--size", "240x360", "-o", "thumbnail.png", os.path.join(body_folder, "body.json"), "garment.json"], 60, folder)
    # What differs from run to run stands apart from the results.
    times = os.path.join(out, "timings", key)
    os.makedirs(times, exist_ok=True)
    if report:
        os.replace(os.path.join(folder, "report.json"), os.path.join(times, "report.json"))
    planning.write_json(os.path.join(times, "timing.json"), {"name": cell["name"], "cause": cause, "host": os.uname().nodename, "steps": (report or {}).get("steps"), **cost})
    planning.write_json(os.path.join(folder, "status.json"), status)
    put_in_place(folder, target)
