"""Formulas as LaTeX: what is shown is what was written."""

from __future__ import annotations

import pytest
from liepoisson._latex import as_latex


@pytest.mark.parametrize(
    ("text", "latex"),
    [
        ("x1' = x1^2 - k_rot*pi*z", r"x'_{1} = x_{1}^{2} - k_{\mathrm{rot}}\,\pi\,z"),
        ("x^(-3/2) + x^2.5", r"x^{-\frac{3}{2}} + x^{2.5}"),
        ("sqrt(x^2 + 1)/log1p(y)", r"\frac{\sqrt{x^{2} + 1}}{\operatorname{log1p}(y)}"),
        ("sum(i in 0..N: x[i])^2/(2*N)", r"\frac{\left(\sum_{0 \le i < N} x_{i}\right)^{2}}{2\,N}"),
        ("sum(i in 0..N: x[i] + 1)", r"\sum_{0 \le i < N} (x_{i} + 1)"),
        ("a - (b - c)", "a - (b - c)"),
        ("-x*(y - z)/2 + x*-y", r"-\frac{x\,(y - z)}{2} + x\,(-y)"),
        ("(x/y)^2*2*3", r"\left(\frac{x}{y}\right)^{2}\,2 \cdot 3"),
        ("1e-3*abs(x)", r"1 \cdot 10^{-3}\,\left|x\right|"),
        (
            "piecewise(x < 0: -x, x^2)",
            r"\begin{cases}-x & x < 0 \\ x^{2} & \text{otherwise}\end{cases}",
        ),
        ("not a formula", r"\mathtt{not a formula}"),
    ],
)
def test_what_is_shown_is_what_was_written(text: str, latex: str) -> None:
    assert as_latex(text) == latex
