"""What a batch consists of: scans and garments, and a cell for each pair, with a key made from all
that decides its result.

A plan does not list its cells. Cell i is garment i % G on scan i // G, and its key is computed when
it is asked for, so that a plan of a million cells is no larger than its lists of files.
OUT/plan/plan.json holds the settings and the garments; OUT/plan/scans.N.json holds the scans,
SCANS_A_FILE in each; OUT/plan/hashes.json holds what was hashed, by file.
"""
import hashlib
import json
import os
import subprocess
import tempfile

SCAN_SUFFIXES = (
    ".obj",
    ".ply",
    ".stl",
    ".3ds",
    ".xyz",
    ".pcd",
    ".glb",
    ".gltf",
    ".fbx",
    ".dae",
    ".off",
)
PROGRAMS = ("scan-landmarks", "retarget-garment", "render-png")
SCANS_A_FILE = 1000
KEY_LETTERS = 20
FLAT_CELLS = 4096  # a batch of more cells than this keeps them in 256 folders
SLICES = 10_000  # at most so many targets in batch.mk


BUILT_IN_POLICY = "woven"  # of retarget-garment


def policy_hash(policy):
    """Of the file; the name of the built-in policy; None without one."""
    return policy if policy in (None, BUILT_IN_POLICY) else sha256(policy)


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


class Hashes:
    """SHA-256 of files. What a former plan of the same batch hashed is not read again while size,
    times and inode are the same."""

    def __init__(self, path):
        self.path = path
        self.known = {}
        self.used = {}
        try:
            self.known = read_json(path)
        except (OSError, ValueError):
            pass

    def of(self, *paths):
        mark = []
        for path in paths:
            s = os.stat(path)
            mark += [s.st_size, s.st_mtime_ns, s.st_ctime_ns, s.st_ino]
        name = "\n".join(paths)
        entry = self.known.get(name)
        if not entry or entry[1:] != mark:
            entry = [sha256(*paths), *mark]
        self.used[name] = entry
        return entry[0]

    def save(self):
        if self.used != self.known:
            write_json(self.path, self.used, indent=None)


def key_of(description):
    return hashlib.sha256(json.dumps(description, sort_keys=True).encode()).hexdigest()[
        :KEY_LETTERS
    ]


def write_text(path, text):
    """Whole or not at all."""
    temporary = f"{path}.{os.getpid()}.tmp"
    try:
        with open(temporary, "w") as file:
            file.write(text)
            file.flush()
            os.fsync(file.fileno())
        os.replace(temporary, path)
    except OSError:
        if os.path.exists(temporary):
            os.remove(temporary)
        raise


def write_json(path, value, indent=1):
    write_text(path, json.dumps(value, indent=indent, sort_keys=True) + "\n")


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
    """Files of a folder, or the file itself, or those that a .txt names line by line; sorted by
    name."""
    if os.path.isdir(place):
        found = [
            os.path.join(place, name)
            for name in sorted(os.listdir(place))
            if not name.startswith(".")
        ]
        return [path for path in found if wanted(path)]
    if place.endswith(".txt"):
        try:
            with open(place) as file:
                names = [line.strip() for line in file if line.strip() and not line.startswith("#")]
        except OSError as error:
            raise Mistake(f"{place}: {error.strerror}") from error
        return [os.path.join(os.path.dirname(place), name) for name in names]
    return [place]


MESH_SUFFIXES = (".obj", ".ply", ".glb")  # of garments without a pattern


def find_garments(place, worn_by=None):
    """Garment documents; with a body that wears them, also meshes that belong to no document."""
    beside = set(os.listdir(place)) if os.path.isdir(place) else set()

    def wanted(path):
        alone = (
            path.lower().endswith(MESH_SUFFIXES)
            and os.path.splitext(os.path.basename(path))[0] + ".json" not in beside
        )
        return is_document(path, "garment") or (alone and worn_by is not None)

    garments = listed(place, wanted)
    meshes = [path for path in garments if path.lower().endswith(MESH_SUFFIXES)]
    if meshes and not worn_by:
        raise Mistake(f"{meshes[0]}: a mesh does not say who wears it; say --from BODY")
    if not garments:
        raise Mistake(
            f"{place}: no garment document in it; drape one first, or say --from BODY where they "
            f"are meshes"
        )
    return garments


def find_scans(place):
    beside = set(os.listdir(place)) if os.path.isdir(place) else set()

    def wanted(path):
        if is_document(path, "body"):
            return True
        # The .obj beside a document belongs to it.
        return (
            path.lower().endswith(SCAN_SUFFIXES)
            and os.path.splitext(os.path.basename(path))[0] + ".json" not in beside
        )

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
        version = subprocess.run(
            [path, "--version"], capture_output=True, text=True, check=True
        ).stdout.splitlines()[0]
        found[name] = {"path": os.path.abspath(path), "version": version, "sha256": sha256(path)}
    return found


def try_options(tools, settings):
    """Each program is called once with the options that every cell passes on, and with nothing to
    read, so that a mistake in them is said before anything is made.

    An option that will do ends in bad input, since there is none. --from and --fabric need a mesh
    and are told by the cells."""
    retarget = ["--mode", settings["mode"], "--accuracy", settings["accuracy"]]
    for assignment in settings["set"]:
        retarget += ["--set", assignment]
    if settings["policy"]:
        retarget += ["--policy", settings["policy"]]
    calls = {
        "scan-landmarks": ["--unit", settings["unit"], "--up", settings["up"], os.devnull],
        "retarget-garment": [*retarget, "--garment", os.devnull, "--to", os.devnull],
    }
    with tempfile.TemporaryDirectory() as folder:
        for name, words in calls.items():
            done = subprocess.run(
                [tools[name]["path"], "-o", os.path.join(folder, "out.json"), *words],
                stdin=subprocess.DEVNULL,
                capture_output=True,
                text=True,
                env=dict(os.environ, LC_ALL="C.UTF-8"),
            )
            said = done.stderr.strip().splitlines()
            if done.returncode in (2, 3) and said and os.devnull not in said[0]:
                raise Mistake(said[0], done.returncode)


def checked(path):
    """The files of a garment or a scan: a document and its mesh, or the scan alone."""
    if not os.path.isfile(path):
        raise Mistake(f"{path}: no such file")
    if not path.endswith(".json"):
        return (path,)
    mesh = os.path.splitext(path)[0] + ".obj"
    if not os.path.isfile(mesh):
        raise Mistake(f"{path}: its {os.path.basename(mesh)} is not beside it")
    return path, mesh


def refuse_twice(kind, paths):
    seen = {}
    for path in paths:
        other = seen.setdefault(stem(path), path)
        if other is not path:
            raise Mistake(
                f"two {kind} are called {stem(path)}: {other} and {path}; rename one, since cells "
                f"are named after them"
            )


def ranges_of(numbers):
    """Ascending numbers as [first, last) ranges: 1 2 3 7 -> [1, 4] [7, 8]."""
    found = []
    for number in numbers:
        if found and found[-1][1] == number:
            found[-1][1] += 1
        else:
            found.append([number, number + 1])
    return found


class Plan:
    """A batch in OUT. Cells are numbered scan by scan: those of one scan stand beside one
    another."""

    def __init__(self, out, document, scans=None):
        self.out = out
        self.settings = document["settings"]
        self.programs = document["programs"]
        self.garments = document["garments"]
        self.scan_count = document["scans"]
        self.cache = document["cache"]
        self.skins = document["skins"]
        self.sharded = document["sharded"]
        self.loaded = (
            {}
            if scans is None
            else dict(
                enumerate(scans[i : i + SCANS_A_FILE] for i in range(0, len(scans), SCANS_A_FILE))
            )
        )
        self.keeps_all = scans is not None
        self.others = 0  # known after missing()
        tools = self.programs
        self.base = key_of(
            {
                "programs": [tools[p]["sha256"] for p in ("retarget-garment", "render-png")],
                "settings": {k: self.settings[k] for k in ("mode", "accuracy", "set", "pictures")},
                "policy": document["policy_sha256"],
                **(
                    {"from": document["from_sha256"], "fabric": self.settings["fabric"]}
                    if document.get("from_sha256")
                    else {}
                ),
            }
        )

    @property
    def cell_count(self):
        return len(self.garments) * self.scan_count

    def scan(self, number):
        """{"scan": path, "name", "sha256", "is_body", "key"}"""
        part = number // SCANS_A_FILE
        if part not in self.loaded:
            if not self.keeps_all:
                self.loaded.clear()
            self.loaded[part] = read_json(os.path.join(self.out, "plan", f"scans.{part}.json"))
        return self.loaded[part][number % SCANS_A_FILE]

    def key(self, number):
        scan, garment = divmod(number, len(self.garments))
        scan, garment = self.scan(scan), self.garments[garment]
        parts = (self.base, garment["sha256"], garment["stem"], scan["key"], scan["name"])
        return hashlib.sha256("\n".join(parts).encode()).hexdigest()[:KEY_LETTERS]

    def cell(self, number):
        scan, garment = divmod(number, len(self.garments))
        scan, garment = self.scan(scan), self.garments[garment]
        return {
            "number": number,
            "key": self.key(number),
            "name": f"{garment['stem']} on {scan['name']}",
            "garment": garment["name"],
            "size": garment["size"],
            "garment_file": garment["file"],
            "sizes": garment.get("sizes", []),
            "garment_sha256": garment["sha256"],
            "scan": scan["name"],
            "body": scan["key"],
        }

    def place(self, key):
        """The folder of a cell, below OUT/cells; also that of its times, below OUT/timings."""
        return os.path.join(key[:2], key) if self.sharded else key

    def folder(self, key):
        return os.path.join(self.out, "cells", self.place(key))

    def is_made(self, number):
        """A cell's folder is renamed into place when it is whole."""
        return os.path.exists(os.path.join(self.folder(self.key(number)), "status.json"))

    def made_keys(self):
        """Keys of all cells that are there, from the listing of their folders."""
        root = os.path.join(self.out, "cells")
        if not os.path.isdir(root):
            return set()
        return {
            key
            for part in (os.listdir(root) if self.sharded else ["."])
            for key in os.listdir(os.path.join(root, part))
        }

    def missing(self):
        """The cells that are not there yet, as [first, last) ranges of their numbers in ascending
        order. `others` is then the number of cells that only other batches have asked for."""
        made = {key for key in self.made_keys() if len(key) == KEY_LETTERS}
        self.others = len(made)
        if not made:
            return [[0, self.cell_count]]

        def is_missing(number):
            there = self.key(number) in made
            self.others -= there
            return not there

        return ranges_of(filter(is_missing, range(self.cell_count)))

    def slices(self):
        """Targets of batch.mk: {"bodies": [(first, last)], "cells": [(first, last, index of its
        bodies)]}, last excluded. Few cells: one in each."""
        garments = len(self.garments)
        scans_each = -(-self.scan_count // SLICES)
        cells_each = -(-self.cell_count // SLICES)
        bodies, cells = [], []
        for first in range(0, self.scan_count, scans_each):
            last = min(first + scans_each, self.scan_count)
            cells += [
                (i, min(i + cells_each, last * garments), len(bodies))
                for i in range(first * garments, last * garments, cells_each)
            ]
            bodies.append((first, last))
        return {"bodies": bodies, "cells": cells}


def by_nearest_size(worn, hashes):
    """Garments of which all sizes beside them are one: the program takes the size whose own body is
    nearest. Its key is of all sizes."""
    grouped = []
    for garment in worn:
        folder = os.path.dirname(garment["file"])
        if not garment["size"]:
            grouped.append(garment)
        elif all(
            other["name"] != garment["name"] or os.path.dirname(other["file"]) != folder
            for other in grouped
        ):
            sizes = sorted(
                os.path.join(folder, name)
                for name in os.listdir(folder)
                if name.startswith(garment["name"] + "@")
                and is_document(os.path.join(folder, name), "garment")
            )
            digest = hashlib.sha256(
                "\n".join(f"{stem(path)} {hashes.of(*checked(path))}" for path in sizes).encode()
            ).hexdigest()
            grouped.append(
                {**garment, "stem": garment["name"], "size": "", "sha256": digest, "sizes": sizes}
            )
    refuse_twice(
        "garments", [os.path.join(os.path.dirname(g["file"]), g["stem"] + ".json") for g in grouped]
    )
    return grouped


def load(out):
    return Plan(out, read_json(os.path.join(out, "plan", "plan.json")))


def make_plan(out, garments, scans, settings, tools, cache=None):
    """settings: mode, accuracy, set, policy (path or None), timeout_s, pictures, unit, up. Writes
    OUT/plan and returns the plan."""
    folder = os.path.join(out, "plan")
    refuse_twice("garments", garments)
    refuse_twice("scans", scans)
    files = {path: checked(path) for path in garments + scans}
    os.makedirs(folder, exist_ok=True)
    hashes = Hashes(os.path.join(folder, "hashes.json"))
    how = {
        "program": tools["scan-landmarks"]["sha256"],
        "unit": settings["unit"],
        "up": settings["up"],
    }
    described = []
    for path in scans:
        digest = hashes.of(*files[path])
        is_body = path.endswith(".json")
        described.append(
            {
                "scan": os.path.abspath(path),
                "name": stem(path),
                "sha256": digest,
                "is_body": is_body,
                "key": key_of({"scan": digest, "is_body": is_body, **how}),
            }
        )
    worn = []
    for path in garments:
        name, _, size = stem(path).partition("@")
        worn.append(
            {
                "file": os.path.abspath(path),
                "stem": stem(path),
                "name": name,
                "size": size,
                "sha256": hashes.of(*files[path]),
            }
        )
    if settings.get("nearest_size"):
        worn = by_nearest_size(worn, hashes)
    hashes.save()
    try:  # a batch that grows keeps its layout
        sharded = read_json(os.path.join(folder, "plan.json"))["sharded"]
    except (OSError, ValueError, KeyError):
        sharded = len(worn) * len(described) > FLAT_CELLS
    document = {
        "settings": settings,
        "programs": tools,
        "garments": worn,
        "scans": len(described),
        "sharded": sharded,
        "cache": cache or os.path.join(out, "bodies"),
        "skins": os.path.join(cache or out, "skins"),
        "policy_sha256": policy_hash(settings["policy"]),
        "from_sha256": sha256(*checked(settings["from"])) if settings.get("from") else None,
    }
    for part in range(0, len(described), SCANS_A_FILE):
        write_json(
            os.path.join(folder, f"scans.{part // SCANS_A_FILE}.json"),
            described[part : part + SCANS_A_FILE],
            indent=None,
        )
    write_json(os.path.join(folder, "plan.json"), document)
    return Plan(out, document, described)


def write_manifest(path, plan, causes):
    """What was made from what; no times, hosts or absolute paths, so that equal batches have equal
    manifests. Written cell by cell.

    causes: the cause of cell i, or None where it is missing."""
    shown = dict(plan.settings)
    for key in ("policy", "from"):
        shown[key] = os.path.basename(shown[key]) if shown.get(key) else None
    scans = [plan.scan(i) for i in range(plan.scan_count)]
    head = {
        "format": "batch",
        "version": 1,
        "settings": shown,
        "programs": {
            name: {"version": t["version"], "sha256": t["sha256"]}
            for name, t in plan.programs.items()
        },
        "bodies": {
            s["key"]: {
                "name": s["name"],
                "file": os.path.basename(s["scan"]),
                "sha256": s["sha256"],
            }
            for s in reversed(scans)
        },
    }
    if plan.sharded:
        head[
            "sharded"
        ] = True  # a cell stands in cells/KE/KEY, with the first two letters of its key
    by_name = sorted(range(len(scans)), key=lambda i: scans[i]["name"])
    temporary = f"{path}.{os.getpid()}.tmp"
    first, last = json.dumps(head, indent=1, sort_keys=True).split('"format": "batch"')
    with open(temporary, "w") as file:
        file.write(first + '"cells": [')
        between = "\n"
        for number in sorted(range(len(plan.garments)), key=lambda i: plan.garments[i]["stem"]):
            for scan in by_name:
                c = plan.cell(scan * len(plan.garments) + number)
                line = {
                    "name": c["name"],
                    "garment": c["garment"],
                    "size": c["size"],
                    "scan": c["scan"],
                    "key": c["key"],
                    "body": c["body"],
                    "garment_sha256": c["garment_sha256"],
                    "status": causes[c["number"]] or "missing",
                }
                file.write(between + json.dumps(line, sort_keys=True))
                between = ",\n"
        file.write('\n ],\n "format": "batch"' + last + "\n")
        file.flush()
        os.fsync(file.fileno())
    os.replace(temporary, path)
