//! Constraints at values of parameters for which they say nothing.

use serde_json::json;

use crate::common::{folder, lie};
use crate::constraints::{suslov, written};

/// A factor that is zero at a value of a parameter leaves nothing of the equation, in the run and wherever else the constraint is used.
#[test]
fn a_constraint_that_vanishes_with_a_parameter_is_refused() {
    let folder = folder();
    let body = |constraint: &str| {
        let mut body = suslov();
        body["parameters"] = json!({ "k": 1 });
        body["constraint"] = json!([constraint]);
        written(folder.path(), "with_parameter.json", &body)
    };
    let cases = [
        ("k*w3 = 0", "holds for every velocity"),
        ("k*w3 = k*w1", "holds for every velocity"),
        ("k*w3 = w1", "cannot be solved for w3"),
    ];
    for (constraint, why) in cases {
        let path = body(constraint);
        let path = path.display();
        for run in ["run", "equilibria", "exponents"] {
            let until = if run == "equilibria" { "" } else { "--until 1" };
            let refused = lie(&format!("{run} {path} --param k=0 {until}"));
            let refused = refused.error("constraint", "command line: --param");
            assert!(refused.stderr.contains(why), "{run}: {}", refused.stderr);
            assert!(refused.stderr.contains("help: "), "{}", refused.stderr);
        }
        // the control
        lie(&format!("run {path} --param k=2 --until 1")).ok();
    }
    // an equation in which only one term vanishes is another constraint
    let path = body("w3 = k*w1");
    lie(&format!("run {} --param k=0 --until 1", path.display())).ok();
    let mut zero = suslov();
    zero["parameters"] = json!({ "k": 0 });
    zero["constraint"] = json!(["k*w3 = 0"]);
    let path = written(folder.path(), "zero.json", &zero);
    let refused = lie(&format!("check {}", path.display()));
    let why = "this constraint holds for every velocity at the default parameters";
    assert!(refused.stderr.contains(why), "{}", refused.stderr);
}
