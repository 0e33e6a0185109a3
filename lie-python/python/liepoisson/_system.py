"""Systems: runs, ensembles, measurements, functions."""

from __future__ import annotations

import os
import warnings
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from ._again import Again
from ._arguments import Controllers, Number, Progress, heard, merged, spelled, whole
from ._bench import Bench
from ._declared import Declared
from ._ensemble import Ensemble, Part
from ._errors import IntegrationError
from ._functions import Function
from ._histogram import Histogram, histogram
from ._measure import asked_of, measured, parted, stressed, verified
from ._members import drawn, members_of, table_of
from ._notebook import page_of
from ._shares import Work, gathered
from ._solution import Occurrences, Solution
from ._spectra import Exponents
from ._stress import Stress
from ._verification import Verification

__all__ = ["System", "load"]

#: The options of `run`, in the order in which the core compares them with those of calls before.
_OPTIONS = (
    "method", "h", "tol", "t0", "t", "every", "at", "group", "rtol", "atol", "iteration", "newton_tolerance",
    "max_iterations", "converge", "keep", "density", "assess", "inputs", "seed",
)  # fmt: skip


class System(Declared):
    """A Lie–Poisson system, by the text of a spec, a dictionary, or the keys of a spec as keywords.

    >>> top = System(name="Top", algebra="se(3)", state=["m1", "m2", "m3", "g1", "g2", "g3"],
    ...              hamiltonian="m1^2/2 + m2^2/2 + m3^2 + g3", initial=[0.1, 0.2, 0.9, 0, 0.6, 0.8])
    >>> top.casimirs
    ['C1', 'C2']

    Errors: :class:`DeclarationError` lists every mistake with its place and remedy.
    """

    def run(
        self,
        method: str | None = None,
        *,
        h: Number | None = None,
        tol: float | None = None,
        t0: Number | None = None,
        t: Number | None = None,
        x0: Any = None,
        every: int | None = None,
        at: Sequence[float] | None = None,
        rtol: float | None = None,
        atol: float | None = None,
        iteration: str | None = None,
        newton_tolerance: float | None = None,
        max_iterations: int | None = None,
        converge: str | None = None,
        keep: str | Sequence[str] | None = None,
        density: str | None = None,
        assess: bool = False,
        group: str | None = None,
        inputs: Mapping[str, Any] | None = None,
        seed: int | None = None,
        progress: Progress | None = None,
        parameters: Mapping[str, Number] | None = None,
        **named: Number,
    ) -> Solution:
        """Integrates from time ``t0``, by default 0, until ``t``.

        ``h`` is the step; ``tol``, in its place, the relative error wanted at the end. ``x0`` is the initial state, a
        sequence or a dictionary; ``every`` saves each so-manyth step, ``at`` saves these times alone, in their
        order. Parameters are given by name, or in ``parameters`` where a name is also an argument (``parameters={"h": 2}``). What is left out comes from the
        declaration; its words ``step``, ``from``, ``until`` and ``initial`` are taken for ``h``, ``t0``, ``t`` and ``x0`` too. ``rtol`` and ``atol`` are those of dopri5. ``iteration`` ("automatic", "newton", "simplified",
        "fixed-point"), ``newton_tolerance`` (in units of round-off), ``max_iterations`` and ``converge`` ("state", "map",
        "tolerance") are for the solver of implicit methods. ``group="matrix"`` follows the group element from the declared
        ``attitude`` or the identity on (``run.group``); for groups that turn space, se(3) too, ``"quaternion"``, the real part first, or Euler angles in
        radians such as ``"euler:zxz"`` for g = Rz(phi) Rx(theta) Rz(psi), which are continuous along the run.

        ``keep=["energy", "casimirs"]``, or one of them, brings the state back behind each step of taylor, dopri5 or rk4 to the
        values at the start: they are kept to round-off. The steps are no Poisson maps for that, and ``run.kept`` says what was.

        ``density="reversible"`` lets the size of steps follow the motion, from ``h`` or the step that ``tol`` chooses on: a symmetric
        method stays reversible, so that the energy of reversible motion does not drift, and is no Poisson map for that.

        ``inputs={"u": source}`` gives the declared inputs their values: a function ``u(t, mu, g)`` that is asked at each sampling, with the
        state and, with ``group``, the group element there, else None; or an array of shape (m, 2), a time and a value in each row, held
        from each of its times on. What a function raises ends the run and is raised. ``seed`` (1) is that of noise: ``run.seed``.

        ``assess=True`` makes a second run with other steps, which takes 1.25 times as long, and tells by how much the end is off:
        ``run.error``.

        ``progress`` is a function that is called now and then with what is done, of how much, and what that is, here
        ``progress(steps, total, "steps")``; an exception that it raises ends the work. Nothing is printed otherwise, and a run of less than
        a tenth of a second may not call it.

        Warnings: :class:`UserWarning` where no step is short enough for ``tol``, where the error that ``assess`` has found is much
        larger, and where mechanics in a
        canonical pair runs backwards in time, because of the sign of its bracket at the initial state.

        Errors: :class:`MethodError` for a method that does not apply, :class:`IntegrationError` with ``partial`` for a
        run that stopped early, :class:`ValueError` and :class:`TypeError` for arguments.
        """
        if isinstance(keep, (list, tuple, set, frozenset)):
            keep = list(keep)
        options = (
            method, h, tol, t0, t, every, at, group, rtol, atol, iteration, newton_tolerance, max_iterations, converge, keep, density,
            assess, inputs, seed,
        )  # fmt: skip
        controllers = None
        if inputs is not None:
            controllers = Controllers(inputs)
            options = (*options[:-2], controllers.sources, seed)
        if named:
            # what is remembered goes by the names of its arguments
            own = {"x0": x0, **dict(zip(_OPTIONS, options))}
            spelled(own, named, self._defaults)
            x0, options = own["x0"], tuple(own[name] for name in _OPTIONS)
        call: Any
        made = None
        if progress is None and parameters is None:
            made = self._core.again(options, x0, named)
        if made is None:
            call = self._asked({"x0": x0, **dict(zip(_OPTIONS, options))}, parameters, named)
            made = self._core.run(call, options, heard(progress))
            if controllers is not None and controllers.raised is not None:
                raise controllers.raised
        else:
            # lists and arrays may change before it is looked at
            start = x0 if x0 is None else x0.copy() if isinstance(x0, np.ndarray) else list(x0)
            call = (options, list(at) if at else None, start, named)
        solution = Solution(self, made, call)
        if made[-1] is not None:
            self._more(solution, made[-1])
        return solution

    def _again(self, call: Any, span: tuple[float, float]) -> Again:
        """What makes a run once more."""
        if isinstance(call, tuple):
            options, at, x0, named = call
            asked = {"x0": x0, **dict(zip(_OPTIONS, options)), "at": at}
            call = self._asked(asked, None, named)
        return Again(self, call, span)

    def _more(self, solution: Solution, found: dict[str, Any]) -> None:
        """What is not of every run: declared functions, the group element, warnings, what ended it early."""
        if "quantities" in found:
            solution._quantities = found["quantities"]
        for name, (times, states) in found.get("events", {}).items():
            solution.events[name] = Occurrences(times, self._visible(states))
        solution.stopped = found.get("stopped")
        if "group" in found:
            elements = np.asarray(found["group"]).reshape(len(solution.t), -1)
            size = round(elements.shape[1] ** 0.5)
            solution.group = elements.reshape(-1, size, size) if found["matrix"] else elements
        solution.density = found.get("density")
        solution.seed = found.get("seed")
        if "note" in found:
            warnings.warn(found["note"], stacklevel=3)
        error = found.get("error")
        solution.error = error
        if error is not None and found["missed"]:
            text = (
                f"the error at the end is about {error:.1e} of the state, more than the tolerance {found['tolerance']:g}: "
                f"errors grow on this orbit, or {solution.method} cannot keep it"
                if np.isfinite(error)
                else "the error at the end is not known: the second run, which would tell it, failed, or chooses its own steps"
            )
            warnings.warn(text, stacklevel=3)
        elif "lost" in found:
            text = (
                f"from t = {found['lost']:.6f} on no step is short enough for the tolerance: there is a singularity or a joint "
                "of H; assess=True says by how much the end is off"
            )
            warnings.warn(text, stacklevel=3)
        if "why" in found:
            number, time = found["step_number"], found["time"]
            message = (
                f"the integration stopped in step {number} at t = {time!r}: {found['why']}\n"
                f"  help: {found['remedy']}; the rows so far are in `partial`"
            )
            raise IntegrationError(message, solution, number, time)

    def ensemble(
        self,
        x0: npt.ArrayLike | None = None,
        method: str | None = None,
        *,
        h: Number | None = None,
        tol: float | None = None,
        t0: Number | None = None,
        t: Number | None = None,
        every: int | None = None,
        at: Sequence[float] | None = None,
        members: int | None = None,
        seed: int | None = None,
        spread: Number | None = None,
        events: bool = False,
        threads: int | None = None,
        executor: Any = None,
        shares: int | None = None,
        folder: str | os.PathLike[str] | None = None,
        rtol: float | None = None,
        atol: float | None = None,
        iteration: str | None = None,
        newton_tolerance: float | None = None,
        max_iterations: int | None = None,
        converge: str | None = None,
        keep: str | Sequence[str] | None = None,
        progress: Progress | None = None,
        parameters: Mapping[str, Any] | None = None,
        **named: Any,
    ) -> Ensemble:
        """Many trajectories, from the rows of ``x0`` (shape (m, n)); parameters may be arrays of length m, and x0 a single state.

        The ends are kept, or with ``every`` each so-manyth step, with ``at`` these times. With ``tol`` in the place of ``h`` each
        member has a step of its own, and `every` is not taken. Other arguments are those of :meth:`run`. The bits do not
        depend on the number of threads (all processors by default). A member that fails has rows of not-a-number from there
        on, and is named in ``failures``. An event of the declaration that stops ends its member, whose last state is its end; ``stopped`` and
        ``stop_times`` say which and when. ``events=True`` keeps all declared events, ``many.events["name"]`` with ``.member``, ``.t`` and
        ``.mu``. Of a group element that the declaration asks for, nothing is kept. ``progress`` hears how many
        members are done, as in :meth:`run`.

        ``members=1000`` draws initial states around a single one, that of the declaration where x0 is None: where random
        elements of the group take it, on its coadjoint orbit. ``spread`` is the standard deviation of their coordinates in the algebra
        (0.1), or "orbit": uniformly over the orbit, of a compact group. ``seed`` (1) says which; `lie ensemble` draws the same. It is
        also that of noise, of which each member has its own.

        ``executor`` has the members computed by other workers: any of ``concurrent.futures``, a Client of Dask, the module ``ray``
        after its ``init``, or ``mpi4py.futures.MPIPoolExecutor``. They take shares of the members, ``shares`` in number, each on
        one thread unless ``threads`` says otherwise. The bits are the same for every number of workers and shares. With ``folder``
        the shares are kept there as they come, and the same call does no share again that is there.

        Errors: :class:`LostShares` names the members of workers that ended, and has the others: the same call with a new executor
        does the missing ones alone.

        >>> body = System(algebra="so(3)", state=["x", "y", "z"], hamiltonian="x^2/2 + y^2/4 + z^2/6")
        >>> starts = [[1, 0.1, 0], [0, 1, 0.1]]
        >>> body.ensemble(starts, "gauss4", h=0.1, t=1).mu.shape
        (2, 3)
        >>> rows = body.ensemble(starts, "gauss4", h=0.1, t=1, every=5)
        >>> rows.mu.shape, rows.t.tolist()
        ((2, 3, 3), [0.0, 0.5, 1.0])
        >>> from concurrent.futures import ThreadPoolExecutor
        >>> with ThreadPoolExecutor(2) as workers:
        ...     many = body.ensemble([1, 0.1, 0], "gauss4", h=0.1, t=1, members=500, executor=workers)
        >>> many.mu.shape
        (500, 3)
        """
        own = {
            "method": method, "h": h, "tol": tol, "t0": t0, "t": t, "x0": x0, "every": every, "at": at,
            "rtol": rtol, "atol": atol, "iteration": iteration, "newton_tolerance": newton_tolerance,
            "max_iterations": max_iterations, "converge": converge, "keep": keep,
        }  # fmt: skip
        if self._core.noisy:
            own["seed"] = 1 if seed is None else seed
        others = dict(named)
        spelled(own, others, self.parameters)
        parameters = merged(parameters, others)
        if members is None:
            if (seed is not None and not self._core.noisy) or spread is not None:
                raise TypeError(
                    "seed and spread are for initial states that are drawn: give members=1000"
                )
            starts = members_of(self, own.pop("x0"), parameters)
            table = table_of(self, parameters, len(starts))
        else:
            starts, table = drawn(self, own.pop("x0"), parameters, (members, seed, spread))
        asked = self._asked(own, None, {})
        if events and not self._core.events:
            raise ValueError(
                f'{self.name} declares no events\n  help: declare some, such as events={{"down": {{"when": "z"}}}}'
            )
        usual = (os.cpu_count() or 1) if executor is None else 1
        count = usual if threads is None else whole(threads, "threads", 1)
        if executor is None:
            if shares is not None or folder is not None:
                raise TypeError(
                    "shares and folder are for workers: give executor=ProcessPoolExecutor()"
                )
            options = (count, events)
            found = Part(*self._core.ensemble(table, starts, asked, options, heard(progress)))
        else:
            cut = None if shares is None else whole(shares, "shares", 1)
            work = Work(self.text, table, starts, asked, count, events)
            found = gathered(work, executor, cut, folder, heard(progress))
        if found.note is not None:
            warnings.warn(found.note, stacklevel=2)
        states = self._visible(found.states)
        if every is None and at is None:
            states = states[:, -1]
        recorded = found.recorded(self._core.events, self._visible, events)
        kept = tuple(self._core.kept(asked))
        return Ensemble(states, found.t, found.failures, kept, **recorded)

    def histogram(
        self,
        states: npt.ArrayLike,
        bins: int | None = None,
        parameters: Mapping[str, Number] | None = None,
        **named: Number,
    ) -> Histogram:
        """How many members of an ensemble are where: states of shape (members, n), or (members, rows, n) row by row, as of :meth:`ensemble`.

        Where orbits are spheres around zero, as on so(3) in an orthonormal basis, members are counted by their direction in ``bins`` bands (16) of
        three times as many sectors, all of the same area; elsewhere by the value of each coordinate, in ``bins`` (50) between the least and the
        largest of all states. `lie ensemble --reduce histogram` counts the same. States that are not numbers are left out.

        Errors: ValueError for states of another shape.

        >>> body = System(algebra="so(3)", state=["x", "y", "z"], hamiltonian="x^2/2 + y^2/4 + z^2/6")
        >>> many = body.ensemble([1, 0.1, 0], "rk4", h=0.1, t=1, members=500, spread="orbit")
        >>> found = body.histogram(many.mu, bins=4)
        >>> found.counts.shape, int(found.counts.sum())
        ((4, 12), 500)
        """
        return histogram(self, states, bins, merged(parameters, named))

    def function(
        self, name: str, /, parameters: Mapping[str, Number] | None = None, **named: Number
    ) -> Function:
        """A function of the state, vectorised over leading axes: of shape (…, n).

        ``vector_field``, ``gradient``: (…, n). ``jacobian``, ``hessian``, ``poisson_matrix``: (…, n, n).
        ``hamiltonian``: (…). ``casimirs``: (…, number of Casimirs).

        >>> body = System(algebra="so(3)", state=["x", "y", "z"], hamiltonian="x^2/2 + y^2/4 + z^2/6")
        >>> f = body.function("vector_field")
        >>> f([1.0, 2.0, 6.0]).tolist()
        [-2.0, 4.0, -1.0]

        For SciPy: ``solve_ivp(lambda t, y: f(y), …)``. Where the Hamiltonian depends on the time, it is the second argument,
        0 unless it is given: ``f(y, t)``; t may be an array over the leading axes.

        >>> driven = System(algebra="so(3)", state=["x", "y", "z"], hamiltonian="x^2/2 + cos(t)*y")
        >>> driven.function("hamiltonian")([0, 1, 0], 0.0).item()
        1.0
        """
        return Function(self, name, self._values(merged(parameters, named)))

    def verify(
        self,
        *methods: str,
        h: Number | None = None,
        x0: Any = None,
        seed: int = 1,
        progress: Progress | None = None,
        parameters: Mapping[str, Number] | None = None,
        **named: Number,
    ) -> Verification:
        """Measures what methods claim on this system: order, symmetry, invariants, the orbit, the Poisson structure.

        Without names, all methods that apply, at their default options. ``h`` is the step at which facts are
        measured; it is found where it is not given. The kernels of the system, from the vector field to the Casimirs, are compared with
        the declaration as it was written. Of a system with noise the strong and the weak order are measured along paths of ``seed``, and at
        a temperature the means of long runs, against those of exp(-H/T). ``progress`` hears how far it is, as in :meth:`run`.

        >>> body = System(algebra="so(3)", state=["x", "y", "z"], hamiltonian="x^2/2 + y^2/4 + z^2/6")
        >>> found = body.verify("rk4", "lie-midpoint", x0=[0.8, 0.1, 0.6])
        >>> found.passed, found.kernels["jacobian"] <= 1
        (True, True)

        Errors: :class:`Interrupted`, a KeyboardInterrupt, where Ctrl-C ends it; its ``partial`` has what was measured.
        :class:`MethodError` for a method that does not apply, :class:`ValueError` where nothing can be measured.
        """
        asked = asked_of(self, "verify", {"h": h, "x0": x0}, parameters, named)
        return verified(self, methods, asked, seed, progress)

    def bench(
        self,
        *methods: str,
        t: Number | None = None,
        measure: str = "state",
        section: tuple[str, Number] | None = None,
        budget: float = 0.2,
        x0: Any = None,
        progress: Progress | None = None,
        parameters: Mapping[str, Number] | None = None,
        **named: Number,
    ) -> Bench:
        """Measures errors of methods beside the times that they take, each at one step or tolerance after the other.

        Without names, the methods that `lie bench` takes. ``t`` is the end, that of the
        declaration (at most 20), or 10. ``measure`` is the sense of errors: "state", "energy", "casimirs", "phase", or
        "section" with ``section=(coordinate, value)``. No run that takes longer than ``budget`` seconds is made more accurate.
        ``progress`` hears how far it is, as in :meth:`run`.

        >>> body = System(algebra="so(3)", state=["x", "y", "z"], hamiltonian="x^2/2 + y^2/4 + z^2/6")
        >>> found = body.bench("rk4", "gauss4", t=1, budget=0.01, x0=[0.8, 0.1, 0.6])
        >>> sorted(found.methods)
        ['gauss4', 'rk4']
        >>> bool(found["error"].min() < 1e-9 < found["error"].max())
        True

        Errors: :class:`Interrupted`, a KeyboardInterrupt, where Ctrl-C ends it; its ``partial`` has what was measured.
        :class:`MethodError` for a method that does not apply, :class:`ValueError` where nothing can be measured.
        """
        asked = asked_of(self, "bench", {"t": t, "x0": x0}, parameters, named)
        return measured(self, methods, asked, (budget, measure, section), progress)

    def stress(
        self,
        *methods: str,
        steps: int = 1_000_000,
        x0: Any = None,
        progress: Progress | None = None,
        parameters: Mapping[str, Number] | None = None,
        **named: Number,
    ) -> Stress:
        """Takes methods to the limits of steps, parameters and states, and through a long run.

        Without names, the methods that `lie stress` takes. Steps are tried from 1e-12 to 256
        times h0 (0.2 over the largest rate of the field), parameters times 10 to 1e6, states times 1e-100 to 1e100, each component and
        each Casimir near zero, 400 steps each; then a run of ``steps`` steps, and eight shorter ones that say how round-off grows. All
        processors are used. ``progress`` hears how far it is, as in :meth:`run`.

        >>> body = System(algebra="so(3)", state=["x", "y", "z"], hamiltonian="x^2/2 + y^2/4 + z^2/6")
        >>> found = body.stress("rk4", "lie-midpoint", steps=10_000, x0=[0.8, 0.1, 0.6])
        >>> found.passed
        True
        >>> [cell.outcome for cell in found.of("lie-midpoint") if cell.experiment == "long"]
        ['kept']

        Errors: :class:`Interrupted`, a KeyboardInterrupt, where Ctrl-C ends it; its ``partial`` has what was tried.
        :class:`MethodError` for a method that does not apply, :class:`ValueError` where nothing can be tried.
        """
        asked = asked_of(self, "stress", {"x0": x0}, parameters, named)
        return stressed(self, methods, asked, steps, progress)

    def exponents(
        self,
        method: str | None = None,
        *,
        h: Number | None = None,
        t: Number | None = None,
        x0: Any = None,
        transient: Number = 0,
        count: int | None = None,
        seed: int = 1,
        progress: Progress | None = None,
        parameters: Mapping[str, Number] | None = None,
        **named: Number,
    ) -> Exponents:
        """Lyapunov exponents along an orbit, by the tangents of the steps of a method.

        All of them, or the ``count`` largest. Sums begin after a time of ``transient``; ``seed`` is that of the first vectors. Step and end must be
        given here or in the declaration. ``progress`` hears how far it is, as in :meth:`run`.

        >>> swing = System(poisson=["{q, p} = 1"], state=["q", "p"], hamiltonian="p^2/2 - q^2/2")
        >>> found = swing.exponents("gauss6", h=0.05, t=60, x0=[0, 0], transient=20)
        >>> [round(float(value), 7) for value in found.values], found.pairing_defect < 1e-12
        ([1.0, -1.0], True)

        Errors: :class:`IntegrationError` where a step fails, and :class:`Interrupted`, a KeyboardInterrupt, where Ctrl-C ends it; their
        ``partial`` has what was summed. :class:`MethodError` for a method that does not apply, and for families, noise and inputs.
        """
        own = {"method": method, "h": h, "t": t, "x0": x0, "seed": whole(seed, "seed", 0)}
        asked = asked_of(self, "exponents", own, parameters, named)
        return parted(self, asked, (transient, count), progress)

    def canonical(self) -> System:
        """The same system in coordinates in which its bracket is constant, as `lie canonical` writes it.

        For log-canonical brackets and their like, and pairs `{x, y} = 1/B(x, y)` with a closed inverse of `int B dy`. Gauss methods are Poisson maps there; the old coordinates are observables.

        >>> prey = System(poisson=["{x, y} = x*y"], state=["x", "y"], hamiltonian="x - log(x) + y - log(y)", initial=[0.5, 2])
        >>> other = prey.canonical()
        >>> other.coordinates
        ['log_x', 'log_y']
        >>> bool(abs(other.run("gauss10", h=0.1, t=5)["x"][-1] - prey.run("gauss10", h=0.1, t=5)["x"][-1]) < 1e-9)
        True

        Errors: :class:`MethodError` where there are no such coordinates.
        """
        return System(self._core.canonical())

    def _repr_html_(self) -> str:
        return page_of(self)


def load(path: str | os.PathLike[str]) -> System:
    """The system of a spec file."""
    with open(path, encoding="utf-8-sig") as file:
        return System(file.read())
