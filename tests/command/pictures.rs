//! `lie run --plot FILE --picture KIND`.

use std::path::Path;

use crate::common::{folder, lie};

/// The polylines of a picture that have something in their attributes, in pixels.
fn lines(svg: &str, attribute: &str) -> Vec<Vec<(f64, f64)>> {
    let found = svg
        .lines()
        .filter(|line| line.starts_with("<polyline") && line.contains(attribute));
    let points = |line: &str| -> Option<Vec<(f64, f64)>> {
        let points = line.split("points=\"").nth(1)?.split('"').next()?;
        let point = |text: &str| {
            let (x, y) = text.split_once(',')?;
            Some((x.parse().ok()?, y.parse().ok()?))
        };
        points.split(' ').map(point).collect()
    };
    found.map(|line| points(line).expect("points")).collect()
}

fn draw(folder: &Path, call: &str) -> String {
    let path = folder.join("picture.svg");
    lie(&format!(
        "run {call} --quiet --out {} --plot {}",
        folder.join("rows.csv").display(),
        path.display()
    ))
    .ok();
    let svg = std::fs::read_to_string(path).expect("a picture");
    assert!(svg.starts_with("<svg") && svg.trim_end().ends_with("</svg>"));
    assert!(!svg.contains("NaN") && !svg.contains("inf"), "{call}");
    svg
}

const BODY: &str = "specs/so3_free_rigid_body.json --step 0.05";
const TOP: &str = "specs/se3_heavy_top.json --step 0.05";

#[test]
fn the_orbit_of_a_body_is_a_sphere() {
    let folder = folder();
    let svg = draw(folder.path(), &format!("{BODY} --until 30 --picture orbit"));
    let outline: Vec<(f64, f64)> = lines(&svg, "stroke=\"#777\" stroke-width=\"1.2\"").concat();
    assert!(outline.len() > 60, "{}", outline.len());
    let middle = |of: fn(&(f64, f64)) -> f64| {
        let values = || outline.iter().map(of);
        0.5 * (values().fold(f64::MAX, f64::min) + values().fold(f64::MIN, f64::max))
    };
    let centre = (middle(|p| p.0), middle(|p| p.1));
    let radius = |p: &(f64, f64)| (p.0 - centre.0).hypot(p.1 - centre.1);
    let radii: Vec<f64> = outline.iter().map(radius).collect();
    let (low, high) = radii
        .iter()
        .fold((f64::MAX, 0.0_f64), |(a, b), r| (a.min(*r), b.max(*r)));
    assert!(high < 1.02 * low, "{low} {high}");
    // level curves and the trajectory stay inside
    for line in lines(&svg, "stroke=\"#a8a8a8\"")
        .iter()
        .chain(&lines(&svg, "stroke=\"#0072b2\""))
    {
        assert!(line.iter().all(|p| radius(p) < 1.02 * high));
    }
    assert!(lines(&svg, "stroke=\"#a8a8a8\"").len() >= 8);
    assert!(svg.contains("surface: norm2 as at the start") && !svg.contains("cut off"));
    // a cylinder is not closed
    let svg = draw(
        folder.path(),
        "specs/e2_pendulum.json --step 0.05 --until 20 --picture orbit",
    );
    assert!(svg.contains("cut off around the curve"));
}

#[test]
fn a_section_has_a_point_for_each_passage() {
    let folder = folder();
    let svg = draw(
        folder.path(),
        &format!("{TOP} --until 200 --picture section:m1=0.1"),
    );
    let dots = svg
        .lines()
        .find(|line| line.contains("stroke-linecap=\"round\""))
        .expect("dots");
    let rows = std::fs::read_to_string(folder.path().join("rows.csv")).expect("rows");
    let (header, rows) = crate::common::csv(&rows);
    let place = header
        .iter()
        .position(|name| name == "m1")
        .expect("a column");
    let passages = rows
        .windows(2)
        .filter(|pair| pair[0][place] < 0.1 && pair[1][place] >= 0.1);
    let passages = passages.count();
    assert!(passages > 20);
    assert_eq!(dots.matches('M').count(), passages);
    assert!(svg.contains("m1 rises through 0.1"));
    // none: it is said
    let path = folder.path().join("p.svg");
    let run = lie(&format!(
        "run {TOP} --until 5 --picture section:m1=1000 --out {} --plot {}",
        folder.path().join("rows.csv").display(),
        path.display()
    ));
    assert!(
        run.ok()
            .stderr
            .contains("warning: the section is never passed")
    );
}

#[test]
fn phase_attitude_and_several_runs() {
    let folder = folder();
    let svg = draw(
        folder.path(),
        "specs/canonical_pendulum.json --picture phase",
    );
    assert!(lines(&svg, "stroke=\"#c4c4c4\"").len() > 8 && svg.contains("level curves of H"));
    let svg = draw(
        folder.path(),
        &format!("{TOP} --until 5 --picture phase:g1,m3"),
    );
    assert!(svg.contains(">g1</text>") && svg.contains(">m3</text>"));
    for chart in ["matrix", "quaternion"] {
        let call = format!("{BODY} --until 30 --picture attitude --group {chart}");
        let svg = draw(folder.path(), &call);
        // it begins at the pole
        assert!(
            svg.contains("<circle")
                && !lines(&svg, "stroke=\"#0072b2\" stroke-width=\"1.6\"").is_empty()
        );
    }
    let several = "--method rk4 --method midpoint --method gauss4";
    let svg = draw(folder.path(), &format!("{TOP} --until 5 {several}"));
    for name in [
        "rk4",
        "midpoint",
        "gauss4",
        "error of energy",
        "error of length2",
    ] {
        assert!(svg.contains(name), "{name}");
    }
    let svg = draw(
        folder.path(),
        &format!("{BODY} --until 5 --param I1=1:2:5 --picture orbit"),
    );
    assert!(svg.contains("I1 = 1.25"));
}

/// How many places the discs of a picture have.
fn discs(svg: &str) -> usize {
    svg.matches("h0").count() + svg.matches("<circle").count()
}

#[test]
fn few_steps_are_dots_on_a_curve() {
    let folder = folder();
    let call = "specs/so3_free_rigid_body.json --tol 1e-9 --until 40";
    let rows = lie(&format!("run {call} --quiet")).ok().stdout;
    let steps = rows.lines().count() - 1;
    assert!(steps < 60, "{steps}");
    // what is drawn, and of how many curves
    for (kind, attribute, curves) in [
        ("components", "stroke-width=\"1.5\"", 3),
        ("orbit", "stroke=\"#0072b2\" stroke-width=\"1.6\"", 1),
        ("phase", "stroke-width=\"1.3\"", 1),
        ("attitude --group quaternion", "stroke-width=\"1.6\"", 1),
        ("compare", "stroke-width=\"1.3\"", 1),
    ] {
        let svg = draw(folder.path(), &format!("{call} --picture {kind}"));
        let longest = lines(&svg, attribute).iter().map(Vec::len).max();
        assert!(longest > Some(steps * 3 / 2), "{kind}: {longest:?}");
        assert!(discs(&svg) >= curves * steps, "{kind}: {}", discs(&svg));
        assert!(svg.contains("dots: the rows"), "{kind}");
        let written = std::fs::read_to_string(folder.path().join("rows.csv")).expect("rows");
        if !kind.contains("group") {
            assert_eq!(
                written, rows,
                "the rows are those of the run without a picture"
            );
        }
    }
    // no passage of the section is missed
    let section = |call: &str| {
        let call = format!("specs/so3_free_rigid_body.json {call} --until 400 --picture section");
        discs(&draw(folder.path(), &call))
    };
    assert_eq!(
        section("--tol 1e-3"),
        section("--method gauss8 --step 0.05")
    );
    // the control: short steps are a curve by themselves
    let svg = draw(folder.path(), &format!("{BODY} --until 30 --picture phase"));
    assert!(!svg.contains("dots: the rows") && discs(&svg) == 0);
}

#[test]
fn level_curves_are_those_of_all_runs_or_of_none() {
    let folder = folder();
    let pendulum = "specs/canonical_pendulum.json --until 5 --picture phase --param g=1";
    let body = format!("{BODY} --until 5 --picture orbit --param I2=2.5 --param I1=1");
    for (call, level) in [(pendulum, "#c4c4c4"), (&*body, "#a8a8a8")] {
        let stroke = format!("stroke=\"{level}\"");
        let said = "no level curves of H: parameters differ";
        let svg = draw(folder.path(), call);
        assert!(
            lines(&svg, &stroke).len() > 5 && !svg.contains(said),
            "{call}"
        );
        let svg = draw(folder.path(), &format!("{call}:2:3"));
        assert!(
            lines(&svg, &stroke).is_empty() && svg.contains(said),
            "{call}"
        );
        assert!(!svg.contains("level curves of H on it"), "{call}");
    }
    // a sweep of one method names it
    let svg = draw(folder.path(), &format!("{pendulum}:2:3"));
    assert!(svg.contains("3 runs of midpoint, h = 0.05"));
}

#[test]
fn an_energy_that_is_constant_on_the_orbit_has_no_level_curves() {
    let folder = folder();
    let equal = "--param I1=1 --param I2=1 --param I3=1";
    let svg = draw(
        folder.path(),
        &format!("{BODY} --until 5 {equal} --picture orbit"),
    );
    assert!(lines(&svg, "stroke=\"#a8a8a8\"").is_empty());
    assert!(svg.contains("surface: norm2 as at the start; H is constant on it"));
    assert!(svg.len() < 100_000, "{}", svg.len());
}

#[test]
fn a_curve_that_leaves_its_orbit_does_not_make_it_a_point() {
    let folder = folder();
    let path = folder.path().join("picture.svg");
    let run = lie(&format!(
        "run specs/so3_free_rigid_body.json --method rk4 --step 6 --until 600 --picture orbit --out {} --plot {}",
        folder.path().join("rows.csv").display(),
        path.display()
    ));
    assert!(!run.stderr.contains("point orbit"), "{}", run.stderr);
    let svg = std::fs::read_to_string(path).expect("a picture");
    assert!(svg.contains("curve has left it") && !svg.contains("an orbit by itself"));
}

#[test]
fn runs_from_many_states_are_named_by_their_numbers() {
    let folder = folder();
    let states = folder.path().join("states.csv");
    let rows = (0..40).map(|k| format!("0.{k:02},0.5\n"));
    std::fs::write(&states, rows.collect::<String>()).expect("states");
    let two = "--method midpoint --method gauss4 --picture phase";
    let call = format!(
        "specs/canonical_pendulum.json --until 1 {two} --initial-file {}",
        states.display()
    );
    let svg = draw(folder.path(), &call);
    assert!(svg.contains(">run 0, midpoint<") && svg.contains(">run 79, gauss4<"));
    assert!(!svg.contains(">gauss4<"));
}

#[test]
fn a_long_run_has_no_larger_file() {
    let folder = folder();
    let length = |until: u32, kind: &str| {
        draw(
            folder.path(),
            &format!("{TOP} --until {until} --picture {kind}"),
        )
        .len()
    };
    for kind in ["phase", "attitude --group matrix"] {
        let (short, long) = (length(5_000, kind), length(20_000, kind));
        assert!(
            2 * long < 5 * short && long < 2_500_000,
            "{kind}: {short} {long}"
        );
    }
}

#[test]
fn a_run_that_stops_early_is_said_to() {
    let folder = folder();
    let path = folder.path().join("picture.svg");
    let rows = folder.path().join("rows.csv");
    let draw = |call: &str| {
        let (rows, path) = (rows.display(), path.display());
        let run = lie(&format!("run {call} --quiet --out {rows} --plot {path}"));
        let svg = std::fs::read_to_string(folder.path().join("picture.svg"));
        (run.code, svg.expect("a picture"))
    };
    let spec = "specs/so3_nonpolynomial.json --until 30";
    let (code, svg) = draw(&format!("{spec} --method midpoint --method rk4 --step 3"));
    assert_eq!(code, Some(3));
    assert!(svg.contains("; midpoint stopped at t = ") && svg.contains("; rk4 stopped at t = 0;"));
    for kind in ["components", "orbit", "section", "phase"] {
        let (code, svg) = draw(&format!("{spec} --method rk4 --step 3 --picture {kind}"));
        assert_eq!(code, Some(3));
        assert!(svg.contains("; stopped at t = 0"), "{kind}");
    }
    // the control
    let (code, svg) = draw(&format!("{spec} --method midpoint --step 0.05"));
    assert!(code == Some(0) && !svg.contains("stopped"));
}

/// Each form is written, or refused before anything runs, by a program that was built without it.
#[test]
fn pixels_and_pages() {
    let folder = folder();
    for (name, start, built) in [
        ("p.SVG", &b"<svg"[..], true),
        ("p.png", b"\x89PNG", cfg!(feature = "raster")),
        ("p.pdf", b"%PDF", cfg!(feature = "raster")),
    ] {
        let path = folder.path().join(name);
        let rows = folder.path().join(name).with_extension("csv");
        let run = lie(&format!(
            "run {BODY} --quiet --until 5 --out {} --plot {}",
            rows.display(),
            path.display()
        ));
        if built {
            run.ok();
            let bytes = std::fs::read(&path).expect("a picture");
            assert!(bytes.starts_with(start) && bytes.len() > 5_000, "{name}");
        } else {
            let run = run.error("option", "command line: --plot");
            assert!(run.stderr.contains("--features raster"), "{}", run.stderr);
            assert!(!path.exists());
        }
        _ = std::fs::remove_file(rows);
    }
}

#[test]
fn mistakes() {
    let of = |spec: &str, flags: &str| lie(&format!("run specs/{spec}.json {flags}"));
    let top = |flags: &str| of("se3_heavy_top", flags);
    top("--picture orbit").error("option", "command line: --picture");
    for picture in [
        "orbit",
        "attitude",
        "attitud",
        "phase:m1",
        "phase:m1,m9",
        "section:m9=1",
        "section:m1=x+",
        "compare:m1",
    ] {
        let run = top(&format!("--plot a.svg --picture {picture}"));
        assert_eq!(run.code, Some(2), "{picture}: {}", run.stderr);
        assert!(
            run.stderr.contains("command line: --picture") && run.stderr.contains("help: "),
            "{picture}"
        );
    }
    // groups that have no rotations of space
    for spec in [
        "e2_pendulum",
        "heisenberg_h3",
        "so4_manakov",
        "su3_quadratic",
    ] {
        of(spec, "--plot a.svg --picture attitude --group matrix")
            .error("option", "command line: --picture");
    }
    top("--plot a.jpg").error("option", "command line: --plot");
    of("canonical_pendulum", "--plot a.svg --picture section")
        .error("option", "command line: --picture");
    top("--plot a.svg --picture components --method rk4 --method gauss4")
        .error("option", "command line: --plot");
    assert!(!Path::new("a.svg").exists() && !Path::new("a.jpg").exists());
}

/// What keeps its orbit is drawn on it, and why other motion is not is said as it is.
#[test]
fn motion_that_stays_on_its_orbit_is_drawn_there() {
    let folder = folder();
    let path = folder.path().join("spec.json");
    let spec = |more: &str| {
        let text = format!(
            r#"{{"format": 1, "name": "Spin", "algebra": "so(3)", "state": ["x", "y", "z"], "inputs": {{"u": {{"default": 0}}}},
            "hamiltonian": "x^2/4 + y^2/3 + z^2/2", "initial": [0.6, 1.1, 0.2], {more}}}"#
        );
        std::fs::write(&path, text).unwrap();
        path.display().to_string()
    };
    let call = |spec: &str, kind: &str| {
        lie(&format!(
            "run {spec} --until 5 --step 0.05 --picture {kind} --plot {}",
            folder.path().join("refused.svg").display()
        ))
    };
    let damped = r#""dissipation": [{"kind": "double-bracket", "strength": "1/5"}]"#;
    let shaken = r#""noise": [{"hamiltonian": "x/5"}]"#;
    for acting in [damped, shaken] {
        let svg = draw(
            folder.path(),
            &format!(
                "{} --method lie-midpoint --step 0.05 --until 20 --picture orbit",
                spec(acting)
            ),
        );
        let levels = lines(&svg, "stroke=\"#a8a8a8\"").len();
        let curve = lines(&svg, "stroke=\"#0072b2\"").concat();
        assert!(levels > 5 && curve.len() > 100, "{levels} {}", curve.len());
    }
    let gentle = r#""dissipation": [{"kind": "metriplectic", "entropy": "3*(x^2 + y^2 + z^2)/20",
        "factor": [["0", "z", "-2*y/3"], ["-z", "0", "x/2"], ["2*y/3", "-x/2", "0"]]}]"#;
    for (acting, kind, says) in [
        (gentle, "orbit", "the motion leaves its orbit"),
        (gentle, "section", "more than H acts on Spin"),
        (damped, "section", "more than H acts on Spin"),
        (
            r#""forces": {"x": "-x"}"#,
            "orbit",
            "the motion leaves its orbit",
        ),
        (
            r#""hamiltonian": "x^2 + u*z""#,
            "orbit",
            "H of Spin changes with the time",
        ),
        (
            r#""hamiltonian": "x^2 + t*z""#,
            "section",
            "H of Spin changes with the time",
        ),
    ] {
        let mut text = spec(acting);
        if acting.contains("\"hamiltonian\"") {
            let known = std::fs::read_to_string(&text).unwrap();
            let one = r#""hamiltonian": "x^2/4 + y^2/3 + z^2/2", "#;
            std::fs::write(&path, known.replacen(one, "", 1)).unwrap();
            text = path.display().to_string();
        }
        let run = call(&text, kind).error("option", "command line: --picture");
        let said = run.stderr.split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(said.contains(says), "{kind}: {said}");
        assert!(!said.contains("energy of Spin varies"), "{said}");
    }
}
