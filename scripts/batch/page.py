"""The population page: how many are dressed, how they fit, the worst first. One HTML file and the
cells' pictures; no network.

Of up to SMALL cells the page holds each one. Of more it holds counts, quantiles and the WORST
cells; the others stand in tables of ROWS rows below OUT/page, which it loads when they are asked
for.
"""
import array
import csv
import heapq
import html
import json
import math
import os
import shutil

from . import plan as planning

SMALL = 2000
WORST = 500
PICTURES = 200
ROWS = 1000
MESSAGES = 1000  # at most so many are counted of each cause
NAMED = 3  # failed cells in the closing lines

# As lib/garment/fit/fit_places.cpp; the test of the page compares.
SPOKEN = {
    "waist_semantic": "waist",
    "waist_girth_min": "narrowest waist",
    "waist_width_min": "waist seen from the front",
    "omphalion": "navel",
    "chest_axilla": "chest under the arms",
    "hip_girth_max": "widest hip",
    "ankle_min": "ankle",
}

GOOD = ("dressed",)
REFUSED = ("does not fit", "cannot go on")

HEAD = """<!doctype html>
<html lang="en"><head><meta charset="utf-8"><meta name="viewport" content="width=device-width, initial-scale=1">
<link rel="icon" href="data:,"><title>Population</title>
<style>
:root{--ink:#1d2433;--pale:#667;--line:#dde1ea;--ok:#2c7a4b;--no:#a86400;--bad:#b3261e}
*{box-sizing:border-box}body{font:16px/1.45 system-ui,sans-serif;color:var(--ink);max-width:76rem;margin:0 auto;padding:1rem}
h1{font-size:1.5rem;margin:.2rem 0}h2{font-size:1.1rem;margin:2rem 0 .5rem}.pale{color:var(--pale)}
.figures{display:flex;flex-wrap:wrap;gap:1rem}.figures div{background:#f6f7fa;padding:.7rem 1rem;min-width:9rem}.figures b{display:block;font-size:1.5rem}
.wide{overflow-x:auto}table{border-collapse:collapse;font-variant-numeric:tabular-nums;font-size:.9rem;min-width:100%}
th,td{padding:.3rem .6rem;border-bottom:1px solid var(--line);text-align:left;white-space:nowrap}td.n{text-align:right}
th{cursor:pointer;color:var(--pale)}th[aria-sort]{color:var(--ink)}td.words{white-space:normal;min-width:14rem}
.ok{color:var(--ok)}.no{color:var(--no)}.bad{color:var(--bad)}
.heat td{padding:0;text-align:center;min-width:2.6rem;font-size:.75rem;border:1px solid #fff}.heat th{font-weight:400;font-size:.8rem;cursor:default}
.heat td:first-child{text-align:left;padding-right:.6rem}
.cells{display:grid;grid-template-columns:repeat(auto-fill,minmax(9.5rem,1fr));gap:.8rem}figure{margin:0;border-top:.25rem solid}
figure.ok{border-color:var(--ok)}figure.no{border-color:var(--no)}figure.bad{border-color:var(--bad)}
figure img{width:100%;height:auto;aspect-ratio:2/3;object-fit:contain;background:#f6f7fa;display:block}figcaption{font-size:.8rem;color:var(--ink)}
a{color:inherit}
</style></head><body>
"""

SCRIPT = """<script>
for(const table of document.querySelectorAll("table.sorts"))table.tHead.addEventListener("click",e=>{const th=e.target.closest("th");if(!th)return;
const i=th.cellIndex,down=th.getAttribute("aria-sort")==="ascending",key=r=>r.cells[i].dataset.v??r.cells[i].textContent,
rows=[...table.tBodies[0].rows].sort((a,b)=>{const x=key(a),y=key(b),d=Number(x)-Number(y);return (isNaN(d)?x.localeCompare(y):d)*(down?-1:1)});
for(const h of table.tHead.rows[0].cells)h.removeAttribute("aria-sort");th.setAttribute("aria-sort",down?"descending":"ascending");
table.tBodies[0].append(...rows)});
for(const cell of document.querySelectorAll("[data-key]")){const t=(window.TIMINGS||{})[cell.dataset.key];if(t){cell.textContent=t.toFixed(1);cell.dataset.v=t}}
</script></body></html>
"""


def wilson(good, n, z=1.96):
    """Wilson's score interval of a proportion (1927), 95 %."""
    if n == 0:
        return 0.0, 1.0
    p, zz = good / n, z * z
    middle, half = (p + zz / (2 * n)) / (1 + zz / n), z / (1 + zz / n) * math.sqrt(
        p * (1 - p) / n + zz / (4 * n * n)
    )
    return max(0.0, middle - half), min(1.0, middle + half)


def sureness(best, second=None):
    """How likely the best size has the larger margin, from the uncertainties of both, taken as
    standard deviations of independent normal errors. A body that is measured wrong moves both
    margins alike, so it is more likely than that where one girth decides both. None: there is no
    other.
    """
    if second is None:
        return None
    spread = math.hypot(
        best.get("margin_uncertainty_cm") or 0, second.get("margin_uncertainty_cm") or 0
    )
    return 0.5 * (
        1 + math.erf((best["margin_cm"] - second["margin_cm"]) / max(spread, 1e-9) / math.sqrt(2))
    )


def best_sizes(statuses):
    """(garment, scan) -> (size, margin, girth, runner-up, sureness): the dressed size whose least
    margin is largest."""
    groups = {}
    for s in statuses:
        if s["size"]:
            groups.setdefault((s["garment"], s["scan"]), []).append(s)
    best = {}
    for group, members in groups.items():
        fitting = sorted(
            (s for s in members if s["dressed"] and s.get("fits")),
            key=lambda s: (-s["margin_cm"], s["size"]),
        )
        if fitting:
            best[group] = (
                fitting[0]["size"],
                fitting[0]["margin_cm"],
                fitting[0]["margin_at"],
                fitting[1]["size"] if len(fitting) > 1 else "",
                sureness(*fitting[:2]),
            )
        else:
            best[group] = ("", None, "", "", None)
    return best


def counted(n, word):
    return f"{n} {word}" + ("" if n == 1 else "s")


def css_class(cause):
    return "ok" if cause in GOOD else "no" if cause in REFUSED else "bad"


def badness(status):
    """Worst first: failures, refusals, then by margin."""
    order = {"ok": 2, "no": 1, "bad": 0}[css_class(status["cause"])]
    return (
        order,
        status.get("margin_cm") if status.get("margin_cm") is not None else -1e9,
        status["name"],
    )


def spoken_girth(girth):
    """ "navel" for "omphalion": as the fit pages call it."""
    name, side = girth, ""
    if girth[-2:] in ("_l", "_r"):
        name, side = girth[:-2], "left " if girth.endswith("_l") else "right "
    return side + SPOKEN.get(name, name.replace("_", " "))


def heat_colour(percent):
    """Red where it is too tight, white at none, blue where it is wide."""
    if percent < 0:
        strength = min(1.0, -percent / 15)
        return f"rgb(255,{round(255 - 150 * strength)},{round(255 - 165 * strength)})"
    strength = min(1.0, percent / 40)
    return f"rgb({round(255 - 150 * strength)},{round(255 - 95 * strength)},255)"


def heat_map(garment, statuses):
    girths = {}
    for s in statuses:
        for name in s.get("ease_percent", {}):
            girths[name] = girths.get(name, 0) + 1
    names = sorted((n for n in girths if not n.endswith("_r")), key=lambda n: (-girths[n], n))
    text = (
        f"<h3>{html.escape(garment)}</h3><div class=wide><table class=heat><thead><tr><th></th>"
        + "".join(f"<th>{html.escape(spoken_girth(n))}</th>" for n in names)
        + "</tr></thead><tbody>"
    )
    for s in sorted(statuses, key=lambda s: s["scan"]):
        ease = s.get("ease_percent", {})
        text += f'<tr><td class="{css_class(s["cause"])}">{html.escape(s["scan"])}</td>'
        for n in names:
            text += (
                f'<td style="background:{heat_colour(ease[n])}">{ease[n]:.0f}</td>'
                if n in ease
                else "<td></td>"
            )
        text += "</tr>"
    return text + "</tbody></table></div>"


def read_status(plan, number):
    try:
        return planning.read_json(os.path.join(plan.folder(plan.key(number)), "status.json"))
    except FileNotFoundError:
        return None


class Totals:
    """What is summed up over a batch, one cell after the other in the order of their numbers."""

    def __init__(self, plan):
        self.causes = [None] * plan.cell_count  # the texts are shared
        self.names = {}
        self.garments, self.scans = set(), set()
        self.messages = {}  # of failed cells: cause -> message -> count
        self.failed = []  # the first NAMED: name, folder and cause

    def add(self, number, status):
        if css_class(status["cause"]) == "bad":
            if len(self.failed) < NAMED:
                self.failed.append((status["name"], f"cells/{status['place']}", status["cause"]))
            said = self.messages.setdefault(status["cause"], {})
            message = status.get("message", "")
            if message in said or len(said) < MESSAGES:
                said[message] = said.get(message, 0) + 1
        self.causes[number] = self.names.setdefault(status["cause"], status["cause"])
        self.garments.add(status["garment"] + status["size"])
        self.scans.add(status["scan"])

    def figures(self):
        """Counts; `rate` is dressed of those that the fit does not refuse."""
        count = {}
        for cause in self.causes:
            if cause is not None:
                count[cause] = count.get(cause, 0) + 1
        cells, dressed, refused = (
            sum(count.values()),
            sum(count.get(c, 0) for c in GOOD),
            sum(count.get(c, 0) for c in REFUSED),
        )
        failures = [c for c in count if css_class(c) == "bad"]
        commonest = min(failures, key=lambda c: (-count[c], c), default=None)
        said = self.messages.get(commonest, {})
        tried = cells - refused
        low, high = wilson(dressed, tried)
        return {
            "cells": cells,
            "dressed": dressed,
            "refused": refused,
            "tried": tried,
            "rate": dressed / tried if tried else None,
            "low": low,
            "high": high,
            "causes": count,
            "commonest": commonest,
            "message": min(said, key=lambda text: (-said[text], text), default=""),
            "failed": self.failed,
        }


def commonest_text(figures):
    """Of the failed cells: why most of them did, and what most of those said."""
    cause = figures["commonest"]
    failed = figures["tried"] - figures["dressed"]
    text = f"most failures: {cause}, {figures['causes'][cause]} of {failed}"
    return text + (f"; {figures['message']}" if figures["message"] else "")


def failed_texts(figures):
    """A line for each of the first failed cells, and how many more there are."""
    lines = [f"failed: {name}: {cause}; see {folder}" for name, folder, cause in figures["failed"]]
    more = figures["tried"] - figures["dressed"] - len(lines)
    return lines + ([f"failed: {counted(more, 'cell')} more; see cells.csv"] if more else [])


def why_text(status):
    """The reason of a verdict and what the program warned of besides, or its last words."""
    reason = status.get("reason") or ("" if status["dressed"] else status.get("message", ""))
    texts = [reason] if reason else []
    return "; ".join(texts + status.get("warnings", []))


def cell_line(status):
    """A row of cells.csv: which folder holds which cell."""
    words = [status[key] for key in ("name", "garment", "size", "scan", "cause")]
    return words + [f"cells/{status['place']}", why_text(status)]


def worn_text(figures):
    """Of all cells, whatever they are refused for."""
    return f"{figures['dressed']} of {figures['cells']} can be worn"


def cause_text(cause, n):
    return "do not fit" if cause == "does not fit" and n != 1 else cause


def settings_text(settings):
    policy = settings.get("policy")
    text = f"mode {settings['mode']}, "
    text += f"fit policy {os.path.basename(policy)}" if policy else "the standard fit policy"
    return text + (", the nearest size" if settings.get("nearest_size") else "")


def figures_html(totals, figures, missing, settings):
    text = f"<h1>{counted(figures['cells'], 'cell')}: {counted(len(totals.garments), 'garment')} on {counted(len(totals.scans), 'scan')}</h1>\n"
    text += f"<p class=pale>{html.escape(settings_text(settings))}</p>\n<div class=figures>"
    text += f"<div><b>{worn_text(figures)}</b>dressed, of all cells made</div>"
    if figures["rate"] is not None:
        text += f"<div><b>{100 * figures['rate']:.1f} %</b>dressed of {figures['tried']} that may fit<br><span class=pale>95 %: {100 * figures['low']:.1f} to {100 * figures['high']:.1f} %</span></div>"
    for cause, n in sorted(figures["causes"].items(), key=lambda item: (-item[1], item[0])):
        text += (
            f'<div><b class="{css_class(cause)}">{n}</b>{html.escape(cause_text(cause, n))}</div>'
        )
    text += "</div>\n"
    if missing:
        text += (
            f"<p class=bad>{missing} cells are missing; start the batch again to make them.</p>\n"
        )
    return text


CELLS_HEAD = '<div class=wide><table class=sorts><thead><tr><th>garment<th>size<th>scan<th>outcome<th>margin cm<th title="probability that it fits">fits %<th>strain p99 %<th>CPU s<th>why</tr></thead><tbody>\n'


def why_html(s):
    why = html.escape(why_text(s))
    if css_class(s["cause"]) == "bad":
        return why + f' <a href="cells/{s["place"]}/failure.repro.tgz">failure bundle</a>'
    return why + (f' <a href="cells/{s["place"]}/fit.html">fit</a>' if "margin_cm" in s else "")


def row_html(s):
    margin = (
        f'<td class=n data-v="{s["margin_cm"]:.3f}">{s["margin_cm"]:.1f}</td>'
        if s.get("margin_cm") is not None
        else '<td data-v="-999"></td>'
    )
    chance = (
        f'<td class=n>{100 * s["probability"]:.0f}</td>'
        if s.get("probability") is not None
        else "<td></td>"
    )
    strain = (
        f'<td class=n data-v="{s["strain_p99"]:.4f}">{100 * s["strain_p99"]:.1f}</td>'
        if s.get("strain_p99") is not None
        else "<td></td>"
    )
    return (
        f'<tr><td>{html.escape(s["garment"])}<td>{html.escape(s["size"])}<td>{html.escape(s["scan"])}<td class="{css_class(s["cause"])}">{html.escape(s["cause"])}</td>'
        f'{margin}{chance}{strain}<td class=n data-key="{s["key"]}"></td><td class=words>{why_html(s)}</td></tr>\n'
    )


def best_row_html(garment, scan, best):
    size, margin, at, second, sure = best
    return (
        f"<tr><td>{html.escape(garment)}<td>{html.escape(scan)}<td>"
        + (html.escape(size) if size else "<span class=no>none fits</span>")
        + (f"<td class=n>{margin:.1f}" if margin is not None else "<td>")
        + f"<td>{html.escape(spoken_girth(at))}<td>{html.escape(second)}"
        + (f"<td class=n>{100 * sure:.0f}" if sure is not None else "<td>")
        + "</tr>\n"
    )


def pictures_html(out, statuses):
    shown = [
        s
        for s in statuses
        if os.path.exists(os.path.join(out, "cells", s["place"], "thumbnail.png"))
    ]
    if not shown:
        return ""
    text = "\n<h2>Pictures, worst first</h2><div class=cells>\n"
    for s in shown:
        text += (
            f'<figure class="{css_class(s["cause"])}"><img loading=lazy width=240 height=360 alt="{html.escape(s["name"])}" src="cells/{s["place"]}/thumbnail.png">'
            f'<figcaption>{html.escape(s["name"])}<br><span class="{css_class(s["cause"])}">{html.escape(s["cause"])}</span></figcaption></figure>\n'
        )
    return text + "</div>\n"


class SmallPage:
    """Every cell on one page."""

    def __init__(self, plan):
        self.plan, self.listed = plan, []

    def add(self, status):
        self.listed.append(status)

    def body(self):
        listed = sorted(self.listed, key=badness)
        text = (
            "<h2>All cells, worst first</h2>"
            + CELLS_HEAD
            + "".join(map(row_html, listed))
            + "</tbody></table></div>\n"
        )
        best = best_sizes(listed)
        if best:
            text += '<h2>Best size</h2><div class=wide><table class=sorts><thead><tr><th>garment<th>scan<th>size<th>margin cm<th>least at<th>next best<th title="how likely it has the larger margin, by the uncertainties of both">sure %</tr></thead><tbody>\n'
            text += (
                "".join(
                    best_row_html(garment, scan, of) for (garment, scan), of in sorted(best.items())
                )
                + "</tbody></table></div>\n"
            )
        text += "<h2>Ease in % of the girth</h2>\n"
        groups = {}
        for s in listed:
            groups.setdefault(s["garment"] + ("@" + s["size"] if s["size"] else ""), []).append(s)
        text += "".join(heat_map(garment, members) for garment, members in sorted(groups.items()))
        return text + pictures_html(self.plan.out, listed) + '<script src="timings.js"></script>\n'


class Worst:
    """Orders a heap so that its first is the least bad."""

    def __init__(self, status):
        self.status, self.key = status, badness(status)

    def __lt__(self, other):
        return self.key > other.key


class LargePage:
    """Counts and quantiles on the page; rows in files of their own."""

    def __init__(self, plan):
        self.plan = plan
        self.folder = os.path.join(plan.out, "page")
        shutil.rmtree(self.folder, ignore_errors=True)
        os.makedirs(self.folder)
        self.worst, self.rows, self.files, self.of = [], {}, {}, {}
        self.scan, self.group, self.sizes = None, [], {}

    def add(self, s):
        name = s["garment"] + ("@" + s["size"] if s["size"] else "")
        heapq.heappush(self.worst, Worst(s))
        if len(self.worst) > WORST:
            heapq.heappop(self.worst)
        of = self.of.setdefault(
            name, {"causes": {}, "margin": array.array("f"), "ease": {}, "cpu_s": 0.0}
        )
        of["causes"][s["cause"]] = of["causes"].get(s["cause"], 0) + 1
        of["cpu_s"] += s.get("cpu_s") or 0
        if s.get("margin_cm") is not None:
            of["margin"].append(s["margin_cm"])
        for girth, percent in s.get("ease_percent", {}).items():
            if not girth.endswith("_r"):
                of["ease"].setdefault(girth, array.array("f")).append(percent)
        self.row(
            name,
            row_html(s).replace(
                f'data-key="{s["key"]}">',
                f'data-v="{s["cpu_s"]}">{s["cpu_s"]:.1f}' if s.get("cpu_s") is not None else ">",
            ),
        )
        if s["size"]:
            if s["scan"] != self.scan:
                self.end_scan()
                self.scan = s["scan"]
            self.group.append(s)

    def end_scan(self):
        for (garment, scan), best in sorted(best_sizes(self.group).items()):
            counts = self.sizes.setdefault(garment, {})
            counts[best[0]] = counts.get(best[0], 0) + 1
            self.row(f"best size of {garment}", best_row_html(garment, scan, best))
        self.group = []

    def row(self, table, text):
        rows = self.rows.setdefault(table, [])
        rows.append(text)
        if len(rows) == ROWS:
            self.flush(table)

    def flush(self, table):
        if not self.rows.get(table):
            return
        index, parts = self.files.setdefault(table, (len(self.files), []))
        name = f"{index}.{len(parts)}.js"
        parts.append(len(self.rows[table]))
        planning.write_text(
            os.path.join(self.folder, name), f"rows({json.dumps(''.join(self.rows[table]))})\n"
        )
        self.rows[table] = []

    def table_html(self, table):
        index, parts = self.files[table]
        return f'<button data-table="{index}" data-parts="{len(parts)}">{counted(sum(parts), "row")}</button>'

    def body(self):
        self.end_scan()
        for table in list(self.rows):
            self.flush(table)
        text = "<h2>Garments</h2><div class=wide><table class=sorts><thead><tr><th>garment<th>cells<th>dressed %<th>refused %<th>failed %<th>margin cm: 10 %<th>half<th>90 %<th>CPU s, mean<th>cells</tr></thead><tbody>\n"
        for name, of in sorted(self.of.items()):
            n = sum(of["causes"].values())
            shares = [
                100 * sum(k for c, k in of["causes"].items() if css_class(c) == kind) / n
                for kind in ("ok", "no", "bad")
            ]
            text += (
                f"<tr><td>{html.escape(name)}<td class=n>{n}"
                + "".join(f"<td class=n>{v:.1f}" for v in shares)
                + "".join(f"<td class=n>{v}" for v in quantiles(of["margin"], "{:.1f}"))
                + f"<td class=n>{of['cpu_s'] / n:.1f}<td>{self.table_html(name)}</tr>\n"
            )
        text += "</tbody></table></div>\n<div id=rows></div>\n"
        if self.sizes:
            text += "<h2>Best size</h2><div class=wide><table class=sorts><thead><tr><th>garment<th>size<th>scans<th>%<th>scans</tr></thead><tbody>\n"
            for garment, counts in sorted(self.sizes.items()):
                for size, n in sorted(counts.items()):
                    shown = html.escape(size) if size else "<span class=no>none fits</span>"
                    text += f"<tr><td>{html.escape(garment)}<td>{shown}<td class=n>{n}<td class=n>{100 * n / sum(counts.values()):.1f}<td>{self.table_html(f'best size of {garment}')}</tr>\n"
            text += "</tbody></table></div>\n"
        text += "<h2>Ease in % of the girth: 10 %, half and 90 % of the scans</h2><div class=wide><table class=sorts><thead><tr><th>garment<th>girth<th>scans<th>10 %<th>half<th>90 %</tr></thead><tbody>\n"
        for name, of in sorted(self.of.items()):
            for girth, values in sorted(of["ease"].items()):
                text += (
                    f"<tr><td>{html.escape(name)}<td>{html.escape(spoken_girth(girth))}<td "
                    f"class=n>{len(values)}"
                    + "".join(
                        f'<td class=n style="background:{heat_colour(float(v))}">{v}'
                        for v in quantiles(values, "{:.0f}")
                    )
                    + "</tr>\n"
                )
        worst = sorted((w.status for w in self.worst), key=badness)
        text += (
            f"</tbody></table></div>\n<h2>The worst {len(worst)} cells</h2>"
            + CELLS_HEAD
            + "".join(map(row_html, worst))
            + "</tbody></table></div>\n"
        )
        timings = json.dumps({s["key"]: s["cpu_s"] for s in worst if s.get("cpu_s") is not None})
        return (
            text
            + pictures_html(self.plan.out, worst[:PICTURES])
            + f"<script>window.TIMINGS={timings}</script>\n"
            + ON_DEMAND
        )


ON_DEMAND = """<script>
const place=document.getElementById("rows"),loaded=[];window.rows=text=>loaded.push(text);
const head="<tr><th>garment<th>size<th>scan<th>outcome<th>margin cm<th>fits %<th>strain p99 %<th>CPU s<th>why</tr>",bestHead="<tr><th>garment<th>scan<th>size<th>margin cm<th>least at<th>next best<th>sure %</tr>";
function show(index,part,parts){const s=document.createElement("script");loaded.length=0;s.src=`page/${index}.${part}.js`;s.onload=()=>{
const wide=loaded[0].split("</tr>")[0].split("<td").length>8;
place.innerHTML=`<h2>Rows ${part+1} of ${parts}</h2><p>${part>0?"<button id=back>back</button> ":""}${part+1<parts?"<button id=on>on</button>":""}</p><div class=wide><table><thead>${wide?head:bestHead}</thead><tbody>${loaded[0]}</tbody></table></div>`;
const b=document.getElementById("back"),o=document.getElementById("on");if(b)b.onclick=()=>show(index,part-1,parts);if(o)o.onclick=()=>show(index,part+1,parts);place.scrollIntoView();s.remove()};
document.body.append(s)}
document.addEventListener("click",e=>{const b=e.target.closest("[data-table]");if(b)show(b.dataset.table,0,Number(b.dataset.parts))});
</script>
"""


def quantiles(values, shape):
    """10, 50 and 90 % as texts; empty ones where there is no value."""
    if not values:
        return [""] * 3
    ordered = sorted(values)
    return [shape.format(ordered[round(q * (len(ordered) - 1))]) for q in (0.1, 0.5, 0.9)]


def summarise(plan):
    """Reads what each cell says, once; writes manifest.json, population.html, cells.csv,
    timings.csv and timings.js. Returns (figures, count of missing cells)."""
    out = plan.out
    small = plan.cell_count <= SMALL
    totals, page = Totals(plan), (SmallPage if small else LargePage)(plan)
    seconds = {}
    timings = os.path.join(out, "timings.csv")
    temporary = f"{timings}.{os.getpid()}.tmp"
    index = os.path.join(out, "cells.csv")
    index_temporary = f"{index}.{os.getpid()}.tmp"
    with open(temporary, "w") as file, open(index_temporary, "w", newline="") as rows:
        cells = csv.writer(rows, lineterminator="\n")
        cells.writerow(("cell", "garment", "size", "scan", "outcome", "folder", "why"))
        file.write("cell,cause,cpu_s,wall_s,peak_mb,steps,host\n")
        for number in range(plan.cell_count):
            status = read_status(plan, number)
            if status is None:
                continue
            status["key"] = plan.key(number)
            status["place"] = plan.place(status["key"])
            try:
                t = planning.read_json(os.path.join(out, "timings", status["place"], "timing.json"))
                status["cpu_s"] = t["cpu_s"]
                file.write(
                    f'"{t["name"]}",{t["cause"]},{t["cpu_s"]},{t["wall_s"]},{t["peak_mb"]},{t["steps"] or ""},{t["host"]}\n'
                )
                if small:
                    seconds[status["key"]] = t["cpu_s"]
            except (OSError, ValueError):
                pass
            totals.add(number, status)
            page.add(status)
            cells.writerow(cell_line(status))
    os.replace(temporary, timings)
    os.replace(index_temporary, index)
    planning.write_text(
        os.path.join(out, "timings.js"), "window.TIMINGS=" + json.dumps(seconds) + ";\n"
    )
    planning.write_manifest(os.path.join(out, "manifest.json"), plan, totals.causes)
    figures = totals.figures()
    missing = plan.cell_count - figures["cells"]
    planning.write_text(
        os.path.join(out, "population.html"),
        HEAD + figures_html(totals, figures, missing, plan.settings) + page.body() + SCRIPT,
    )
    return figures, missing
