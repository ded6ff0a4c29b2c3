"""What a batch consists of: bodies and cells, each with a key made from the contents of everything that decides its result."""
import hashlib
import json
import os
import subprocess

SCAN_SUFFIXES = (".obj", ".ply", ".stl", ".3ds", ".xyz")
PROGRAMS = ("scan-landmarks", "retarget-garment", "render-png")


class Mistake(Exception):
    """The user's: said without a trace, with an exit code."""

    def __init__(self, text, exit_code=3):
        super().__init__(text)
        self.exit_code = exit_code


def sha256(*paths):
    digest = hashlib.sha256()
    for path in paths:
        with open(path, "rb") as file:
            for block in iter(lambda: file.read(1 << 20), b""):
                digest.update(block)
    return digest.hexdigest()


def key_of(description):
    return hashlib.sha256(json.dumps(description, sort_keys=True).encode()).hexdigest()[:20]


def write_json(path, value):
    """Whole or not at all."""
    temporary = f"{path}.{os.getpid()}.tmp"
    with open(temporary, "w") as file:
        json.dump(value, file, indent=1, sort_keys=True)
        file.write("\n")
        file.flush()
        os.fsync(file.fileno())
    os.replace(temporary, path)


def read_json(path):
    with open(path) as file:
        return json.load(file)


def is_document(path, wanted):
    if not path.endswith(".json"):
        return False
    try:
        with open(path) as file:
            head = file.read(200)
        return f'"format": "{wanted}"' in head
    except OSError:
        return False


def listed(place, wanted):
    """Files of a folder, or the file itself, or those that a .txt names line by line; sorted by name."""
    if os.path.isdir(place):
        found = [os.path.join(place, name) for name in sorted(os.listdir(place)) if not name.startswith(".")]
        return [path for path in found if wanted(path)]
    if place.endswith(".txt"):
        try:
            with open(place) as file:
                names = [line.strip() for line in file if line.strip() and not line.startswith("#")]
        except OSError as error:
            raise Mistake(f"{place}: {error.strerror}") from error
        return [os.path.join(os.path.dirname(place), name) for name in names]
    return [place]


def find_garments(place):
    garments = listed(place, lambda path: is_document(path, "garment"))
    if not garments:
        raise Mistake(f"{place}: no garment document in it; drape one first")
    return garments


def find_scans(place):
    def wanted(path):
        if is_document(path, "body"):
            return True
        # The .obj beside a document belongs to it.
        return path.lower().endswith(SCAN_SUFFIXES) and not os.path.exists(os.path.splitext(path)[0] + ".json")

    scans = listed(place, wanted)
    if not scans:
        raise Mistake(f"{place}: no scan in it ({', '.join(SCAN_SUFFIXES)}, or a body document)")
    return scans


def stem(path):
    name = os.path.basename(path)
    for suffix in (".body.json", ".json") + SCAN_SUFFIXES:
        if name.lower().endswith(suffix):
            return name[: -len(suffix)]
    return name


def programs(folder):
    """Path, version and hash of each program."""
    found = {}
    for name in PROGRAMS:
        path = os.path.join(folder, name)
        if not os.access(path, os.X_OK):
            raise Mistake(f"{path}: no such program; say --bin FOLDER", 2)
        version = subprocess.run([path, "--version"], capture_output=True, text=True, check=True).stdout.splitlines()[0]
        found[name] = {"path": os.path.abspath(path), "version": version, "sha256": sha256(path)}
    return found


def make_plan(garments, scans, settings, tools):
    """settings: mode, accuracy, set, policy (path or None), timeout_s, pictures, unit, up.
    Returns {"bodies": {key: ...}, "cells": {key: ...}}."""
    bodies, cells = {}, {}
    body_of = {}
    for scan in scans:
        if not os.path.isfile(scan):
            raise Mistake(f"{scan}: no such file")
        is_body = scan.endswith(".json")
        mesh = os.path.splitext(scan)[0] + ".obj"
        if is_body and not os.path.isfile(mesh):
            raise Mistake(f"{scan}: its {os.path.basename(mesh)} is not beside it")
        digest = sha256(scan, mesh) if is_body else sha256(scan)
        key = key_of({"scan": digest, "is_body": is_body, "program": tools["scan-landmarks"]["sha256"], "unit": settings["unit"], "up": settings["up"]})
        bodies.setdefault(key, {"scan": os.path.abspath(scan), "name": stem(scan), "sha256": digest, "is_body": is_body})
        body_of[scan] = key
    names = set()
    for garment in garments:
        if not os.path.isfile(garment):
            raise Mistake(f"{garment}: no such file")
        mesh = os.path.splitext(garment)[0] + ".obj"
        digest = sha256(garment, mesh)
        name, _, size = stem(garment).partition("@")
        for scan in scans:
            cell_name = f"{stem(garment)} on {stem(scan)}"
            if cell_name in names:
                raise Mistake(f"two cells are called {cell_name}; rename a file")
            names.add(cell_name)
            key = key_of({
                "garment": digest, "body": body_of[scan], "names": cell_name,
                "programs": [tools[p]["sha256"] for p in ("retarget-garment", "render-png")],
                "settings": {k: settings[k] for k in ("mode", "accuracy", "set", "pictures")},
                "policy": sha256(settings["policy"]) if settings["policy"] else None,
            })
            cells[key] = {"name": cell_name, "garment": name, "size": size, "garment_file": os.path.abspath(garment), "garment_sha256": digest,
                          "scan": stem(scan), "body": body_of[scan]}
    return {"bodies": bodies, "cells": cells}


def manifest(plan, settings, tools, statuses):
    """What was made from what; no times, hosts or absolute paths, so that equal batches have equal manifests."""
    shown = dict(settings)
    shown["policy"] = os.path.basename(settings["policy"]) if settings["policy"] else None
    return {
        "format": "batch", "version": 1, "settings": shown,
        "programs": {name: {"version": t["version"], "sha256": t["sha256"]} for name, t in tools.items()},
        "bodies": {key: {"name": b["name"], "file": os.path.basename(b["scan"]), "sha256": b["sha256"]} for key, b in plan["bodies"].items()},
        "cells": [{"name": c["name"], "garment": c["garment"], "size": c["size"], "scan": c["scan"], "key": key, "body": c["body"],
                   "garment_sha256": c["garment_sha256"], "status": statuses[key]["cause"] if key in statuses else "missing"}
                  for key, c in sorted(plan["cells"].items(), key=lambda item: item[1]["name"])],
    }
