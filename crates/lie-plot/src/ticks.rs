//! Ticks at round numbers, and how they are written.

/// An axis from `low` to `high` with its ticks.
#[derive(Clone, Debug)]
pub struct Axis {
    pub low: f64,
    pub high: f64,
    pub ticks: Vec<f64>,
    step: f64,
}

impl Axis {
    /// A linear axis around values; about `count` ticks, a margin of `margin` of the length.
    pub fn linear(low: f64, high: f64, count: f64, margin: f64) -> Self {
        let limit = |value: f64| {
            if value.is_nan() {
                0.0
            } else {
                value.clamp(-1e300, 1e300)
            }
        };
        let (mut low, mut high) = (limit(low.min(high)), limit(high.max(low)));
        // What is constant, or as good as it, is drawn in the middle.
        let least = (1e-12 * low.abs().max(high.abs())).max(1e-290);
        if high - low <= least {
            let half = if least <= 1e-290 {
                1.0
            } else {
                0.1 * low.abs().max(high.abs())
            };
            (low, high) = (low - half, high + half);
        }
        let margin = margin * (high - low);
        (low, high) = (low - margin, high + margin);
        // one tick alone gives no scale
        let mut rough = (high - low) / count;
        let (mut step, mut ticks) = round_ticks(low, high, rough);
        for _ in 0..4 {
            if ticks.len() >= 2 {
                break;
            }
            rough *= 0.5;
            (step, ticks) = round_ticks(low, high, rough);
        }
        Self {
            low,
            high,
            ticks,
            step,
        }
    }

    /// A logarithmic axis in powers of ten: bounds and ticks are exponents.
    pub fn decades(low: f64, high: f64, count: usize) -> Self {
        let (first, last) = (low.ceil() as i64, high.floor() as i64);
        let every = ((last - first) / count as i64 + 1).max(1);
        let ticks = (first..=last)
            .filter(|k| k.rem_euclid(every) == 0)
            .map(|k| k as f64)
            .collect();
        Self {
            low,
            high,
            ticks,
            step: 1.0,
        }
    }

    /// Where a value lies: 0 at the lower end, 1 at the upper one.
    pub fn part(&self, value: f64) -> f64 {
        // Halves, so that no difference overflows.
        let part = (value / 2.0 - self.low / 2.0) / (self.high / 2.0 - self.low / 2.0);
        part.clamp(-1.0, 2.0)
    }

    /// The power of ten that labels of a linear axis are multiples of, where the values are very large or very small.
    fn exponent(&self) -> i32 {
        let largest = self.low.abs().max(self.high.abs());
        match (1e-3..1e6).contains(&largest) {
            true => 0,
            false => largest.log10().floor() as i32,
        }
    }

    /// The same in words.
    pub fn factor(&self) -> Option<String> {
        let exponent = self.exponent();
        (exponent != 0).then(|| format!("× {}", power_of_ten(f64::from(exponent))))
    }

    /// The label of a tick of a linear axis, without the factor.
    pub fn label(&self, value: f64) -> String {
        if value == 0.0 {
            return "0".to_owned();
        }
        let exponent = self.exponent();
        // in two steps, since a power of ten alone may be no number
        let scaled = |x: f64| x / 10f64.powi(exponent / 2) / 10f64.powi(exponent - exponent / 2);
        let decimals = (1.0 - scaled(self.step).log10().floor()).clamp(0.0, 15.0) as usize;
        shortened(&format!("{:.decimals$}", scaled(value))).replace('-', "−")
    }
}

/// Ticks at multiples of a round number that is not much larger than a given one.
fn round_ticks(low: f64, high: f64, rough: f64) -> (f64, Vec<f64>) {
    let power = 10f64.powf(rough.log10().floor());
    let step = [1.0, 2.0, 2.5, 5.0, 10.0]
        .into_iter()
        .map(|factor| factor * power)
        .find(|step| *step >= rough)
        .unwrap_or(rough);
    let ticks = ((low / step - 1e-9).ceil() as i64..=(high / step + 1e-9).floor() as i64)
        .take(100)
        .map(|k| k as f64 * step)
        .collect();
    (step, ticks)
}

/// Without zeros at the end of the decimals.
fn shortened(decimal: &str) -> &str {
    if decimal.contains('.') {
        decimal.trim_end_matches('0').trim_end_matches('.')
    } else {
        decimal
    }
}

/// The label of a power of ten.
pub fn power_of_ten(exponent: f64) -> String {
    match exponent.round() as i64 {
        0 => "1".to_owned(),
        1 => "10".to_owned(),
        exponent => format!("10{}", superscript(exponent)),
    }
}

fn superscript(number: i64) -> String {
    let small = |digit| match digit {
        '-' => '⁻',
        '1' => '¹',
        '2' => '²',
        '3' => '³',
        digit => digit
            .to_digit(10)
            .and_then(|d| char::from_u32(0x2070 + d))
            .unwrap_or(digit),
    };
    number.to_string().chars().map(small).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(low: f64, high: f64) -> Vec<String> {
        let axis = Axis::linear(low, high, 6.0, 0.0);
        axis.ticks.iter().map(|&tick| axis.label(tick)).collect()
    }

    #[test]
    fn linear_ticks_are_round() {
        assert_eq!(labels(0.0, 10.0), ["0", "2", "4", "6", "8", "10"]);
        assert_eq!(labels(-1.0, 1.0), ["−1", "−0.5", "0", "0.5", "1"]);
        assert_eq!(
            labels(0.0, 0.3),
            ["0", "0.05", "0.1", "0.15", "0.2", "0.25", "0.3"]
        );
        assert_eq!(
            labels(0.0, 1e5),
            ["0", "20000", "40000", "60000", "80000", "100000"]
        );
        assert_eq!(labels(0.0, 2e-9)[1], "0.5");
        assert_eq!(labels(0.0, 1e9)[1], "0.2");
        let factor = |low, high| Axis::linear(low, high, 6.0, 0.0).factor();
        assert_eq!(factor(0.0, 2e-9).as_deref(), Some("× 10⁻⁹"));
        assert_eq!(factor(-3e12, 1.0).as_deref(), Some("× 10¹²"));
        assert_eq!(factor(0.0, 1e5), None);
        // A small change of a large value is still told apart.
        let fine = labels(1000.0, 1000.003);
        assert!(fine.windows(2).all(|pair| pair[0] != pair[1]), "{fine:?}");
    }

    #[test]
    fn an_axis_has_two_ticks() {
        // the control: at multiples of 2, as asked for, there is one
        assert_eq!(round_ticks(-0.99, 1.9, 1.01).1, [0.0]);
        assert_eq!(Axis::linear(-0.99, 1.9, 2.86, 0.0).ticks, [0.0, 1.0]);
        for k in 1..400 {
            let (low, high) = (-0.01 * f64::from(k), 1.7 + 0.003 * f64::from(k));
            let ticks = Axis::linear(low, high, 3.0, 0.0).ticks;
            assert!((2..=7).contains(&ticks.len()), "{low} {high} {ticks:?}");
        }
    }

    #[test]
    fn hostile_bounds_have_an_axis() {
        let hostile = [
            0.0,
            1.0,
            -1.0,
            1e308,
            -1e308,
            5e-324,
            f64::NAN,
            f64::INFINITY,
            1e16,
        ];
        for low in hostile {
            for high in hostile {
                let axis = Axis::linear(low, high, 6.0, 0.05);
                assert!(axis.low < axis.high, "{low} {high} {axis:?}");
                assert!(
                    (axis.high - axis.low).is_finite() && axis.ticks.len() <= 20,
                    "{axis:?}"
                );
                axis.ticks
                    .iter()
                    .for_each(|&tick| assert!(axis.label(tick).len() < 40));
            }
        }
    }

    #[test]
    fn decades() {
        assert_eq!(
            Axis::decades(-16.5, -12.2, 6).ticks,
            [-16.0, -15.0, -14.0, -13.0]
        );
        assert!(Axis::decades(-320.0, 300.0, 6).ticks.len() <= 7);
        assert_eq!(power_of_ten(-16.0), "10⁻¹⁶");
        assert_eq!(power_of_ten(0.0), "1");
    }
}
