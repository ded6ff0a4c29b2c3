"""The population page: how many are dressed, how they fit, the worst first. One HTML file and the cells' pictures; no network."""
import html
import json
import math
import os

from . import plan as planning

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
    middle, half = (p + zz / (2 * n)) / (1 + zz / n), z / (1 + zz / n) * math.sqrt(p * (1 - p) / n + zz / (4 * n * n))
    return max(0.0, middle - half), min(1.0, middle + half)


def summary(statuses):
    """Counts; `rate` is dressed of those that the fit does not refuse."""
    count = {}
    for status in statuses:
        count[status["cause"]] = count.get(status["cause"], 0) + 1
    dressed, refused = sum(count.get(c, 0) for c in GOOD), sum(count.get(c, 0) for c in REFUSED)
    tried = len(statuses) - refused
    low, high = wilson(dressed, tried)
    return {"cells": len(statuses), "dressed": dressed, "refused": refused, "tried": tried, "rate": dressed / tried if tried else None, "low": low, "high": high, "causes": count}


def best_sizes(statuses):
    """(garment, scan) -> (size, margin, runner-up): the dressed size whose least margin is largest."""
    groups = {}
    for s in statuses:
        if s["size"]:
            groups.setdefault((s["garment"], s["scan"]), []).append(s)
    best = {}
    for group, members in groups.items():
        fitting = sorted((s for s in members if s["dressed"] and s.get("fits")), key=lambda s: (-s["margin_cm"], s["size"]))
        if fitting:
            best[group] = (fitting[0]["size"], fitting[0]["margin_cm"], fitting[0]["margin_at"], fitting[1]["size"] if len(fitting) > 1 else "")
        else:
            best[group] = ("", None, "", "")
    return best


def counted(n, word):
    return f"{n} {word}" + ("" if n == 1 else "s")


def css_class(cause):
    return "ok" if cause in GOOD else "no" if cause in REFUSED else "bad"


def badness(status):
    """Worst first: failures, refusals, then by margin."""
    order = {"ok": 2, "no": 1, "bad": 0}[css_class(status["cause"])]
    return order, status.get("margin_cm") if status.get("margin_cm") is not None else -1e9, status["name"]


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
    text = f"<h3>{html.escape(garment)}</h3><div class=wide><table class=heat><thead><tr><th></th>" + "".join(f"<th>{html.escape(n.replace('_', ' '))}</th>" for n in names) + "</tr></thead><tbody>"
    for s in sorted(statuses, key=lambda s: s["scan"]):
        ease = s.get("ease_percent", {})
        text += f'<tr><td class="{css_class(s["cause"])}">{html.escape(s["scan"])}</td>'
        for n in names:
            text += f'<td style="background:{heat_colour(ease[n])}">{ease[n]:.0f}</td>' if n in ease else "<td></td>"
        text += "</tr>"
    return text + "</tbody></table></div>"


def write_page(out, plan, statuses):
    """population.html in `out`; statuses by key."""
    listed = [dict(statuses[key], key=key) for key in plan["cells"] if key in statuses]
    figures = summary(listed)
    page = HEAD + f"<h1>{counted(figures['cells'], 'cell')}: {counted(len({s['garment'] + s['size'] for s in listed}), 'garment')} on {counted(len({s['scan'] for s in listed}), 'scan')}</h1>\n<div class=figures>"
    if figures["rate"] is not None:
        page += f"<div><b class=ok>{100 * figures['rate']:.1f} %</b>dressed of {figures['tried']} that may fit<br><span class=pale>95 %: {100 * figures['low']:.1f} to {100 * figures['high']:.1f} %</span></div>"
    for cause, n in sorted(figures["causes"].items(), key=lambda item: (-item[1], item[0])):
        page += f'<div><b class="{css_class(cause)}">{n}</b>{html.escape(cause)}</div>'
    page += "</div>\n"
    missing = len(plan["cells"]) - len(listed)
    if missing:
        page += f'<p class=bad>{missing} cells are missing; start the batch again to make them.</p>\n'
    listed.sort(key=badness)
    page += "<h2>All cells, worst first</h2><div class=wide><table class=sorts><thead><tr><th>garment<th>size<th>scan<th>outcome<th>margin cm<th>strain p99 %<th>CPU s<th>why</tr></thead><tbody>\n"
    for s in listed:
        margin = f'<td class=n data-v="{s["margin_cm"]:.3f}">{s["margin_cm"]:.1f}</td>' if s.get("margin_cm") is not None else '<td data-v="-999"></td>'
        strain = f'<td class=n data-v="{s["strain_p99"]:.4f}">{100 * s["strain_p99"]:.1f}</td>' if s.get("strain_p99") is not None else "<td></td>"
        why = html.escape(s.get("reason") or (s.get("message", "") if not s["dressed"] else ""))
        if css_class(s["cause"]) == "bad":
            why += f' <a href="cells/{s["key"]}/failure.repro.tgz">failure bundle</a>'
        elif "margin_cm" in s:
            why += f' <a href="cells/{s["key"]}/fit.html">fit</a>'
        page += (f'<tr><td>{html.escape(s["garment"])}<td>{html.escape(s["size"])}<td>{html.escape(s["scan"])}<td class="{css_class(s["cause"])}">{html.escape(s["cause"])}</td>'
                 f'{margin}{strain}<td class=n data-key="{s["key"]}"></td><td class=words>{why}</td></tr>\n')
    page += "</tbody></table></div>\n"
    best = best_sizes(listed)
    if best:
        page += "<h2>Best size</h2><div class=wide><table class=sorts><thead><tr><th>garment<th>scan<th>size<th>margin cm<th>least at<th>next best</tr></thead><tbody>\n"
        for (garment, scan), (size, margin, at, second) in sorted(best.items()):
            page += (f"<tr><td>{html.escape(garment)}<td>{html.escape(scan)}<td>" + (html.escape(size) if size else "<span class=no>none fits</span>")
                     + (f'<td class=n>{margin:.1f}' if margin is not None else "<td>") + f"<td>{html.escape(at.replace('_', ' '))}<td>{html.escape(second)}</tr>\n")
        page += "</tbody></table></div>\n"
    page += "<h2>Ease in % of the girth</h2>\n"
    groups = {}
    for s in listed:
        groups.setdefault(s["garment"] + ("@" + s["size"] if s["size"] else ""), []).append(s)
    for garment, members in sorted(groups.items()):
        page += heat_map(garment, members)
    shown = [s for s in listed if os.path.exists(os.path.join(out, "cells", s["key"], "thumbnail.png"))]
    if shown:
        page += "\n<h2>Pictures, worst first</h2><div class=cells>\n"
        for s in shown:
            page += (f'<figure class="{css_class(s["cause"])}"><img loading=lazy width=240 height=360 alt="{html.escape(s["name"])}" src="cells/{s["key"]}/thumbnail.png">'
                     f'<figcaption>{html.escape(s["name"])}<br><span class="{css_class(s["cause"])}">{html.escape(s["cause"])}</span></figcaption></figure>\n')
        page += "</div>\n"
    page += '<script src="timings.js"></script>\n' + SCRIPT
    temporary = os.path.join(out, f"population.html.{os.getpid()}.tmp")
    with open(temporary, "w") as file:
        file.write(page)
    os.replace(temporary, os.path.join(out, "population.html"))
    return figures


def write_timings(out, plan):
    """timings.csv and timings.js, which differ from run to run, and the seconds of the cells by key."""
    seconds, lines = {}, ["cell,cause,cpu_s,wall_s,peak_mb,steps,host"]
    for key in sorted(plan["cells"], key=lambda k: plan["cells"][k]["name"]):
        try:
            t = planning.read_json(os.path.join(out, "timings", key, "timing.json"))
        except (OSError, ValueError):
            continue
        seconds[key] = t["cpu_s"]
        lines.append(f'"{t["name"]}",{t["cause"]},{t["cpu_s"]},{t["wall_s"]},{t["peak_mb"]},{t["steps"] or ""},{t["host"]}')
    for name, text in (("timings.csv", "\n".join(lines) + "\n"), ("timings.js", "window.TIMINGS=" + json.dumps(seconds) + ";\n")):
        temporary = os.path.join(out, f"{name}.{os.getpid()}.tmp")
        with open(temporary, "w") as file:
            file.write(text)
        os.replace(temporary, os.path.join(out, name))
    return seconds
