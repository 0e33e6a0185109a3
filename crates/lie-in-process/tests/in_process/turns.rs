//! Members that choose their own steps take turns in lanes: none waits for another, and each has the bits that it has alone.

use lie_codegen::compile::{compile_spec, with_options};
use lie_codegen::methods::Choice;
use lie_codegen::plan::plan;
use lie_dynamic::{Declared, Dynamic, Tolerances};
use lie_in_process::members::{LANES, Member, Members, Watch, take_turns};
use lie_jit::Jit;
use lie_methods::method_in_lanes;
use lie_runtime::Scalar;
use lie_runtime::diagnostics::Forgotten;
use lie_runtime::driver::{Crew, Options, Save, relay};

type Wide = <f64 as Scalar>::Wide;

const COUNT: usize = 37;

fn declared(name: &str, choices: &[Choice]) -> Declared {
    let path = format!("{}/../../specs/{name}.json", env!("CARGO_MANIFEST_DIR"));
    let model = compile_spec(&std::fs::read_to_string(path).unwrap()).unwrap();
    Declared::new(plan(&model, &with_options(&model, choices)), &Jit)
}

fn choices() -> [Choice; 2] {
    ["taylor", "dopri5"].map(|id| Choice::from_id(id).unwrap())
}

/// States between a tenth and three times the declared one: fast and slow motions.
fn starts(declared: &Declared) -> Vec<Vec<f64>> {
    let start = declared.system(&[]).unwrap().initial_state().unwrap();
    let factor = |member: usize| 0.1 + 2.9 * ((member * 17) % COUNT) as f64 / COUNT as f64;
    let state = |member| start.iter().map(|x| x * factor(member)).collect();
    (0..COUNT).map(state).collect()
}

fn bits(member: &Member) -> Vec<u64> {
    let numbers = member.times.iter().chain(&member.states);
    numbers.map(|x| x.to_bits()).collect()
}

/// The members that are not the same as alone.
fn different(members: &Members<'_>) -> Vec<usize> {
    let watch = Watch::default();
    let found = members.run(0..members.starts.len(), &watch);
    assert_eq!(watch.done.into_inner(), found.len());
    let alone = |member| members.run(member..member + 1, &Watch::default()).remove(0);
    let same =
        |one: &Member, other: &Member| bits(one) == bits(other) && one.failed == other.failed;
    let differ = found.iter().enumerate();
    differ
        .filter_map(|(member, one)| (!same(one, &alone(member))).then_some(member))
        .collect()
}

#[test]
fn members_have_the_bits_that_they_have_alone() {
    let all = [
        // one step of the grid, many, backwards, rows, a step from a tolerance, a row off the grid
        (Options::new(6.0), 6.0),
        (Options::new(0.01), 0.5),
        (Options::new(-0.5).save(Save::Every(3)), -6.0),
        (Options::new(0.25).save(Save::At(vec![0.0, 1.5, 6.0])), 6.0),
        (Options::tolerance(1e-7), 6.0),
        (Options::new(0.35), 6.0),
    ];
    for name in ["so3_free_rigid_body", "so3_nonpolynomial"] {
        let choices = choices();
        let declared = declared(name, &choices);
        let tolerances = [(1e-8, 1e-9), (1e-5, 1e-6)];
        for (choice, (rtol, atol)) in choices
            .iter()
            .flat_map(|one| tolerances.map(|two| (one, two)))
        {
            for (options, end) in &all {
                let save = match &options.save {
                    Save::Every(1) => Save::Ends,
                    other => other.clone(),
                };
                let mut members = Members {
                    declared: &declared,
                    choice,
                    tolerances: Tolerances { rtol, atol },
                    parameters: vec![Vec::new()],
                    starts: starts(&declared),
                    count: COUNT,
                    options: options.clone().save(save),
                    span: (0.0, *end),
                    held: Default::default(),
                    sources: Default::default(),
                    events: false,
                };
                let what = format!("{name}, {}, {options:?}", choice.label());
                assert!(take_turns(choice, members.tolerances));
                members.starts[4][0] = f64::NAN;
                assert_eq!(different(&members), [0; 0], "{what}");
            }
        }
    }
}

/// Those with the same parameters take turns, and single ones between them do not.
#[test]
fn parameters_may_differ() {
    let choices = choices();
    let declared = declared("se3_heavy_top", &choices);
    let defaults = declared.system(&[]).unwrap().parameters().to_vec();
    for choice in &choices {
        let mut members = Members {
            declared: &declared,
            choice,
            tolerances: Tolerances::default(),
            parameters: vec![defaults.clone(); COUNT],
            starts: starts(&declared),
            count: COUNT,
            options: Options::new(10.0).save(Save::Ends),
            span: (0.0, 10.0),
            held: Default::default(),
            sources: Default::default(),
            events: false,
        };
        for (member, values) in members.parameters.iter_mut().enumerate() {
            values[0] *= 1.0 + (member / 10) as f64;
        }
        members.parameters[9][1] *= 2.0;
        members.parameters[25][0] = 0.0;
        assert_eq!(different(&members), [0; 0], "{}", choice.label());
    }
}

/// Who left when.
struct Order {
    starts: Vec<Vec<f64>>,
    next: usize,
    lanes: [usize; LANES],
    left: Vec<usize>,
}

impl Crew<Wide, Vec<Wide>> for Order {
    fn enter(&mut self, lane: usize, mu: &mut Vec<Wide>) -> Option<f64> {
        let start = self.starts.get(self.next)?;
        for (entry, value) in mu.iter_mut().zip(start) {
            *entry = entry.with_lane(lane, *value);
        }
        self.lanes[lane] = self.next;
        self.next += 1;
        Some(10.0)
    }

    fn row(&mut self, _lane: usize, _time: f64, _mu: &Vec<Wide>) {}

    fn leave(&mut self, lane: usize, is_at_end: bool) {
        assert!(is_at_end);
        self.left.push(self.lanes[lane]);
    }

    fn stops(&self) -> bool {
        false
    }
}

#[test]
fn none_waits_for_a_slow_one() {
    let choices = choices();
    let declared = declared("so3_free_rigid_body", &choices);
    let system = declared.system(&[]).unwrap();
    let lanes = Dynamic::in_lanes(&[&system]);
    for choice in &choices {
        let method = method_in_lanes(choice, Tolerances::default()).unwrap();
        let mut order = Order {
            starts: vec![vec![0.1, 0.2, 0.1]; COUNT],
            next: 0,
            lanes: [0; LANES],
            left: Vec::new(),
        };
        order.starts[3] = vec![30.0, 20.0, 10.0];
        let options = Options::new(10.0).save(Save::Ends);
        let method = Forgotten(method.as_ref());
        assert!(relay(&lanes, &method, ((0.0, 10.0), &options), &mut order).unwrap());
        assert_eq!(order.left.len(), COUNT);
        assert_eq!(order.left.last(), Some(&3), "{}", choice.label());
    }
}
