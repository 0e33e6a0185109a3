"""What a notebook shows of a system: its mathematics and, from the declared initial state, its motion."""

from __future__ import annotations

import html
import warnings
from typing import TYPE_CHECKING, Any

from . import _core
from ._arguments import STEP, UNTIL
from ._errors import IntegrationError, MethodError
from ._pictures import image, page

if TYPE_CHECKING:
    from ._system import System

#: The most steps of a picture.
_STEPS = 5000


def _picture(system: System) -> str:
    """The trajectory of the declaration, as far as a few thousand steps go; empty where there is none."""
    try:
        if system._core.family or system.initial is None:
            return ""
        options = system._core.run_options()
        start = _core.constant(options.get("from", ["0"])[0])
        end = _core.constant(options.get("until", [str(start + UNTIL)])[0])
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # the error at the end of a picture
            if "tol" in options:
                solution = system.run(t=end)
            else:
                step = abs(_core.constant(options.get("step", [str(STEP)])[0]))
                end = max(start - _STEPS * step, min(start + _STEPS * step, end))
                solution = system.run(t=end)
    except IntegrationError as stopped:
        solution = stopped.partial
    except (MethodError, ValueError):
        return ""  # a system that only the command runs

    def draw(figure: Any) -> None:
        axes = figure.subplots()
        solution._draw_components(axes)
        axes.set_xlabel("t")
        axes.set_title(f"{solution.method}, step {solution.step:g}", fontsize=9)

    return image(draw, (7, 3), f"trajectory of {system.name}")


def page_of(system: System) -> str:
    """The system: mathematics, Casimirs, motion."""
    # a system without a Hamiltonian has none
    shown = f"<div>$$\n{html.escape(system.latex())}\n$$</div>"
    mathematics = shown if system._core.equations() else ""
    casimirs = ", ".join(system.casimirs)
    known = f"<p>Casimirs: {html.escape(casimirs)}</p>" if casimirs else ""
    return page(system.name, mathematics, known, _picture(system))
