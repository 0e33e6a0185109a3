"""Random declarations, methods drawn for each, and a judge that shares nothing with the compiler.

    python lab/audit/audit.py [--seed 2026] [--systems 200] [--methods 20] [--only INDEX] [--control]

Needs the package `liepoisson`, numpy, SciPy and mpmath. Exit code 1 if a run is wrong. Of each pair of system and method:

  * the state at the end against the judge: its error falls with the step as fast as the order says, or is as small as the judge knows;
  * the energy of each row against the declaration's, evaluated by the judge;
  * what the method says that it keeps, to round-off.

With `--control` the judge's structure constants are off by one part in a million, so that every motion which the error of a method does not hide is wrong.
"""

import argparse
import random
import sys
from fractions import Fraction

import judge
import liepoisson
import numpy as np
import systems

UNTIL = 4.0
STEPS = [1 / 16, 1 / 32, 1 / 64, 1 / 128, 1 / 256, 1 / 512]
# A slope may be so much below the order before round-off is reached.
SLACK = 1.0
# What is lost of an invariant by solving to round-off, of its size and for each step.
ROUND_OFF = 4e-15


class Pair:
    """A system and a method."""

    def __init__(self, drawn, system, row, truth, doubt, casimirs):
        self.drawn, self.system, self.row = drawn, system, row
        self.truth, self.doubt, self.casimirs = truth, doubt, casimirs

    def run(self, step):
        return self.system.run(name(self.row), h=step, at=[0.0, UNTIL])

    def look(self):
        """What is wrong, or nothing; how many runs there were; whether it could be judged."""
        errors = []
        for step in STEPS:
            try:
                found = self.run(step)
            except liepoisson.IntegrationError:
                # a step that the method cannot take, which it says
                errors.append(None)
                continue
            wrong = self.kept(found, round(UNTIL / step))
            if wrong:
                return f"h = {step}: {wrong}", len(errors) + 1
            errors.append(float(np.abs(found.mu[-1] - self.truth).max()))
            if self.small(errors):
                return None, len(errors)
        if all(error is None for error in errors):
            return None, -len(errors)
        return f"errors {errors}, order {self.row.order}", len(errors)

    def small(self, errors):
        error = errors[-1]
        if error <= self.doubt:
            return True
        if len(errors) < 2 or errors[-2] is None:
            return False
        slope = np.log2(errors[-2] / error)
        return error < 0.2 and slope >= self.row.order - SLACK

    def kept(self, found, steps):
        preserves, mu = self.row.preserves, found.mu
        energies = [self.energy(t, row) for t, row in zip(found.t, mu)]
        scale = max(1.0, np.abs(mu).max())
        off = float(np.abs(np.array(energies) - found.energy).max())
        if off > 1e-13 * scale**4:
            return f"the energy of a row is off by {off:.1e}"
        bound = ROUND_OFF * (steps + 10)
        if "energy" in preserves and not self.drawn.driven:
            lost = abs(energies[-1] - energies[0])
            if lost > bound * scale**2:
                return f"energy lost by {lost:.1e}"
        for casimir in self.casimirs:
            quadratic = casimir.degree is not None and casimir.degree <= 2
            if "casimirs" in preserves or "quadratic_casimirs" in preserves and quadratic:
                values = found.casimirs[casimir.name]
                lost = abs(values[-1] - values[0])
                if lost > bound * max(1.0, abs(values[0])) * scale**2:
                    return f"{casimir.name} lost by {lost:.1e}"
        return None

    def energy(self, t, mu):
        values = {key: (float(value), {}) for key, value in self.drawn.parameters.items()}
        values["t"] = (float(t), {})
        values |= {key: (float(x), {}) for key, x in zip(self.drawn.spec["state"], mu)}
        return self.drawn.hamiltonian.jet(values, judge.Floats)[0]


def name(row):
    """Compositions need a method."""
    return f"{row.id}(lie-midpoint)" if row.id.startswith("compose") else row.id


def off_by_a_millionth(drawn):
    return [[[c * (1 + Fraction(1, 10**6)) for c in row] for row in rows] for rows in drawn.constants]


def judged(drawn):
    """The state at the end, and what may be wrong with it; nothing where the motion is too wild to be judged."""
    truth = judge.end(drawn, UNTIL)
    if truth is None or not np.isfinite(truth).all() or np.abs(truth).max() > 50:
        return None, None
    doubt = 1e-11 * max(1.0, np.abs(truth).max())
    digits = judge.end_in_digits(drawn, UNTIL, steps=32) if len(truth) <= 4 else None
    if digits is not None and np.abs(truth - digits).max() > doubt / 4:
        return None, None
    return truth, doubt


def audit(seed, index, count, control):
    """Of one system: how many pairs, runs, refusals, and what is wrong."""
    rng = random.Random(f"{seed} {index}")
    drawn = systems.draw(rng, index)
    if control:
        drawn.constants = off_by_a_millionth(drawn)
    truth, doubt = judged(drawn)
    if truth is None:
        return drawn, None
    system = liepoisson.System(**drawn.spec)
    rows, casimirs = system.methods(), system.check().casimirs
    applies = sorted(key for key, row in rows.items() if row.applies and row.order > 0)
    pairs = runs = stopped = 0
    wrong = []
    for key in rng.sample(applies, min(count, len(applies))):
        found, made = Pair(drawn, system, rows[key], truth, doubt, casimirs).look()
        pairs, runs, stopped = pairs + 1, runs + abs(made), stopped + (made < 0)
        if found:
            wrong.append((key, found))
    return drawn, (pairs, runs, stopped, wrong)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--seed", type=int, default=2026)
    parser.add_argument("--systems", type=int, default=200)
    parser.add_argument("--methods", type=int, default=20, help="for each system")
    parser.add_argument("--only", type=int, help="one system, by its number")
    parser.add_argument("--control", action="store_true", help="with a judge that is wrong")
    asked = parser.parse_args()
    picked = range(asked.systems) if asked.only is None else [asked.only]
    total, failed = np.zeros(3, int), 0
    wild = 0
    for index in picked:
        drawn, result = audit(asked.seed, index, asked.methods, asked.control)
        if result is None:
            wild += 1
            continue
        *counts, wrong = result
        total += counts
        failed += len(wrong)
        for key, what in wrong:
            print(f"{drawn.name} on {drawn.algebra}, {key}: {what}", flush=True)
    pairs, runs, stopped = total
    print(f"{len(picked) - wild} systems, {wild} too wild to be judged; {pairs} pairs, {runs} runs; ", end="")
    print(f"{stopped} pairs refused every step; {failed} wrong")
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    main()
