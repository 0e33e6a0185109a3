//! `lie report`: one page of HTML.

use std::path::Path;
use std::process::Command;

use crate::common::{Run, command, folder, spec};

fn report(arguments: &[&str], out: &Path) -> Run {
    let mut call = command(std::iter::once("report").chain(arguments.iter().copied()));
    call.arg("--out").arg(out);
    call.output().expect("lie starts").into()
}

fn page(arguments: &[&str]) -> String {
    let folder = folder();
    let out = folder.path().join("page.html");
    report(arguments, &out).ok();
    std::fs::read_to_string(&out).expect("the page")
}

const BODY: &str = "specs/so3_free_rigid_body.json";

#[test]
fn everything_is_on_the_page() {
    let text = page(&[BODY, "--until", "5"]);
    for part in [
        "<h2>The system</h2>",
        "<math",
        "<h2>What is known of it</h2>",
        "algebra: so(3)",
        "<h2>A trajectory</h2>",
        "<svg",
        "<h2>On its coadjoint orbit</h2>",
        "<canvas",
        "<h2>Error against run time</h2>",
        "<h2>The generated code</h2>",
        "impl&lt;S: ::lie_runtime::Scalar&gt;",
        "lie run specs/so3_free_rigid_body.json --until 5 --out rows.csv",
        "prefers-color-scheme: dark",
        "name=\"viewport\"",
        "@media print",
    ] {
        assert!(text.contains(part), "{part}");
    }
    // a bracket that is no algebra's is on its page, and the surface has its own name there
    let species = page(&["specs/lotka_volterra.json", "--until", "1", "--no-bench"]);
    assert_eq!(species.matches("<mo>{</mo>").count(), 3);
    assert!(species.contains("<h2>On its symplectic leaf</h2>") && !text.contains("<mo>{</mo>"));
    // each equation of motion, as mathematics
    assert_eq!(text.matches("<mi>d</mi><mi>t</mi>").count(), 3);
    assert!(!text.contains("<math display=\"block\"><mrow></mrow>"));
}

/// The rates of noise are no coordinates with names of their own: they are dotted, and said to be what they are.
#[test]
fn noise_is_dotted_in_the_equations() {
    let folder = folder();
    let path = folder.path().join("noisy.json");
    let spec = r#"{"format": 1, "name": "Noisy", "algebra": "so(3)", "state": ["x", "y", "z"], "hamiltonian": "x^2/3 + z^2/2",
        "noise": [{"hamiltonian": "z/10"}, {"force": {"x": "1/10"}}], "initial": [1, 0, 0]}"#;
    std::fs::write(&path, spec).unwrap();
    let text = page(&[path.to_str().unwrap(), "--until", "1", "--no-bench"]);
    assert!(text.contains("<mi>W</mi><mo>˙</mo>"));
    assert!(text.contains("are the rates of the Wiener processes"));
    assert!(!text.contains("<mi>_w</mi>"));
    assert!(!page(&[BODY, "--until", "1", "--no-bench"]).contains("Wiener"));
}

#[test]
fn a_family_has_a_page_with_all_that_is_measured() {
    let text = page(&["tests/data/families/xxz_chain.json", "--until", "1"]);
    for part in [
        "<h2>Error against run time</h2>",
        "splitting4",
        "differs from gauss16 by",
    ] {
        assert!(text.contains(part), "{part}");
    }
}

/// It opens without a network: nothing is loaded from elsewhere.
#[test]
fn nothing_comes_from_elsewhere() {
    let text = page(&[BODY, "--until", "1", "--no-bench"]);
    for loads in ["src=", "<link", "@import", "url(", "fetch(", "import("] {
        assert!(!text.contains(loads), "{loads}");
    }
    assert!(!text.contains("<h2>Error against run time</h2>"));
}

/// What the user wrote is text, whatever it looks like.
#[test]
fn text_of_the_user_is_escaped() {
    let folder = folder();
    let evil = "x^2/2 + y^2/3 + z^2 + 0*x /* </script><script>alert(1)</script> */";
    let path = spec(folder.path(), |spec| spec["hamiltonian"] = evil.into());
    let out = folder.path().join("page.html");
    let refused = report(&[path.to_str().expect("UTF-8"), "--no-bench"], &out);
    assert_eq!(refused.code, Some(2), "there are no comments in a formula");
    assert!(!out.exists(), "nothing is left");
    // a name of a file stands on the page as well
    let path = folder.path().join("<b>&.json");
    std::fs::copy(BODY, &path).expect("a copy");
    report(
        &[path.to_str().expect("UTF-8"), "--no-bench", "--until", "1"],
        &out,
    )
    .ok();
    let text = std::fs::read_to_string(&out).expect("the page");
    assert!(text.contains("&lt;b&gt;&amp;.json") && !text.contains("<b>"));
}

/// A run that stops early has a page, which says so.
#[test]
fn what_was_computed_stays() {
    let folder = folder();
    let path = spec(folder.path(), |spec| {
        spec["hamiltonian"] = "x*y*z^3 + x^4".into();
        spec["casimirs"] = serde_json::json!([]);
    });
    let out = folder.path().join("page.html");
    let flags = [
        "--no-bench",
        "--until",
        "100",
        "--step",
        "5",
        "--method",
        "gauss4",
        "--initial",
        "3,2,4",
    ];
    let run = report(
        &[&[path.to_str().expect("UTF-8")], flags.as_slice()].concat(),
        &out,
    );
    assert_eq!(run.code, Some(3), "{}", run.stderr);
    assert!(run.stderr.contains("stopped in step"), "{}", run.stderr);
    let text = std::fs::read_to_string(&out).expect("the page");
    assert!(text.contains("stopped early") && text.contains("class=\"stopped\""));
    assert!(
        text.contains("<h2>The generated code</h2>"),
        "the rest is there"
    );
}

#[test]
fn wrong_input_leaves_nothing() {
    let folder = folder();
    let out = folder.path().join("page.html");
    for (flags, says) in [
        (&[BODY, "--method", "gauss5"][..], "gauss5"),
        (&[BODY, "--until", "x"], "--until"),
        (&["specs/none.json"], "none.json"),
    ] {
        let run = report(flags, &out);
        assert_ne!(run.code, Some(0));
        assert!(
            run.stderr.contains("error[") && run.stderr.contains(says),
            "{}",
            run.stderr
        );
        assert!(!out.exists(), "{says}");
    }
    let run = report(&[BODY], &folder.path().join("page.pdf"));
    assert_eq!(run.code, Some(2));
    assert!(run.stderr.contains("page.html"), "{}", run.stderr);
    let run = report(&[BODY], Path::new("/nonexistent/page.html"));
    assert_eq!(run.code, Some(1), "{}", run.stderr);
}

/// Several methods are compared; the same call makes the same page, apart from times.
#[test]
fn several_methods() {
    let arguments = [
        BODY,
        "--until",
        "2",
        "--no-bench",
        "--method",
        "rk4",
        "--method",
        "lie-midpoint --retraction cayley",
    ];
    let [first, second] = [(); 2].map(|()| page(&arguments));
    assert!(first.contains("<h2>The methods side by side</h2>"));
    assert!(
        first.contains("--method &#39;lie-midpoint --retraction cayley&#39;"),
        "a line that a shell takes"
    );
    let without = |text: &str| -> Vec<String> {
        let lines = text
            .lines()
            .filter(|line| !line.contains(" in 0.") && !line.contains("made by"));
        lines.map(str::to_owned).collect()
    };
    assert_eq!(without(&first), without(&second));
}

#[test]
fn a_range_of_values_is_for_runs() {
    let folder = folder();
    let out = folder.path().join("page.html");
    let run = report(&[BODY, "--param", "I1=1:2:3"], &out);
    let run = run.error("option", "command line: --param");
    for text in ["which `lie run` alone takes", "`--param I1=1`"] {
        assert!(run.stderr.contains(text), "{text}: {}", run.stderr);
    }
    assert!(!out.exists());
}

#[test]
fn a_method_with_an_option_is_reported() {
    let label = "lie-midpoint --retraction cayley";
    let text = page(&[BODY, "--until", "2", "--no-bench", "--method", label]);
    let line = format!("lie expand {BODY} --method &#39;{label}&#39;");
    assert!(text.contains(&line), "a line that a shell takes");
    assert!(text.contains("CayleyMidpoint"), "the code of this option");
}

/// A browser runs the page without an error, and draws the orbit.
#[test]
fn a_browser_draws_it() {
    let Some(browser) = ["chromium", "chromium-browser", "google-chrome"]
        .into_iter()
        .find(|name| {
            Command::new(name)
                .arg("--version")
                .output()
                .is_ok_and(|found| found.status.success())
        })
    else {
        println!("skipped: no Chromium");
        return;
    };
    let folder = folder();
    let out = folder.path().join("page.html");
    report(&[BODY, "--until", "5", "--no-bench"], &out).ok();
    // what the script leaves on the canvas becomes text of the page
    let text = std::fs::read_to_string(&out).expect("the page");
    let probe = "<p id=\"probe\"></p><script>addEventListener('load', () => { const c = document.getElementById('orbit'); \
                 const d = c.getContext('2d').getImageData(0, 0, c.width, c.height).data; const s = new Set(); \
                 for (let k = 0; k < d.length; k += 4) s.add(d[k] * 65536 + d[k + 1] * 256 + d[k + 2]); \
                 document.getElementById('probe').textContent = 'colours ' + (s.size > 20 ? 'many' : s.size); });</script></body>";
    std::fs::write(&out, text.replace("</body>", probe)).expect("the page");
    let dom = |path: &Path| {
        let url = format!("file://{}", path.display());
        let flags = ["--headless", "--no-sandbox", "--disable-gpu", "--dump-dom"];
        let output = Command::new(browser)
            .args(flags)
            .arg(url)
            .output()
            .expect("it starts");
        String::from_utf8_lossy(&output.stdout).into_owned()
    };
    assert!(dom(&out).contains("colours many"), "the orbit is drawn");
    let broken = text
        .replace("function draw() {", "function draw() { return;")
        .replace("</body>", probe);
    std::fs::write(&out, broken).expect("the page");
    assert!(
        !dom(&out).contains("colours many"),
        "an empty canvas is seen"
    );
}

/// Three coordinates alone are no orbit: a surface needs a Casimir. A comparison that cannot be made does not take the page with it.
#[test]
fn systems_without_an_orbit_or_a_comparison() {
    let folder = folder();
    let path = spec(folder.path(), |spec| {
        spec["algebra"] = "bianchi(IV)".into();
        spec["casimirs"] = serde_json::json!([]);
    });
    let name = path.to_str().expect("UTF-8");
    let text = page(&[name, "--until", "1", "--no-bench"]);
    assert!(!text.contains("id=\"orbit\""));
    let still = page(&[BODY, "--initial", "1, 0, 0", "--until", "1"]);
    assert!(still.contains("nothing can be compared on FreeRigidBody"));
}
