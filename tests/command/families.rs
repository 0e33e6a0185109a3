//! `lie check`, `lie expand` and `lie run` on families.

use crate::common::{folder, lie};

const CHAIN: &str = "tests/data/families/heisenberg_chain.json";

#[test]
fn check_says_how_large_a_family_is_and_what_applies() {
    let run = lie(&format!("check {CHAIN}")).ok();
    // a sentence goes on in lines that are indented further
    let stdout = run.stdout.replace("\n        ", " ");
    for text in [
        "a chain of 1000 sites: dimension 3000, generic rank 2000, 1000 independent Casimirs",
        "H = -J*sum(i in 0..N: x[i]*x[i+1] + y[i]*y[i+1] + z[i]*z[i+1])",
        "splitting: H is 1 piece with an exact flow at each site",
        "exchange with [+1]",
        "C1 = x^2 + y^2 + z^2",
        "field of a site",
        "a family keeps no matrix",
    ] {
        assert!(stdout.contains(text), "{text}: {stdout}");
    }
    let run = lie(&format!("check {CHAIN} --json")).ok();
    let json: serde_json::Value = serde_json::from_str(&run.stdout).expect("JSON");
    assert_eq!(
        (&json["dimension"], &json["generic_rank"]),
        (&3000.into(), &2000.into())
    );
    assert!(json["methods"]["gauss16"].is_null() && json["methods"]["splitting4"].is_null());
    assert!(json["methods"]["midpoint"].is_string());
    let run = lie("check tests/data/families/mean_field_pieces.json").ok();
    for text in ["F(sums over x)", "F(sums over z)", "f(y)", "z*z[+1]"] {
        assert!(run.stdout.contains(text), "{text}: {}", run.stdout);
    }
    let run = lie("check tests/data/families/mean_field.json").ok();
    let why = "splitting: none: H mixes sums over `x` and over `y`";
    assert!(run.stdout.contains(why), "{}", run.stdout);
    let run = lie("check tests/data/families/open_chain.json").ok();
    let why = "splitting: none: `x[i-1]`, `y[i]` and `z[i+1]` are coupled by more than products";
    assert!(run.stdout.contains(why), "{}", run.stdout);
}

#[test]
fn one_program_runs_any_number_of_sites() {
    let folder = folder();
    for (n, width) in [(4, 13), (70, 211)] {
        let out = folder.path().join(format!("{n}.csv"));
        let call = format!(
            "run {CHAIN} --param N={n} --until 2 --out {}",
            out.display()
        );
        let run = lie(&call).ok();
        assert!(run.stderr.contains("C1_max"), "{}", run.stderr);
        let text = std::fs::read_to_string(&out).expect("rows");
        let mut lines = text.lines();
        let header = lines.next().expect("a header");
        assert!(header.starts_with("t,x[0],x[1],x[2],x[3],"), "{header}");
        assert!(
            header.ends_with(",energy,C1_mean,C1_min,C1_max"),
            "{header}"
        );
        assert_eq!(header.split(',').count(), width + 4);
        let energies: Vec<f64> = lines
            .map(|line| {
                line.split(',')
                    .nth(width)
                    .and_then(|x| x.parse().ok())
                    .expect("a number")
            })
            .collect();
        let (first, last) = (energies[0], energies[energies.len() - 1]);
        assert!(
            (first - last).abs() < 1e-13 * f64::from(n),
            "{first} {last}"
        );
    }
}

#[test]
fn what_a_family_is_not_run_with_is_said() {
    let refused = |arguments: &str, text: &str| {
        let run = lie(arguments);
        assert_eq!(run.code, Some(2), "{}", run.stderr);
        assert!(run.stderr.contains(text), "{text}: {}", run.stderr);
    };
    refused(
        &format!("run {CHAIN} --param N=2.5"),
        "the number of sites is a whole number",
    );
    refused(
        &format!("run {CHAIN} --param N=2 --initial 1,0,0"),
        "3 values for 2 sites of 3 coordinates",
    );
    refused(
        &format!("run {CHAIN} --method midpoint"),
        "a family keeps no matrix",
    );
    refused(
        &format!("verify {CHAIN}"),
        "measure fewer sites, at most 21, as with `--param N=4`",
    );
    refused(
        &format!("bench {CHAIN} --param N=33334"),
        "measure fewer sites, at most 33333",
    );
    refused(
        &format!("stress {CHAIN} --param N=22"),
        "measure fewer sites, at most 21",
    );
    refused(
        &format!("run {CHAIN} --param N=4 --group matrix"),
        "the group elements of the sites of a family are not followed",
    );
    for (picture, text) in [
        ("orbit", "is a family"),
        ("attitude", "no group of matrices that is followed"),
    ] {
        refused(
            &format!("run {CHAIN} --param N=4 --picture {picture} --plot picture.svg"),
            text,
        );
    }
    for command in ["bench", "stress"] {
        refused(
            &format!("{command} {CHAIN} --param N=4 --compile"),
            "leave out `--compile`",
        );
    }
    refused(
        &format!("bench {CHAIN} --param N=4 --measure section --section x[4]=0"),
        "unknown coordinate `x[4]`",
    );
}

#[test]
fn verify_measures_a_small_family() {
    let call =
        format!("verify {CHAIN} --param N=8 --methods gauss8,splitting2,splitting4,rk4 --json");
    let run = lie(&call).ok();
    let json: serde_json::Value = serde_json::from_str(&run.stdout).expect("JSON");
    let fact = |method: &str, fact: &str| json["methods"][method][fact].clone();
    for (method, order) in [
        ("gauss8", 8.0),
        ("splitting2", 2.0),
        ("splitting4", 4.0),
        ("rk4", 4.0),
    ] {
        let found = fact(method, "order");
        assert_eq!(
            (&found["claim"], &found["verdict"]),
            (&order.into(), &"holds".into()),
            "{method}: {found}"
        );
    }
    // each measurement has a method that it tells from the others
    let small = |method: &str, name: &str| fact(method, name)["measured"].as_f64() < Some(1e-12);
    assert!(small("gauss8", "energy") && !small("rk4", "energy") && !small("splitting4", "energy"));
    assert!(small("splitting4", "quadratic Casimirs") && !small("rk4", "quadratic Casimirs"));
    assert!(small("splitting4", "Poisson") && !small("rk4", "Poisson"));
    assert!(small("splitting2", "symmetric") && !small("rk4", "symmetric"));
}

/// The error of each point of a method.
fn errors(text: &str, method: &str) -> Vec<f64> {
    let own = text
        .lines()
        .filter(|line| line.split(',').next() == Some(method));
    own.filter_map(|line| line.split(',').nth(3)?.parse().ok())
        .collect()
}

#[test]
fn bench_measures_a_family_of_any_moderate_size() {
    let folder = folder();
    let out = folder.path().join("points.csv");
    let bench = |rest: &str| {
        let call = format!("bench {CHAIN} --quiet --out {} {rest}", out.display());
        let run = lie(&call).ok();
        (run.stdout, std::fs::read_to_string(&out).expect("points"))
    };
    // below and above what matrices are made for
    for n in [8, 200] {
        let methods = "--methods gauss8,splitting4,rk4 --until 2 --budget 0.02";
        let (stdout, text) = bench(&format!("--param N={n} {methods}"));
        assert!(stdout.contains("differs from gauss16 by "), "{stdout}");
        for (method, least, most) in [("rk4", 10.0, 25.0), ("splitting4", 10.0, 25.0)] {
            let errors = errors(&text, method);
            let steep = errors.windows(2).map(|pair| pair[0] / pair[1]);
            let steep = steep.filter(|ratio| (least..most).contains(ratio)).count();
            assert!(steep >= 2, "{n} {method}: {errors:?}");
        }
        let least = errors(&text, "gauss8").into_iter().fold(1.0, f64::min);
        assert!(least < 1e-9, "{n}: {text}");
    }
    // a splitting keeps every Casimir, the control does not
    let (_, text) =
        bench("--param N=8 --methods splitting4,rk4 --until 2 --budget 0.002 --measure casimirs");
    let largest = |method: &str| errors(&text, method).into_iter().fold(0.0, f64::max);
    assert!(
        largest("splitting4") < 1e-13 && largest("rk4") > 1e-6,
        "{text}"
    );
    let (stdout, _) = bench(
        "--param N=4 --methods rk4 --budget 0.002 --until 9 --measure section --section z[3]=0",
    );
    assert!(stdout.contains("section: z[3] rises through 0"), "{stdout}");
}

#[test]
fn stress_takes_a_small_family_to_its_limits() {
    let folder = folder();
    let out = folder.path().join("cells.csv");
    let call = format!(
        "stress {CHAIN} --param N=4 --methods splitting4,rk4 --steps 400 --quiet --out {}",
        out.display()
    );
    let run = lie(&call).ok();
    let text = std::fs::read_to_string(&out).expect("cells");
    let has = |start: &str| text.lines().any(|line| line.starts_with(start));
    assert!(
        has("splitting4,component,x[3],") && has("splitting4,parameter,J,"),
        "{text}"
    );
    assert!(has("splitting4,casimir,C1_mean,"), "{text}");
    // the number of sites stays as it is
    assert!(!text.contains(",parameter,N,"), "{text}");
    let casimirs = |method: &str| -> f64 {
        let start = format!("{method},long,");
        let cell = text.lines().find(|line| line.starts_with(&start));
        let field = cell.and_then(|cell| cell.split(',').nth(10)?.parse().ok());
        field.expect("a drift")
    };
    assert!(
        casimirs("splitting4") < 1e-13 && casimirs("rk4") > 1e-9,
        "{text}"
    );
    assert!(run.stdout.contains("splitting4"), "{}", run.stdout);
}

/// The NPY file of an array.
fn npy(kind: &str, order: &str, shape: &str, numbers: &[f64]) -> Vec<u8> {
    let header = format!("{{'descr': '{kind}', 'fortran_order': {order}, 'shape': {shape}, }}\n");
    let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
    bytes.extend((header.len() as u16).to_le_bytes());
    bytes.extend(header.as_bytes());
    bytes.extend(numbers.iter().flat_map(|x| x.to_le_bytes()));
    bytes
}

/// The chain in a folder, with this initial state.
fn chain_from(folder: &std::path::Path, initial: &str) -> String {
    let text = std::fs::read_to_string(CHAIN).expect("the spec");
    let random = r#"{ "random": "unit-sphere", "seed": 1 }"#;
    assert!(text.contains(random));
    let path = folder.join("chain.json");
    std::fs::write(&path, text.replace(random, initial)).expect("a spec");
    path.display().to_string()
}

#[test]
fn a_run_starts_at_the_numbers_of_a_file_beside_the_spec() {
    let folder = folder();
    let sites = [0.6, 0.0, 0.8, 0.0, 1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.6, -0.8];
    let by_component: Vec<f64> = (0..12).map(|k| sites[k % 4 * 3 + k / 4]).collect();
    let chain = chain_from(folder.path(), r#"{ "npy": "start.npy" }"#);
    let mut rows = Vec::new();
    for (shape, numbers) in [("(4, 3)", &sites[..]), ("(12,)", &by_component)] {
        let file = npy("<f8", "False", shape, numbers);
        std::fs::write(folder.path().join("start.npy"), file).expect("a file");
        let run = lie(&format!(
            "run {chain} --param N=4 --at 0,1 --method rk4 --step 0.1"
        ))
        .ok();
        let row = run.stdout.lines().nth(1).expect("a row").to_owned();
        let found: Vec<f64> = row
            .split(',')
            .skip(1)
            .take(12)
            .filter_map(|x| x.parse().ok())
            .collect();
        assert_eq!(found, by_component, "{shape}");
        rows.push(run.stdout);
    }
    assert_eq!(rows[0], rows[1]);
    assert_ne!(
        rows[0].lines().nth(1),
        rows[0].lines().nth(2),
        "the sites move"
    );
}

#[test]
fn a_file_that_is_no_state_is_refused_where_the_spec_names_it() {
    let folder = folder();
    let chain = chain_from(folder.path(), r#"{ "npy": "start.npy" }"#);
    let numbers = [0.5; 12];
    let mut infinite = numbers;
    infinite[7] = f64::NAN;
    for (file, kind, text) in [
        (None, "io", "cannot be read"),
        (Some(b"x,y,z\n".to_vec()), "io", "no file in NumPy's format"),
        (Some(npy(">f8", "False", "(4, 3)", &numbers)), "io", "`>f8`"),
        (
            Some(npy("<f8", "True", "(4, 3)", &numbers)),
            "io",
            "Fortran order",
        ),
        (
            Some(npy("<f8", "False", "(4, 3)", &numbers[..11])),
            "io",
            "88 bytes",
        ),
        (
            Some(npy("<f8", "False", "(3, 4)", &numbers)),
            "state-length",
            "its shape is [3, 4], for 4 sites of 3 coordinates",
        ),
        (
            Some(npy("<f8", "False", "(4, 3)", &infinite)),
            "domain",
            "`y` of site 2 is NaN",
        ),
    ] {
        let path = folder.path().join("start.npy");
        let _ = std::fs::remove_file(&path);
        if let Some(bytes) = file {
            std::fs::write(&path, bytes).expect("a file");
        }
        let run = lie(&format!("run {chain} --param N=4")).error(kind, &format!("{chain}:9:"));
        assert!(run.stderr.contains(text), "{text}: {}", run.stderr);
    }
    // the same of states in rows
    let many = folder.path().join("many.npy");
    std::fs::write(&many, npy("<f8", "False", "(1, 12)", &infinite)).expect("a file");
    let many = many.display();
    let run = lie(&format!("run {chain} --param N=4 --initial-file {many}"));
    let run = run.error("domain", &format!("{many}, row 0"));
    assert!(
        run.stderr.contains("`y` of site 3 is NaN"),
        "{}",
        run.stderr
    );
    let chain = chain_from(folder.path(), r#"{ "npy": "start.npy", "seed": 1 }"#);
    let run = lie(&format!("check {chain}")).error("schema", &format!("{chain}:9:"));
    assert!(run.stderr.contains("unknown key `seed`"), "{}", run.stderr);
}

/// A bond of a site with itself is no piece of a splitting: other methods take it.
#[test]
fn a_short_ring_says_what_runs_it() {
    let folder = folder();
    let path = folder.path().join("ring.json");
    let text = std::fs::read_to_string(CHAIN).expect("the chain");
    let mut spec: serde_json::Value = serde_json::from_str(&text).expect("JSON");
    let mut run = |hamiltonian: Option<&str>, flags: &str| {
        if let Some(hamiltonian) = hamiltonian {
            spec["hamiltonian"] = hamiltonian.into();
        }
        std::fs::write(&path, spec.to_string()).expect("the spec");
        lie(&format!(
            "run {} --step 0.1 --until 0.2 {flags}",
            path.display()
        ))
    };
    for method in ["splitting4", "compose4(splitting2)"] {
        let refused = run(None, &format!("--param N=1 --method {method}"));
        let refused = refused.error("method", "command line: --method");
        assert!(
            refused.stderr.contains("on a ring of 1 site the bond"),
            "{}",
            refused.stderr
        );
        assert!(
            refused.stderr.contains("use `--method gauss8`"),
            "{}",
            refused.stderr
        );
    }
    run(None, "--param N=1 --method gauss8").ok();
    run(None, "--param N=3 --method splitting4").ok();
    let next = Some("sum(i in 0..N: x[i]*y[i+2])");
    run(next, "--param N=2 --method splitting4").error("method", "command line: --method");
    run(next, "--param N=2 --method gauss8").ok();
    run(next, "--param N=3 --method splitting4").ok();
}
