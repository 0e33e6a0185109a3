//! Kinds of Hamiltonians.

use super::draw::Draw;

impl Draw {
    fn x(&mut self) -> String {
        let n = self.dimension;
        format!("x{}", self.below(n))
    }

    fn parameter(&mut self) -> &'static str {
        self.pick(&["k0", "k1", "k2", "k3"])
    }

    fn factor(&mut self) -> &'static str {
        self.pick(&[
            "",
            "2*",
            "k0*",
            "k1*",
            "k2*",
            "-",
            "3/7*",
            "k0*k3*",
            "k1/(k0 + k2)*",
        ])
    }

    /// Some of the coordinates, at least so many.
    fn some(&mut self, least: usize) -> Vec<usize> {
        let n = self.dimension;
        let mut chosen: Vec<usize> = (0..n).filter(|_| self.below(3) > 0).collect();
        for i in 0..n {
            if chosen.len() < least.min(n) && !chosen.contains(&i) {
                chosen.push(i);
            }
        }
        chosen
    }

    /// `x0 + 2*x2 - k1*x1`
    fn linear(&mut self) -> String {
        let terms = self.some(2);
        let terms: Vec<String> = terms
            .iter()
            .map(|i| format!("({}x{i})", self.factor()))
            .collect();
        terms.join(" + ")
    }

    /// `x0^2 + x1^2/2 + …`, positive away from 0.
    fn squares(&mut self) -> String {
        let terms = self.some(2);
        let terms: Vec<String> = terms
            .iter()
            .map(|i| format!("x{i}^2{}", self.pick(&["", "", "/2", "*k1", "/k0^2"])))
            .collect();
        terms.join(" + ")
    }

    fn kinetic(&mut self) -> String {
        let terms: Vec<String> = (0..self.dimension)
            .map(|i| format!("x{i}^2/{}", self.pick(&["2", "(2*k0)", "k1", "(k0 + k2)"])))
            .collect();
        terms.join(" + ")
    }

    fn sum(&mut self, most: usize, term: fn(&mut Draw) -> String) -> String {
        let count = 1 + self.below(most);
        let terms: Vec<String> = (0..count)
            .map(|_| format!("{}{}", self.factor(), term(self)))
            .collect();
        // a sign in front of a term takes parentheses
        let terms: Vec<String> = terms.iter().map(|term| format!("({term})")).collect();
        terms.join(" + ")
    }

    /// Springs, anchors, Morse and Lennard-Jones terms: powers of differences.
    pub fn springs(&mut self) -> String {
        let terms = self.sum(5, |draw| {
            let (a, b) = (draw.x(), draw.x());
            let k = draw.parameter();
            let forms = [
                format!("({a} - {b})^2/2"),
                format!("({a} - {k})^2"),
                format!("(1 - exp(-{k}*({a} - {b} - 1/3)))^2"),
                format!("(({k}/(2 + {a} - {b}))^12 - ({k}/(2 + {a} - {b}))^6)"),
                format!("(({a} - {b})^2 - {k}^2)^2"),
                format!("(sqrt(({a} - {k})^2 + {b}^2 + 1) - {k})^2/2"),
            ];
            let form = draw.below(forms.len());
            forms[form].clone()
        });
        format!("{} + {terms}", self.kinetic())
    }

    /// Quotients of polynomials.
    pub fn ratios(&mut self) -> String {
        self.sum(4, |draw| {
            let (above, below) = (draw.linear(), draw.squares());
            let power = draw.pick(&["", "^2", "^3", "^5"]);
            let under = draw.pick(&["", "^2", "^4"]);
            let inner = draw.x();
            match draw.below(3) {
                0 => format!("({above}){power}/(1 + {below}){under}"),
                1 => format!("({above}){power}/(2 + ({inner})^2/(1 + {below})){under}"),
                _ => format!("({above})/(1 + {below}) * {inner}{power}/(3 + {inner}^2){under}"),
            }
        })
    }

    /// Roots of roots.
    pub fn nested_radicals(&mut self) -> String {
        let mut inner = self.squares();
        for _ in 0..1 + self.below(3) {
            let (more, power) = (self.squares(), self.pick(&["1/2", "1/3", "3/2", "2/3"]));
            inner = format!("1 + {more} + ({inner} + 1)^({power})");
        }
        let outside = self.sum(2, |draw| draw.linear());
        format!("{}sqrt({inner}) + ({outside})^2", self.factor())
    }

    /// Roots of sums in denominators.
    pub fn roots_below(&mut self) -> String {
        self.sum(4, |draw| {
            let (above, power) = (draw.linear(), draw.pick(&["", "^2", "^3"]));
            let (below, exponent) = (draw.squares(), draw.pick(&["1/2", "3/2", "5/2", "7/2"]));
            format!("({above}){power}/({below} + 1)^({exponent})")
        })
    }

    /// Exponentials, waves and their compositions.
    pub fn exponentials(&mut self) -> String {
        self.sum(4, |draw| {
            let (a, b) = (draw.linear(), draw.squares());
            let f = draw.pick(&["sin", "cos", "tanh", "atan", "exp"]);
            let x = draw.x();
            match draw.below(5) {
                0 => format!("exp(-({b}))*{f}({x})"),
                1 => format!("{f}({x})*cos({a})"),
                2 => format!("log(2 + {f}({x})^2 + {b})"),
                3 => format!("exp(sin({a}))*({x} - exp(-{x}))^2"),
                _ => format!("({a})/(1 + exp(-{x}))"),
            }
        })
    }

    /// A quadratic form with all its coefficients, some of them parameters.
    pub fn dense_quadratic(&mut self) -> String {
        let n = self.dimension;
        let mut terms = Vec::new();
        for (i, j) in (0..n).flat_map(|i| (i..n).map(move |j| (i, j))) {
            let coefficient =
                self.pick(&["1/2", "k0", "k1/3", "2/7", "k0*k1", "1/(k0 + k1)", "-k2"]);
            terms.push(format!("({coefficient})*x{i}*x{j}"));
        }
        let form = terms.join(" + ");
        match self.below(5) {
            0 => format!("sqrt(9 + ({form})^2)"),
            1 => format!("({form}) + ({form})^2/4"),
            2 => format!("exp(-({form})/9)"),
            _ => form,
        }
    }

    /// Products of sums with powers.
    pub fn powers_of_sums(&mut self) -> String {
        let count = 2 + self.below(2);
        let factors: Vec<String> = (0..count)
            .map(|_| {
                let sum = match self.below(3) {
                    0 => self.squares(),
                    1 => self.linear(),
                    _ => format!("{} + {}*{}", self.linear(), self.x(), self.x()),
                };
                format!("({sum})^{}", 1 + self.below(9))
            })
            .collect();
        let product = factors.join("*");
        match self.below(3) {
            0 => product,
            1 => format!("{product}/(1 + {})^{}", self.squares(), 1 + self.below(4)),
            _ => format!("{product} + {}", self.kinetic()),
        }
    }

    /// Multipoles: polynomials over powers of the radius.
    pub fn radii(&mut self) -> String {
        let r = self.squares();
        self.radius = format!("({r} + 1/9)");
        let terms = self.sum(4, |draw| {
            let (r, x, y, a) = (draw.radius.clone(), draw.x(), draw.x(), draw.linear());
            let k = draw.parameter();
            match draw.below(5) {
                0 => format!("1/sqrt({r})"),
                1 => format!("(3*{x}*{y} - {r})/{r}^(5/2)"),
                2 => format!("(sqrt({r}) - {k})^2/2"),
                3 => format!("exp(-sqrt({r})/{k})/sqrt({r})"),
                _ => format!("({a})^3/{r}^(7/2)"),
            }
        });
        format!("{} + {terms}", self.kinetic())
    }

    /// A product or a composition of two of the kinds.
    pub fn mixture(&mut self) -> String {
        let kinds = [
            Draw::springs,
            Draw::ratios,
            Draw::nested_radicals,
            Draw::roots_below,
            Draw::exponentials,
            Draw::radii,
        ];
        let (first, second) = (self.below(kinds.len()), self.below(kinds.len()));
        let (a, b) = (kinds[first](self), kinds[second](self));
        match self.below(4) {
            0 => format!("({a}) + ({b})"),
            1 => format!("({a})*({b})"),
            2 => format!("({a})/(1 + ({b})^2)"),
            _ => format!("sqrt(1 + ({a})^2) + ({b})"),
        }
    }
}
