"""Tables of the results of `run`.

    python3 tables.py RESULTS.json [--page ../docs/peers.md]
"""

import argparse
import json
import re
from pathlib import Path

OURS = "lie-poisson"
FUSED = "lie-poisson, --fma"
"""The same program with multiplications and additions contracted, as g++ and heyoka contract them."""

PYTHON = "lie-poisson from Python"
"""`System.run` of the installed package: one call for each run, with a row for each step."""

PICKED = "gauss16"
"""What `--tol` picks."""


def picked(rows, ending=""):
    """What `--tol` picks, its iteration by default to round-off."""
    for row in rows:
        if row["by"] == "tolerance" and row["method"] == PICKED + ending:
            yield row


def stopped(rows):
    """The same, its iteration as exact as the tolerance asks."""
    return picked(rows, ", converge tolerance")


def integrates(row):
    """The closed form is no integrator."""
    return not row["method"].startswith("exact")


def is_poisson(row):
    """A Poisson map to round-off."""
    return row["method"].endswith("converge map") or row["method"].startswith("splitting")


def fastest(rows, target):
    good = [row for row in rows if row["error"] <= target]
    return min(good, key=lambda row: row["seconds"], default=None)


def microseconds(seconds):
    value = seconds * 1e6
    return f"{value:.2g}" if value < 1 else f"{value:.3g}" if value < 1000 else f"{value:,.0f}"


def short(target):
    return f"{target:.0e}".replace("e-0", "e-")


def cell(row, base):
    if row is None:
        return "–"
    ratio = row["seconds"] / base["seconds"] if base else float("nan")
    return f"{microseconds(row['seconds'])} ({ratio:.2f})"


def table(case, targets):
    """Microseconds and, in brackets, the ratio to heyoka, else to our fastest."""
    rows = case["rows"]
    heyoka = [row for row in rows if row["peer"] == "heyoka"]
    ours = [row for row in rows if row["peer"] == OURS]
    base = [fastest(heyoka or ours, target) for target in targets]
    lines = []

    def line(name, chosen, mark=""):
        found = [fastest(chosen, target) for target in targets]
        if any(found):
            cells = " | ".join(cell(row, b) for row, b in zip(found, base))
            lines.append((name, f"| {mark}{name}{mark} | {cells} |"))

    line("lie-poisson, the fastest", [row for row in ours if integrates(row)], "**")
    line("lie-poisson, `--tol` alone", list(picked(ours)), "**")
    line("lie-poisson, `--tol` and `--converge tolerance`", list(stopped(ours)), "**")
    called = [row for row in rows if row["peer"] == PYTHON]
    for name in sorted({row["method"] for row in called}):
        line(f"from Python, `{name}`", [row for row in called if row["method"] == name], "**")
    fused = [row for row in rows if row["peer"] == FUSED and integrates(row)]
    line("lie-poisson with `--fma`, the fastest", fused, "**")
    line("lie-poisson, the fastest Poisson map", [row for row in ours if is_poisson(row)], "**")
    line("lie-poisson with `--fma`, the fastest Poisson map", [row for row in fused if is_poisson(row)], "**")
    peers = sorted({row["peer"] for row in rows} - {OURS, FUSED, PYTHON})
    for peer in peers:
        line(peer, [row for row in rows if row["peer"] == peer])
    for name in sorted({(row["method"], row["by"]) for row in ours}):
        chosen = [row for row in ours if (row["method"], row["by"]) == name]
        line(f"`{name[0]}`" + (" by `--tol`" if name[1] == "tolerance" else ""), chosen)
    head = " | ".join(short(target) for target in targets)
    rule = "---|" * (len(targets) + 1)
    return "\n".join([f"| microseconds to an error of | {head} |", f"|{rule}"] + [text for _, text in lines])


CRATES = ("ode_solvers", "differential-equations", "diffsol")


def summary(results):
    """How many times longer others take than lie-poisson, and than it by `--tol` alone and as a Poisson map to round-off."""
    lines = ["| case | error | lie-poisson, µs | heyoka | Boost.odeint | the best of three crates | SciPy | heyoka to `--tol` alone | "
             "heyoka to `--tol` and `--converge tolerance` | heyoka to a Poisson map to round-off | heyoka to `--fma` | "
             "heyoka to a Poisson map with `--fma` | heyoka to Python's `run(tol=)` | heyoka to the same with `converge=\"tolerance\"` |",
             "|" + "---|" * 14]
    for name, case in results["cases"].items():
        rows = case["rows"]
        ours = [row for row in rows if row["peer"] == OURS and integrates(row)]
        of = lambda *peers: [row for row in rows if row["peer"] in peers]
        called = lambda name: [row for row in of(PYTHON) if row["method"] == name]
        poisson = [row for row in ours if is_poisson(row)]
        fused = [row for row in of(FUSED) if integrates(row)]
        for target in case["targets"]:
            best, heyoka = fastest(ours, target), of("heyoka")
            if best is None:
                continue

            def times(others, mine):
                other, own = fastest(others, target), fastest(mine, target)
                if not (other and own):
                    return "–"
                ratio = other["seconds"] / own["seconds"]
                return f"{ratio:.2g}" if ratio < 100 else f"{round(ratio, -1):.0f}"

            cells = [times(heyoka, ours), times(of("Boost.odeint"), ours), times(of(*CRATES), ours),
                     times(of("SciPy"), ours), times(heyoka, list(picked(ours))), times(heyoka, list(stopped(ours))),
                     times(heyoka, poisson), times(heyoka, fused), times(heyoka, [row for row in fused if is_poisson(row)]),
                     times(heyoka, called("run(tol=)")), times(heyoka, called("run(tol=, converge=\"tolerance\")"))]
            lines.append(f"| {name} | {short(target)} | {microseconds(best['seconds'])} `{best['method']}` | "
                         + " | ".join(cells) + " |")
    return "\n".join(lines)


def settings(case, targets):
    """How the fastest of each peer came about."""
    lines = ["| error | who | method | setting | steps | error | energy | Casimirs | spread |", "|" + "---|" * 9]
    for target in targets:
        for peer in sorted({row["peer"] for row in case["rows"]}, key=lambda p: (p not in (OURS, FUSED, PYTHON), p)):
            row = fastest([row for row in case["rows"] if row["peer"] == peer and integrates(row)], target)
            if row:
                drift = row["drift"] or [None, None]
                energy, casimirs = (f"{value:.0e}" if value is not None else "" for value in drift)
                lines.append(f"| {short(target)} | {peer} | {row['method']} | {row['setting']} | {row['steps']} | "
                             f"{row['error']:.1e} | {energy} | {casimirs} | {row['spread']:.2f} |")
    return "\n".join(lines)


def markdown(results):
    parts = [head(results), summary(results) + "\n"]
    for name, case in results["cases"].items():
        parts.append(f"## {name}: {case['title']}, to t = {case['until']:g}\n\n{table(case, case['targets'])}\n\n"
                     f"{settings(case, case['targets'])}\n")
    return "\n".join(parts)


def head(results):
    machine = results["machine"]
    return (f"{machine['processor']}, {machine['rustc']}, {machine['compiler']}; {results['rounds']} rounds, "
            f"{results['minutes']:.0f} minutes\n")


def into_page(page, results):
    """Puts each table between the marks of its place."""
    text = page.read_text()
    blocks = {"machine": head(results).strip(), "summary": summary(results)}
    for name, case in results["cases"].items():
        blocks[f"table {name}"] = table(case, case["targets"])
        blocks[f"settings {name}"] = settings(case, case["targets"])
    for name, block in blocks.items():
        mark = re.escape(f"<!-- {name} -->")
        text = re.sub(rf"({mark}\n).*?(<!-- end -->)", lambda found: f"{found[1]}\n{block}\n\n{found[2]}", text, flags=re.S)
    page.write_text(text)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("results")
    parser.add_argument("--page")
    options = parser.parse_args()
    results = json.loads(Path(options.results).read_text())
    if options.page:
        into_page(Path(options.page), results)
    else:
        print(markdown(results))


if __name__ == "__main__":
    main()
