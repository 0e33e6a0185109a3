//! A heavy top near Lagrange's: its Poincaré section, and the frequencies of its motion in windows of a long run.

use crate::contest::{Entrant, Problem, Setting};
use crate::frequency::{refined, strongest};
use crate::table;
use lie_plot::chart::{Axis, Chart, Panel, Series, Stroke};
use lie_runtime::diagnostics::reference;
use lie_runtime::{Poisson, State};

/// Passages that are kept from the beginning of a run, and from its end.
const PASSAGES: usize = 2000;
/// Windows of a run.
const WINDOWS: usize = 10;

/// A point of the section: the vertical and the momentum along the third axis of the body.
type Point = (f64, f64);

/// What is seen of a run.
pub struct Seen {
    first: Vec<Point>,
    last: Vec<Point>,
    /// Angular frequencies in each window: of the vertical turning in the body, and of its nodding.
    turning: Vec<f64>,
    nodding: Vec<f64>,
    energy: f64,
}

/// The point at which m1 passes 0, from a state nearby, along the exact flow.
fn section<P: Poisson<f64>>(system: &P, near: &P::State) -> Option<Point> {
    let mut mu = near.clone();
    let mut field = system.zero_state();
    for _ in 0..50 {
        system.vector_field(&mu, &mut field);
        let step = (-mu.as_slice()[0] / field.as_slice()[0]).clamp(-0.2, 0.2);
        if step.abs() < 1e-15 {
            let mu = mu.as_slice();
            return Some((mu[5], mu[2]));
        }
        mu = reference(system, &mu, step)?.mu;
    }
    None
}

/// The strongest lines of one window; the guesses are those of the window before.
fn lines(window: &[[f64; 3]], dt: f64, guess: &mut Option<(f64, f64)>) -> (f64, f64) {
    let count = window.len() as f64;
    let mean = window.iter().map(|g| g[2]).sum::<f64>() / count;
    let turning: Vec<(f64, f64)> = window.iter().map(|g| (g[0], g[1])).collect();
    let nodding: Vec<(f64, f64)> = window.iter().map(|g| (g[2] - mean, 0.0)).collect();
    let (a, b) =
        *guess.get_or_insert_with(|| (strongest(&turning, dt), strongest(&nodding, dt).abs()));
    let found = (refined(&turning, dt, a), refined(&nodding, dt, b));
    *guess = Some(found);
    found
}

/// A run until a time.
pub fn look<P: Poisson<f64>>(
    problem: &Problem<P>,
    entrant: &Entrant<P>,
    setting: Setting,
    until: f64,
) -> Result<Seen, String> {
    let system = &problem.system;
    let dt = match setting {
        Setting::Steps(steps) if steps < 1.0 => problem.delta / steps,
        _ => problem.delta,
    };
    let each = (until / dt / WINDOWS as f64).floor() as usize;
    let mut seen = Seen {
        first: Vec::new(),
        last: Vec::new(),
        turning: Vec::new(),
        nodding: Vec::new(),
        energy: 0.0,
    };
    let mut window: Vec<[f64; 3]> = Vec::with_capacity(each);
    let mut guess = None;
    let mut before = problem.start.clone();
    let mut now = problem.start.clone();
    let mut late: std::collections::VecDeque<P::State> = Default::default();
    let start = system.energy(&problem.start);
    (entrant.run)(problem, setting, until, &mut |_, state| {
        now.as_mut_slice().copy_from_slice(state);
        seen.energy = seen
            .energy
            .max(((system.energy(&now) - start) / start).abs());
        let (then, here) = (before.as_slice()[0], state[0]);
        if then < 0.0 && here >= 0.0 {
            let near = if here < -then { &now } else { &before };
            if seen.first.len() < PASSAGES {
                seen.first.extend(section(system, near));
            }
            late.push_back(near.clone());
            if late.len() > PASSAGES {
                late.pop_front();
            }
        }
        window.push([state[3], state[4], state[5]]);
        if window.len() == each {
            let (turning, nodding) = lines(&window, dt, &mut guess);
            seen.turning.push(turning);
            seen.nodding.push(nodding);
            window.clear();
        }
        std::mem::swap(&mut before, &mut now);
    })?;
    seen.last = late
        .iter()
        .filter_map(|near| section(system, near))
        .collect();
    Ok(seen)
}

/// The distance of a point from the curve through others: from a parabola through its nearest.
fn distance((x, y): Point, curve: &[Point]) -> f64 {
    const NEAREST: usize = 10;
    let mut near: Vec<(f64, Point)> = curve
        .iter()
        .map(|&(a, b)| ((a - x).hypot(b - y), (a - x, b - y)))
        .collect();
    if near.len() < NEAREST {
        return f64::NAN;
    }
    near.select_nth_unstable_by(NEAREST - 1, |a, b| a.0.total_cmp(&b.0));
    let near: Vec<Point> = near[..NEAREST].iter().map(|n| n.1).collect();
    let count = NEAREST as f64;
    let mean = |of: fn(&Point) -> f64| near.iter().map(of).sum::<f64>() / count;
    let (a, b) = (mean(|p| p.0), mean(|p| p.1));
    let sum = |of: &dyn Fn(f64, f64) -> f64| near.iter().map(|p| of(p.0 - a, p.1 - b)).sum::<f64>();
    let (xx, xy, yy) = (sum(&|x, _| x * x), sum(&|x, y| x * y), sum(&|_, y| y * y));
    let angle = 0.5 * (2.0 * xy).atan2(xx - yy);
    let (s, c) = angle.sin_cos();
    // along and across; the parabola by least squares
    let turned: Vec<Point> = near
        .iter()
        .map(|p| ((p.0 - a) * c + (p.1 - b) * s, (p.1 - b) * c - (p.0 - a) * s))
        .collect();
    let scale = turned
        .iter()
        .fold(0.0_f64, |m, p| m.max(p.0.abs()))
        .max(1e-300);
    let mut normal = [[0.0; 4]; 3];
    for (u, v) in &turned {
        let u = u / scale;
        let powers = [1.0, u, u * u];
        for i in 0..3 {
            for j in 0..3 {
                normal[i][j] += powers[i] * powers[j];
            }
            normal[i][3] += powers[i] * v;
        }
    }
    for i in 0..3 {
        for k in i + 1..3 {
            let factor = normal[k][i] / normal[i][i];
            for j in i..4 {
                normal[k][j] -= factor * normal[i][j];
            }
        }
    }
    let q = normal[2][3] / normal[2][2];
    let l = (normal[1][3] - normal[1][2] * q) / normal[1][1];
    let m = (normal[0][3] - normal[0][2] * q - normal[0][1] * l) / normal[0][0];
    let (u, v) = ((-a * c - b * s) / scale, -b * c + a * s);
    (v - m - l * u - q * u * u).abs()
}

/// The root of the mean square distance of points from a curve.
fn scatter(points: &[Point], curve: &[Point]) -> f64 {
    let squares = points.iter().map(|&point| distance(point, curve).powi(2));
    (squares.sum::<f64>() / points.len().max(1) as f64).sqrt()
}

/// The dearest accuracy that costs at most so much, and what it costs.
pub fn dearest<P: Poisson<f64>>(
    problem: &Problem<P>,
    entrant: &Entrant<P>,
    most: f64,
) -> Option<(Setting, f64)> {
    let mut best = None;
    for &setting in &entrant.settings {
        if matches!(setting, Setting::Steps(steps) if problem.delta / steps > 2.1) {
            continue;
        }
        let Ok(cost) = (entrant.cost)(problem, setting) else {
            continue;
        };
        // implicit steps that are too long are dear too
        if cost > most && (best.is_some() || matches!(setting, Setting::Tolerance(_))) {
            break;
        }
        if cost <= most {
            best = Some((setting, cost));
        }
    }
    best
}

/// A row of a method at a cost.
struct Row {
    name: String,
    cost: f64,
    text: String,
    seen: Result<Seen, String>,
}

/// The table and the picture, at costs.
pub fn report<P: Poisson<f64>>(
    problem: &Problem<P>,
    entrants: &[Entrant<P>],
    exact: &Seen,
    until: f64,
    costs: &[f64],
) -> (String, String) {
    let mut text = String::new();
    let curve: Vec<Point> = exact.first.iter().chain(&exact.last).copied().collect();
    let mut shown = Vec::new();
    for &most in costs {
        let mut rows = Vec::new();
        for entrant in entrants {
            let Some((setting, cost)) = dearest(problem, entrant, most) else {
                continue;
            };
            let seen = look(problem, entrant, setting, until);
            eprintln!("{} at {:.2} µs", entrant.name, cost * 1e6);
            let text = setting.text(problem.delta);
            rows.push(Row {
                name: entrant.name.clone(),
                cost,
                text,
                seen,
            });
        }
        text.push_str(&format!(
            "at most {} µs of the processor for a unit of time:\n\n",
            table::rounded(most * 1e6)
        ));
        text.push_str(&table::text(&cells(&rows, exact, &curve)));
        text.push('\n');
        if shown.is_empty() {
            shown = rows;
        }
    }
    let even: Vec<Point> = exact.first.iter().step_by(2).copied().collect();
    let odd: Vec<Point> = exact.first.iter().skip(1).step_by(2).copied().collect();
    text.push_str(&format!(
        "the reference: taylor with tolerance 1e-16; turning {:.12}, nodding {:.12}, their drift {:.0e} and {:.0e}; every second of its \
         points lies within {:.0e} of the curve of the others\n",
        exact.turning[0],
        exact.nodding[0],
        change(&exact.turning),
        change(&exact.nodding),
        scatter(&odd, &even)
    ));
    (text, picture(&shown, exact, until))
}

/// From the first window to the last.
fn change(values: &[f64]) -> f64 {
    values.last().copied().unwrap_or(f64::NAN) - values.first().copied().unwrap_or(f64::NAN)
}

fn cells(rows: &[Row], exact: &Seen, curve: &[Point]) -> Vec<Vec<String>> {
    let head = [
        "method",
        "at",
        "µs",
        "energy",
        "section, begin",
        "section, end",
        "turning, offset",
        "drift",
        "nodding, offset",
        "drift",
    ];
    let mut cells = vec![head.map(str::to_owned).to_vec()];
    for row in rows {
        let mut line = vec![
            row.name.clone(),
            row.text.clone(),
            format!("{:.2}", row.cost * 1e6),
        ];
        match &row.seen {
            Err(why) => line.push(why.clone()),
            Ok(seen) => {
                let signed = |value: f64| format!("{value:+.1e}");
                line.push(format!("{:.1e}", seen.energy));
                line.extend(
                    [&seen.first, &seen.last]
                        .map(|points| format!("{:.1e}", scatter(points, curve))),
                );
                for (found, exact) in [
                    (&seen.turning, &exact.turning),
                    (&seen.nodding, &exact.nodding),
                ] {
                    line.push(signed(found[0] - exact[0]));
                    line.push(signed(change(found)));
                }
            }
        }
        cells.push(line);
    }
    cells
}

fn picture(rows: &[Row], exact: &Seen, until: f64) -> String {
    let dots = |name: &str, colour, stroke, points: &[Point]| Series {
        name: name.to_owned(),
        colour,
        stroke,
        points: points.iter().take(900).copied().collect(),
    };
    let mut panels = Vec::new();
    for row in rows {
        let Ok(seen) = &row.seen else { continue };
        panels.push(Panel {
            title: format!("{}, {}", row.name, row.text),
            x: Axis::linear("vertical along the third axis, g3"),
            y: Axis::linear("momentum m3"),
            series: vec![
                dots("exact", 0, Stroke::Behind, &exact.first),
                dots("at the beginning", 0, Stroke::Dots, &seen.first),
                dots("at the end", 1, Stroke::Dots, &seen.last),
            ],
        });
    }
    Chart {
        title: "Heavy top near Lagrange's: where m1 passes 0 upward".to_owned(),
        subtitle: format!("Beginning and end of runs to t = {until}, at equal cost; the exact points lie on a curve"),
        panels,
        across: 4,
    }
    .to_svg()
}
