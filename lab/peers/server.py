"""A measuring program as `run` talks to it: a line with a case is answered by the settings worth timing, a line that
asks for a round by the times of each of them."""

import json
import sys
import time

SAMPLE = 1.5e-3
"""A sample lasts about so many seconds."""

ONCE = 5e-3
"""What takes longer, in seconds, is tried once; else three times."""


def spent(times, work):
    """Seconds of the processor in this thread, and seconds that passed, of one of so many runs."""
    wall, processor = time.perf_counter_ns(), time.thread_time_ns()
    for _ in range(times):
        work()
    processor, wall = time.thread_time_ns() - processor, time.perf_counter_ns() - wall
    return processor * 1e-9 / times, wall * 1e-9 / times


def distance(one, other, many):
    """The distance of two states, of many spins or bodies the largest one."""
    squares = [(float(a) - float(b)) ** 2 for a, b in zip(one, other)]
    size = 3 if many else len(squares)
    return max(sum(squares[k : k + size]) for k in range(0, len(squares), size)) ** 0.5


class Trials:
    """Settings of one case."""

    def __init__(self, request):
        self.request, self.all = request, []

    def add(self, peer, method, setting, run, drifts=None):
        """Tries a setting; `run` goes to the end of the span and gives the state there and the number of steps."""
        least = float("inf")
        for _ in range(3):
            start = time.thread_time_ns()
            outcome = run()
            least = min(least, (time.thread_time_ns() - start) * 1e-9)
            if outcome is None or least > ONCE:
                break
        if outcome is None:
            return least
        end, steps = outcome
        error = distance(end, self.request["reference"], self.request["case"] in "CD")
        row = {"peer": peer, "method": method, "by": "tolerance", "setting": setting,
               "error": error, "steps": int(steps), "drift": drifts and drifts(), "first": least}
        if error == error:
            self.all.append((row, run))
        return least

    def prune(self):
        kept = set()
        for name in {(row["peer"], row["method"]) for row, _ in self.all}:
            for target in self.request["targets"]:
                good = [i for i, (row, _) in enumerate(self.all)
                        if (row["peer"], row["method"]) == name and row["error"] <= target]
                good.sort(key=lambda i: self.all[i][0]["first"])
                kept.update(good[: self.request["keep"]])
        self.all = [self.all[i] for i in sorted(kept)]

    def round(self):
        times = [max(1, min(100000, round(SAMPLE / row["first"]))) for row, _ in self.all]
        return [spent(count, run) for count, (_, run) in zip(times, self.all)]


def serve(prepare):
    """Answers requests; `prepare` tries all settings of a case."""
    trials = None
    for line in sys.stdin:
        request = json.loads(line)
        if "case" in request:
            trials = Trials(request)
            prepare(trials)
            trials.prune()
            answer = {"rows": [row for row, _ in trials.all]}
        else:
            answer = {"samples": trials.round()}
        print(json.dumps(answer), flush=True)
