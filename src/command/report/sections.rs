//! The sections of the page.

use std::fs::File;
use std::io::{BufRead as _, BufReader};

use lie_codegen::structure::Structure;
use lie_in_process::request::{Front, method};

use super::call::CommandOutput;
use super::scene::{self, Curve};
use super::{Report, mathematics};
use crate::build;
use crate::command::run::picture::choice::no_orbit;
use crate::message::{Failure, STOPPED};
use crate::render;

/// Methods that are compared where none are given: those of them that apply.
const COMPARED: [&str; 7] = [
    "lie-midpoint",
    "midpoint",
    "gauss4",
    "gauss8",
    "splitting4",
    "rk4",
    "dopri5",
];
/// The rows of the trajectory, and what lies between them.
const ROWS: &str = "rows.csv";
const BETWEEN: &str = "curve.csv";
/// Trajectories of fewer rows are drawn by so many.
const CURVE: usize = 2000;
/// Seconds that a single run of the comparison may take.
const BUDGET: &str = "0.02";

impl Report<'_> {
    pub(super) fn mathematics(&mut self) -> Result<(), Failure> {
        let words = ["check".to_owned(), self.spec_word()];
        let Some((line, said)) = self.call(&words, &[])? else {
            return Ok(());
        };
        self.page.section("The system");
        let model = &self.spec.model;
        for (title, formulas) in mathematics::formulas(model) {
            self.page.text(title);
            self.page.formulas(&formulas);
        }
        let text = std::fs::read_to_string(&self.flags.spec).unwrap_or_default();
        self.page.folded("The declaration", &text);
        self.page.section("What is known of it");
        self.page.command(&line);
        // methods and operations are long, and stand at the end
        let (known, rest) = said
            .out
            .split_once("  operations ")
            .unwrap_or((&said.out, ""));
        self.page.preformatted(known);
        self.page.preformatted(&said.error);
        if !rest.is_empty() {
            self.page.folded(
                "Operations of its kernels, and the methods that apply",
                &format!("  operations {rest}"),
            );
        }
        Ok(())
    }

    /// Its rows, components over time, and where it moves.
    pub(super) fn trajectory(&mut self) -> Result<(), Failure> {
        let methods: Vec<String> = self.flags.method.first().into_iter().cloned().collect();
        let words = self.run_words(&methods);
        let files = [("--out", ROWS), ("--plot", "components.svg")];
        let Some((line, said)) = self.call(&words, &files)? else {
            return Ok(());
        };
        self.page.section("A trajectory");
        self.page.command(&line);
        self.ended(&said);
        self.figure("components.svg");
        self.space(&words)
    }

    /// What a run said, and whether it stopped early.
    fn ended(&mut self, said: &CommandOutput) {
        match said.code {
            0 => self.page.preformatted(&said.error),
            code => {
                self.code = self.code.max(code);
                let text = if code == STOPPED {
                    "The run stopped early; what was computed before is shown."
                } else {
                    "The run failed."
                };
                self.page.text(text);
                self.page.stopped(&said.error);
                render::say(&said.error);
            }
        }
    }

    fn figure(&mut self, file: &str) {
        if let Ok(svg) = std::fs::read_to_string(self.folder.join(file))
            && svg.contains("<svg")
        {
            self.page.picture(&svg);
        }
    }

    /// The orbit of a three-dimensional algebra, the phase portrait of a plane.
    fn space(&mut self, words: &[String]) -> Result<(), Failure> {
        let model = &self.spec.model;
        match model.counts().0 {
            3 if model.family.is_none() && no_orbit(model).is_none() => {
                let file = self.curve(words)?;
                if let Some(scene) = self.scene(file) {
                    let surface = leaf(model);
                    self.page.section(&format!("On its {surface}"));
                    self.page
                        .scene(&scene, &format!("The trajectory on its {surface}"));
                    let cut = if scene["closed"] == true {
                        ""
                    } else {
                        "; it is cut off around the trajectory"
                    };
                    let grey = if scene["constant"] == true {
                        "The energy is constant on it; grey: lines on which a coordinate is constant."
                    } else {
                        "Grey: level curves of the energy."
                    };
                    self.page.note(&format!(
                        "The surface is the {surface}, on which the Casimir has the value of the start{cut}. {grey} The dot is \
                         where the trajectory starts; what is turned away is pale."
                    ));
                }
                Ok(())
            }
            2 if model.family.is_none() => {
                let picture = [words, &["--picture".to_owned(), "phase".to_owned()]].concat();
                let Some((line, _)) =
                    self.call(&picture, &[("--out", "phase.csv"), ("--plot", "phase.svg")])?
                else {
                    return Ok(());
                };
                self.page.section("Its phase portrait");
                self.page.command(&line);
                self.figure("phase.svg");
                Ok(())
            }
            _ => Ok(()),
        }
    }

    /// The file with points of the trajectory: its rows, or where these are few, more of them at equal distances.
    fn curve(&mut self, words: &[String]) -> Result<&'static str, Failure> {
        let rows = std::fs::read_to_string(self.folder.join(ROWS)).unwrap_or_default();
        let times = rows
            .lines()
            .skip(1)
            .filter_map(|line| line.split(',').next());
        let times: Vec<&str> = times.take(CURVE + 1).collect();
        let (Some(first), Some(last)) = (times.first(), times.last()) else {
            return Ok(ROWS);
        };
        if times.len() > CURVE || first == last {
            return Ok(ROWS);
        }
        let range = ["--rows".to_owned(), format!("{first}:{last}:{CURVE}")];
        let words = [words, &range, &["--quiet".to_owned()]].concat();
        let drawn = self.attempt(&words, &[("--out", BETWEEN)])?;
        // of a run that stops early, the rows are what there is
        let whole = drawn.is_some_and(|(_, said)| said.code == 0);
        Ok(if whole { BETWEEN } else { ROWS })
    }

    fn scene(&self, file: &str) -> Option<serde_json::Value> {
        let rows = File::open(self.folder.join(file)).ok()?;
        let mut lines = BufReader::new(rows).lines().map_while(Result::ok);
        let names: Vec<String> = lines
            .next()?
            .split(',')
            .skip(1)
            .take(3)
            .map(str::to_owned)
            .collect();
        let mut curve = Curve::default();
        for line in lines {
            let entries = line.split(',').skip(1).take(3);
            let entries = entries.map(|entry| entry.parse::<f64>().ok().filter(|x| x.is_finite()));
            let Some(&[x, y, z]) = entries.collect::<Option<Vec<f64>>>().as_deref() else {
                break;
            };
            curve.push([x, y, z]);
        }
        let system = build::declared(&self.spec.model)?
            .system(&self.start.parameters)
            .ok()?;
        scene::scene(&system, &names, &curve)
    }

    pub(super) fn comparison(&mut self) -> Result<(), Failure> {
        let words = self.run_words(&self.flags.method);
        let files = [("--out", "runs.csv"), ("--plot", "compare.svg")];
        let Some((line, said)) = self.call(&words, &files)? else {
            return Ok(());
        };
        self.page.section("The methods side by side");
        self.page.command(&line);
        self.ended(&said);
        self.figure("compare.svg");
        Ok(())
    }

    pub(super) fn bench(&mut self) -> Result<(), Failure> {
        let methods = match self.flags.method.as_slice() {
            [] | [_] => {
                let apply = COMPARED.iter().map(|id| (*id).to_owned());
                let apply = apply.filter(|id| {
                    method::labelled(id, Front::Command)
                        .is_ok_and(|choice| method::applies(choice, &self.spec.model).is_ok())
                });
                let own = self
                    .flags
                    .method
                    .iter()
                    .filter(|own| !COMPARED.contains(&own.as_str()))
                    .cloned();
                apply.chain(own).collect::<Vec<_>>()
            }
            several => several.to_vec(),
        };
        let mut words = vec![
            "bench".to_owned(),
            self.spec_word(),
            "--methods".to_owned(),
            methods.join(","),
        ];
        words.extend(["--budget".to_owned(), BUDGET.to_owned()]);
        for (flag, value) in [
            ("--until", &self.flags.until),
            ("--initial", &self.flags.initial),
        ] {
            words.extend(
                value
                    .iter()
                    .flat_map(|value| [flag.to_owned(), value.clone()]),
            );
        }
        words.extend(
            self.flags
                .param
                .iter()
                .flat_map(|value| ["--param".to_owned(), value.clone()]),
        );
        // what a comparison alone cannot do, at an equilibrium for one, is said in its section
        let Some((line, said)) = self.attempt(&words, &[("--plot", "bench.svg")])? else {
            return Ok(());
        };
        self.page.section("Error against run time");
        self.page.command(&line);
        self.figure("bench.svg");
        match said.code {
            0 => self.page.folded("The measured values", &said.out),
            _ => self.page.stopped(&said.error),
        }
        Ok(())
    }

    pub(super) fn code(&mut self) -> Result<(), Failure> {
        let mut words = vec!["expand".to_owned(), self.spec_word()];
        words.extend(
            self.flags
                .method
                .first()
                .into_iter()
                .flat_map(|method| ["--method".to_owned(), method.clone()]),
        );
        let Some((line, said)) = self.call(&words, &[])? else {
            return Ok(());
        };
        self.page.section("The generated code");
        self.page.command(&line);
        match said.code {
            0 => self.page.folded(
                &format!("{} lines of Rust", said.out.lines().count()),
                &said.out,
            ),
            _ => self.page.stopped(&said.error),
        }
        Ok(())
    }
}

/// What the level surface of the Casimir of a three-dimensional system is called.
fn leaf(model: &Structure) -> &'static str {
    match model.bracket.algebra() {
        Some(_) => "coadjoint orbit",
        None if model.is_almost_poisson() => "level surface",
        None => "symplectic leaf",
    }
}
