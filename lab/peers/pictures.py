"""Pictures of the results of `run`: time against error, a panel for each case, the fastest of each program as a line.

    python3 pictures.py RESULTS.json PICTURE.svg
"""

import json
import math
import sys
from pathlib import Path

COLOURS = {"lie-poisson": "#c0392b", "lie-poisson, --fma": "#e8958c", "heyoka": "#2c5f8a", "Boost.odeint": "#3d8b57", "ode_solvers": "#b8860b",
           "differential-equations": "#7d5ba6", "diffsol": "#777777", "SciPy": "#a0a0a0"}
WIDTH, HEIGHT, LEFT, TOP, RIGHT, BOTTOM = 380, 300, 62, 34, 14, 40


def frontier(rows):
    """Error and time of the rows that no other beats in both, from loose to tight."""
    best, points = math.inf, []
    for row in sorted(rows, key=lambda row: row["error"]):
        if row["seconds"] < best:
            best = row["seconds"]
            points.append((max(row["error"], 1e-15), best))
    return points[::-1]


def panel(name, case, left, top):
    rows = [row for row in case["rows"] if not row["method"].startswith("exact") and row["error"] < 0.1]
    lines = {peer: frontier([row for row in rows if row["peer"] == peer])
             for peer in COLOURS if any(row["peer"] == peer for row in rows)}
    times = [time * 1e6 for points in lines.values() for _, time in points]
    low, high = math.floor(math.log10(min(times))), math.ceil(math.log10(max(times)))
    inner = WIDTH - LEFT - RIGHT, HEIGHT - TOP - BOTTOM
    across = lambda error: left + LEFT + inner[0] * (-1 - math.log10(error)) / 13.5
    down = lambda time: top + TOP + inner[1] * (high - math.log10(time * 1e6)) / (high - low)
    parts = [f'<text x="{left + LEFT}" y="{top + 20}" font-weight="bold">{name}: {case["title"]}</text>']
    parts.append(f'<text x="{left + LEFT - 6}" y="{top + 20}" text-anchor="end">µs</text>')
    parts.append(f'<text x="{left + WIDTH - RIGHT}" y="{top + HEIGHT - BOTTOM + 30}" text-anchor="end">error</text>')
    for power in range(low, high + 1):
        y = down(10.0 ** (power - 6))
        parts.append(f'<line x1="{left + LEFT}" x2="{left + WIDTH - RIGHT}" y1="{y:.1f}" y2="{y:.1f}" stroke="#ddd"/>')
        parts.append(f'<text x="{left + LEFT - 6}" y="{y + 4:.1f}" text-anchor="end">{10.0 ** power:,.10g}</text>')
    for power in (-3, -6, -9, -12):
        x = across(10.0 ** power)
        parts.append(f'<line x1="{x:.1f}" x2="{x:.1f}" y1="{top + TOP}" y2="{top + HEIGHT - BOTTOM}" stroke="#ddd"/>')
        parts.append(f'<text x="{x:.1f}" y="{top + HEIGHT - BOTTOM + 16}" text-anchor="middle">1e{power}</text>')
    for peer, points in lines.items():
        path = " ".join(f"{across(error):.1f},{down(time):.1f}" for error, time in points)
        width = 2.5 if peer == "lie-poisson" else 1.5
        parts.append(f'<polyline points="{path}" fill="none" stroke="{COLOURS[peer]}" stroke-width="{width}"/>')
        parts += [f'<circle cx="{across(error):.1f}" cy="{down(time):.1f}" r="2" fill="{COLOURS[peer]}"/>'
                  for error, time in points]
    return parts


def picture(results):
    cases = results["cases"]
    columns = 2
    height = HEIGHT * math.ceil(len(cases) / columns) + 80
    parts = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {columns * WIDTH} {height}" '
             f'font-family="sans-serif" font-size="11">', '<rect width="100%" height="100%" fill="white"/>']
    for index, (name, case) in enumerate(cases.items()):
        parts += panel(name, case, index % columns * WIDTH, index // columns * HEIGHT)
    for place, (peer, colour) in enumerate(COLOURS.items()):
        x, y = 20 + 180 * (place % 4), height - 40 + 20 * (place // 4)
        parts.append(f'<line x1="{x}" x2="{x + 18}" y1="{y - 4}" y2="{y - 4}" stroke="{colour}" stroke-width="2.5"/>')
        parts.append(f'<text x="{x + 23}" y="{y}">{peer}</text>')
    parts.append(f'<text x="20" y="{height - 60}">Microseconds of one run against the error at its end, both logarithmic; '
                 'the fastest settings of each program</text>')
    return "\n".join(parts + ["</svg>"]) + "\n"


if __name__ == "__main__":
    Path(sys.argv[2]).write_text(picture(json.loads(Path(sys.argv[1]).read_text())))
