"""Command lines of the scripts as those of the programs: a misspelt option or word is answered with
the nearest one, and --json-usage prints the options for programs, in the form of the programs'
own."""
import argparse
import json
import sys

USAGE_ERROR = 2  # exit status
LEAST_DISTANCE = 2  # letters by which a word may differ from the one that is suggested


def edit_distance(a, b):
    """Levenshtein's distance."""
    row = list(range(len(b) + 1))
    for i, letter in enumerate(a, 1):
        diagonal, row[0] = row[0], i
        for j, other in enumerate(b, 1):
            diagonal, row[j] = row[j], min(row[j] + 1, row[j - 1] + 1, diagonal + (letter != other))
    return row[-1]


def did_you_mean(word, known):
    """ " (did you mean X?)", or nothing where no known word is near."""
    best = min(known, key=lambda k: edit_distance(word, k), default=None)
    if best is None or edit_distance(word, best) > max(LEAST_DISTANCE, len(word) // 3):
        return ""
    return f" (did you mean {best}?)"


class JsonUsage(argparse.Action):
    """Prints the usage as JSON and ends."""

    def __init__(self, option_strings, dest, **words):
        super().__init__(option_strings, dest, nargs=0, **words)

    def __call__(self, parser, namespace, values, option_string=None):
        print(json.dumps(parser.usage_document(), indent=1))
        parser.exit()


class Parser(argparse.ArgumentParser):
    """Options of one script.

    exit_statuses: list of (status, meaning); examples: list of (command, what); files: destinations
    of the options and operands whose value is a path; summary: one sentence.
    """

    def __init__(self, *, summary, exit_statuses, examples, files, **words):
        super().__init__(**words)
        self.summary, self.exit_statuses = summary, exit_statuses
        self.examples, self.files = examples, files
        self.add_argument(
            "--json-usage",
            action=JsonUsage,
            default=argparse.SUPPRESS,
            help="this help as JSON, for programs: options, values, exit statuses",
        )

    def parse_args(self, args=None, namespace=None):
        args = sys.argv[1:] if args is None else list(args)
        known = [name for action in self._actions for name in action.option_strings]
        for word in args:
            if word == "--":
                break
            name = word.split("=", 1)[0]
            is_known = any(option.startswith(name) for option in known)  # argparse completes names
            if name.startswith("--") and not is_known:
                self.error(f"unknown option {name}{did_you_mean(name, known)}")
        return super().parse_args(args, namespace)

    def _check_value(self, action, value):
        if action.choices is not None and value not in action.choices:
            choices = ", ".join(map(str, action.choices))
            raise argparse.ArgumentError(
                action, f"{value} is none of {choices}{did_you_mean(str(value), action.choices)}"
            )

    def error(self, message):
        self.exit(USAGE_ERROR, f"{self.prog}: {message}\nTry '{self.prog} --help'.\n")

    def usage_document(self):
        """The document of --json-usage: format "usage", version 1."""
        rows = {"operands": [], "options": []}
        for action in self._actions:
            takes_value = action.nargs != 0
            metavar = action.metavar or action.dest.upper()
            row = {}
            if action.option_strings:
                row["names"] = action.option_strings
                row["value"] = metavar if takes_value else None
            else:
                row["operand"] = metavar
            if action.choices is not None:
                row["choices"] = list(action.choices)
            row["description"] = " ".join((action.help or "").split())
            row["required"] = action.required
            row["repeats"] = type(action).__name__ == "_AppendAction"
            row["is_file"] = action.dest in self.files
            if action.option_strings:
                row["common"] = action.dest in ("help", "json_usage", "quiet")
            rows["options" if action.option_strings else "operands"].append(row)
        operands = " ".join(row["operand"] for row in rows["operands"])
        return {
            "format": "usage",
            "version": 1,
            "name": self.prog,
            "summary": self.summary,
            "usage": f"{self.prog} [OPTION]... {operands}",
            **rows,
            "exit_statuses": [{"status": s, "meaning": m} for s, m in self.exit_statuses],
            "examples": [{"command": c, "what": w} for c, w in self.examples],
        }
