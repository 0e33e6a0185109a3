//! The keys of the spec file: one table for the reader and for the JSON Schema.

mod forms;

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde_json::Value;

pub use forms::*;

/// Declares an object of the spec once: the struct that `schemars` turns into the schema and the
/// list of keys that the reader accepts. Keys in `required` must be there.
macro_rules! objects {
    ($($(#[$meta:meta])* struct $name:ident requires [$($required:literal),*] {
        $($(#[$attribute:meta])+ $key:literal $field:ident: $type:ty,)+
    })+) => { $(
        $(#[$meta])*
        #[derive(JsonSchema)]
        #[schemars(deny_unknown_fields)]
        #[expect(dead_code, reason = "the fields describe the schema")]
        pub struct $name {
            $($(#[$attribute])+ #[schemars(rename = $key)] $field: $type,)+
        }

        impl $name {
            /// Every key.
            pub const KEYS: &'static [&'static str] = &[$($key),+];
            /// The keys that must be there.
            pub const REQUIRED: &'static [&'static str] = &[$($required),*];
        }
    )+ };
}

objects! {
    /// A Hamiltonian system: a Lie algebra by its structure constants and a Hamiltonian on its dual, or
    /// the Poisson brackets of the coordinates and a Hamiltonian.
    struct Spec requires ["name"] {
        /// Path of this schema, for editors.
        "$schema" schema: Option<String>,
        /// Version of the format.
        #[schemars(extend("const" = 1))]
        "format" format: Option<u32>,
        /// Name of the system, an identifier: the name of the generated type.
        "name" name: String,
        /// What the system is, for people.
        "description" description: Option<String>,
        /// Where the system comes from, for people.
        "references" references: Option<Vec<String>>,
        /// The Lie algebra: its name, such as `so(3)`, `so(3) + R^2` or `semidirect(so(3), R^3)`, or an object.
        "algebra" algebra: Option<AlgebraForm>,
        /// Beside the algebra: brackets `{x, y} = value` of coordinates that are added to the
        /// Lie–Poisson bracket, constants that satisfy the cocycle identity.
        "cocycle" cocycle: Option<Vec<String>>,
        /// Instead of the algebra: the Poisson brackets `{x, y} = value` of the coordinates, expressions
        /// in state, parameters and abbreviations. Antisymmetry is implied and absent brackets are zero.
        "poisson" poisson: Option<Vec<String>>,
        /// Name of the group element g, a matrix of the size of `matrices`: its entries, for `R` these are `R11`,
        /// `R12`, …, may stand in the functions, and are coordinates of the state beside mu.
        "group" group: Option<String>,
        /// Names of the coordinates, one for each basis element where there is an algebra. An algebra by its name has
        /// standard ones.
        "state" state: Option<Vec<String>>,
        /// Parameters and their defaults.
        "parameters" parameters: Option<BTreeMap<String, Parameter>>,
        /// Vectors and matrices by name: lists of entries, and lists of rows, in coordinates, parameters and numbers. In the
        /// functions `dot(v, w)`, `cross(v, w)`, `norm(v)`, `norm2(v)`, `A*v` and `quad(A, v)` stand for what they are in the
        /// entries.
        "vectors" vectors: Option<BTreeMap<String, VectorOrMatrix>>,
        /// Functions of one argument by name, which the other functions may call: splines through the points of a table.
        "functions" functions: Option<BTreeMap<String, TableFunction>>,
        /// Abbreviations `NAME = expression`, each may use the earlier ones.
        "let" lets: Option<Vec<String>>,
        /// The Hamiltonian, an expression in state, parameters and abbreviations.
        "hamiltonian" hamiltonian: Option<String>,
        /// Instead of the Hamiltonian: the reduced Lagrangian, an expression in velocity, parameters and
        /// abbreviations.
        "lagrangian" lagrangian: Option<String>,
        /// Instead of the Hamiltonian: a discrete Lagrangian of one step, an expression in the coordinates of the step
        /// that `velocity` names, the step size `h`, parameters and abbreviations.
        "discrete_lagrangian" discrete_lagrangian: Option<String>,
        /// Names of the components of the velocity xi, one for each basis element; for a Lagrangian. For a discrete one
        /// those of the coordinates x = tau^-1(g) of the step g in the retraction of the method.
        "velocity" velocity: Option<Vec<String>>,
        /// Forces by coordinate, covectors that are added to mu': expressions in state, time `t`, parameters, abbreviations and
        /// entries of the group element. A vector of coordinates may stand for them.
        "forces" forces: Option<BTreeMap<String, String>>,
        /// What dissipates energy beside them.
        "dissipation" dissipation: Option<Vec<Dissipation>>,
        /// Noise in the sense of Stratonovich, each entry with a Wiener process of its own.
        "noise" noise: Option<Vec<Noise>>,
        /// What is set from outside while a run goes on, by name.
        "inputs" inputs: Option<BTreeMap<String, Input>>,
        /// Beside the algebra: linear equations between the components of the velocity, such as `e3 = 0`, in the names of
        /// `velocity` or else of the basis, where they are read as coordinates of grad H. The motion is that of the reduced
        /// almost-Poisson bracket.
        "constraint" constraint: Option<Vec<String>>,
        /// A realization of the bracket in canonical coordinates, for collective methods.
        "realization" realization: Option<Realization>,
        /// A map from the algebra to the group of the user's own, for `lie-midpoint` with `--retraction spec`.
        "retraction" retraction: Option<Retraction>,
        /// Casimirs, `NAME = expression` or an expression; each is verified exactly.
        "casimirs" casimirs: Option<Vec<String>>,
        /// First integrals, `NAME = expression`: functions of state, parameters, abbreviations and the time `t` whose bracket with the
        /// Hamiltonian is proven to vanish. They are columns of a run.
        "integrals" integrals: Option<Vec<String>>,
        /// Functions of state, parameters, abbreviations and the time `t` by name, which are columns of a run.
        "observables" observables: Option<BTreeMap<String, Observable>>,
        /// Functions of state, parameters, abbreviations and the time `t` by name, whose zeros along a run are found.
        "events" events: Option<BTreeMap<String, Event>>,
        /// Bonds between any two sites of a family: the path of a file with `i,j,value` in each line, or such rows; `sum(bonds: value*x[i]*x[j])`.
        "bonds" bonds: Option<Bonds>,
        /// Ids of the methods that get fused code.
        "methods" methods: Option<Vec<String>>,
        /// `left` (the default): mu' = ad*_(grad H) mu; `right`: the opposite sign.
        "invariance" invariance: Option<Invariance>,
        /// Initial state: numbers or exact expressions in parameters.
        "initial" initial: Option<Initial>,
        /// The group element at the start, where a run follows it or its entries are coordinates; the identity where it is absent. It
        /// takes body axes to those of space.
        "attitude" attitude: Option<Attitude>,
        /// Defaults of `lie run`.
        "run" run: Option<Run>,
    }

    /// A function by a table: the spline of an odd degree through its points, with continuous derivatives below that
    /// degree. The points next to the ends are no knots ("not-a-knot").
    struct TableFunction requires ["table"] {
        /// The points, with ascending x.
        "table" table: Points,
        /// The degree of the spline: 1, 3 (the default), 5 or 7.
        "degree" degree: Option<u32>,
        /// What the function is outside of the table: `refuse` (the default: a step that leaves the table fails),
        /// `constant` or `linear`.
        "outside" outside: Option<Outside>,
    }

    /// A dissipation: `double-bracket`, mu' += c ad*_(G ad*_(grad H) mu) mu with the strength c and the metric G, along the
    /// coadjoint orbit; `metriplectic`, mu' += K grad S with K grad H = 0 and {S, H} = 0, which keeps H; `rayleigh`,
    /// mu' -= R grad H.
    struct Dissipation requires ["kind"] {
        /// Its kind.
        "kind" kind: DissipationKind,
        /// The strength c of a double bracket, an expression in parameters.
        "strength" strength: Option<Constant>,
        /// The metric: G of a double bracket, with entries in parameters, the identity by default; K of a metriplectic one,
        /// with entries in state and parameters.
        "metric" metric: Option<MatrixForm>,
        /// Instead of the metric of a metriplectic one: a factor L, K = L L^T.
        "factor" factor: Option<MatrixForm>,
        /// The entropy S, a function of the state.
        "entropy" entropy: Option<String>,
        /// The matrix R of `rayleigh`, with entries in parameters.
        "matrix" matrix: Option<MatrixForm>,
        /// The temperature T of the noise that belongs to a double bracket or to `rayleigh`, an expression in parameters:
        /// `exp(-H/T)` is invariant then.
        "temperature" temperature: Option<Constant>,
    }

    /// An observable with how it is recorded.
    struct DescribedObservable requires ["expression"] {
        /// The function.
        "expression" expression: String,
        /// Whether it is an angle whose jumps by 2 pi are taken out.
        "unwrap" unwrap: Option<bool>,
    }

    /// A noise: along a Hamiltonian, or a force.
    struct Noise requires [] {
        /// A function sigma of the state: `mu' += ad*_(grad sigma) mu dW/dt`.
        "hamiltonian" hamiltonian: Option<String>,
        /// A force by coordinate, times `dW/dt`.
        "force" force: Option<BTreeMap<String, String>>,
    }

    /// What is set from outside, and held from one sampling to the next.
    struct Input requires ["default"] {
        /// The value where nobody sets it.
        "default" default: Constant,
        /// The time from one sampling to the next; every step where it is absent.
        "sampling" sampling: Option<Constant>,
    }

    /// The zeros of a function along a run.
    struct Event requires ["when"] {
        /// The function.
        "when" when: String,
        /// Which zeros count: 1 where it rises, -1 where it falls, 0 (the default) for both.
        #[schemars(range(min = -1, max = 1))]
        "direction" direction: Option<i8>,
        /// Whether the first of them ends the run.
        "stop" stop: Option<bool>,
    }

    /// A group element in one of three ways: `quaternion`, `matrix`, `euler` with `angles`. The entries are numbers or exact
    /// expressions in parameters.
    struct Attitude requires [] {
        /// A unit quaternion of a rotation, the real part first.
        "quaternion" quaternion: Option<[Constant; 4]>,
        /// A matrix by rows, of the size of those of the algebra.
        "matrix" matrix: Option<Vec<Vec<Constant>>>,
        /// The axes of Euler angles: g = R_a(phi) R_b(theta) R_c(psi) for `abc`.
        "euler" euler: Option<EulerAxes>,
        /// The angles phi, theta, psi in radians.
        "angles" angles: Option<[Constant; 3]>,
    }

    /// A random initial state of a family.
    struct Random requires ["random"] {
        /// The distribution: `unit-sphere`, a point on the unit sphere for each site.
        "random" random: Distribution,
        /// Which of them, 1 by default.
        "seed" seed: Option<u64>,
    }

    /// The initial state of a family from a file.
    struct Numbers requires ["npy"] {
        /// The path of a file in NumPy's format, relative to that of the spec: numbers of type f8 or f4, little-endian, in C
        /// order, a row for each site, of a lattice `(N, M, coordinates)` or `(L, N, M, coordinates)`; or one-dimensional in the
        /// order of the state, the first coordinates of all sites, then the second ones.
        "npy" npy: String,
    }

    /// A Lie algebra. Antisymmetry is implied and absent brackets are zero.
    struct Algebra requires [] {
        /// The name of a known algebra, such as `so(3)`, which the other keys change.
        "named" named: Option<String>,
        /// Names of the basis. Of a named algebra: other names, or another basis, each element as
        /// `NAME = combination` of the old names with rational coefficients.
        "basis" basis: Option<Vec<String>>,
        /// The matrix by which each basis element of a named algebra acts on a further space R^n, whose vectors are added to
        /// it; what is not there acts as zero.
        "action" action: Option<BTreeMap<String, Vec<Vec<Constant>>>>,
        /// Names of new elements by which a named algebra is extended, and which commute with all others.
        "central" central: Option<Vec<String>>,
        /// Brackets `[a, b] = value`, the value linear in basis names. Of a named algebra: what is added to its brackets, a
        /// cocycle with values in the `central` elements.
        "brackets" brackets: Option<Vec<String>>,
        /// The matrix of each basis element in a representation, as rows: numbers, or rational functions of exact parameters, such
        /// as "-k/2". Without `brackets` the brackets are computed from it. Of a named algebra it replaces the one that belongs to
        /// the name.
        "matrices" matrices: Option<BTreeMap<String, Vec<Vec<Constant>>>>,
    }

    /// A map J from canonical coordinates to the state with {J_a, J_b} = Pi_ab(J), for collective methods.
    struct Realization requires ["positions", "momenta", "map"] {
        /// Names of the positions q.
        "positions" positions: Vec<String>,
        /// Names of the momenta p, one for each position.
        "momenta" momenta: Vec<String>,
        /// `STATE = expression` in positions, momenta and parameters, one for each name of the state.
        "map" map: Vec<String>,
        /// A point (q, p) near which points over a state are sought: numbers or exact expressions in parameters.
        "start" start: Option<Vec<Constant>>,
    }

    /// A map tau from the algebra to the group of `matrices`, by its matrix: tau(0) is the identity, its derivative there that of exp, and
    /// `tau(x) tau(-x)` the identity. With `second` it is `second^-1 map`.
    struct Retraction requires ["map"] {
        /// The rows of the matrix: expressions in the components of the velocity, by the names of `velocity` or else of the basis,
        /// and in parameters.
        "map" map: Vec<Vec<Constant>>,
        /// The matrix at the beginning of a step, where `map` is the one at its end, both seen from a point between.
        "second" second: Option<Vec<Vec<Constant>>>,
    }

    /// A parameter with what people want to know about it.
    struct DescribedParameter requires [] {
        /// The default: a number or an exact constant. It must be there, under this key or under `value`.
        "default" default: Option<Constant>,
        /// The default, in other words.
        "value" value: Option<Constant>,
        /// Whether the parameter takes positive values only. Proofs use it, and a system with another value is refused.
        "positive" positive: Option<bool>,
        /// Whether brackets and matrices may use the parameter, as an exact number.
        "exact" exact: Option<bool>,
        /// Its unit.
        "unit" unit: Option<String>,
        /// Its meaning.
        "description" description: Option<String>,
    }

    /// A coefficient of a family that has a value for each site, `B[i]` in its sums.
    struct PerSite requires [] {
        /// The values, site after site; of a lattice a list of rows, or of layers that are such.
        "values" values: Option<SiteValues>,
        /// The path of a file with the values, relative to that of the spec: what `numpy.save` wrote, or a number in each line
        /// of a CSV file, of a lattice a row, layer after layer.
        "file" file: Option<String>,
        /// Its unit.
        "unit" unit: Option<String>,
        /// Its meaning.
        "description" description: Option<String>,
    }

    /// Defaults of `lie run`; keys and values are those of its flags.
    struct Run requires [] {
        /// Id of the method.
        "method" method: Option<String>,
        /// Step size.
        "step" step: Option<Constant>,
        /// Relative error at the end from which the step is chosen, in place of it.
        "tol" tol: Option<Constant>,
        /// Time at the start, 0 unless it is given.
        "from" from: Option<Constant>,
        /// End time.
        "until" until: Option<Constant>,
        /// Every how many steps a row is written.
        "every" every: Option<Constant>,
        /// Times of the rows, a list or text with commas.
        "at" at: Option<Times>,
        /// Retraction of the method.
        "retraction" retraction: Option<String>,
        /// Composition of the method.
        "composition" composition: Option<String>,
        /// Pieces of a splitting: found (default) or coordinate.
        "pieces" pieces: Option<String>,
        /// Lift of a collective method.
        "lift" lift: Option<String>,
        /// Discrete gradient.
        "gradient" gradient: Option<String>,
        /// Poisson tensor of a discrete gradient method.
        "tensor" tensor: Option<String>,
        /// How the group element is written beside mu, if it is: `matrix`, `quaternion`, or `euler:zxz` and other axes.
        "group" group: Option<String>,
        /// Relative tolerance.
        "rtol" rtol: Option<Constant>,
        /// Absolute tolerance.
        "atol" atol: Option<Constant>,
        /// Iteration of an implicit method: `automatic`, `newton`, `simplified` or `fixed-point`.
        "iteration" iteration: Option<String>,
        /// Error at which that iteration ends, in units of round-off.
        "newton-tolerance" newton_tolerance: Option<Constant>,
        /// Iterations after which a step has failed.
        "max-iterations" max_iterations: Option<Constant>,
        /// What has converged where stages that are evaluated together end: `state`, `map` or `tolerance`.
        "converge" converge: Option<String>,
        /// What explicit methods keep by a projection behind each step: `energy`, `casimirs`, or both with a comma.
        "keep" keep: Option<String>,
        /// Whether the size of steps follows the motion: `reversible`, for symmetric methods.
        "density" density: Option<String>,
    }
}

/// The JSON Schema (draft 2020-12) of a spec file, the same on every call.
pub fn schema() -> Value {
    let mut schema = schemars::schema_for!(Spec).to_value();
    forbid_null(&mut schema);
    schema["oneOf"] = serde_json::json!([
        { "required": ["hamiltonian"] },
        { "required": ["lagrangian", "velocity"] },
        { "required": ["discrete_lagrangian", "velocity"] },
    ]);
    schema["allOf"] = serde_json::json!([
        { "oneOf": [{ "required": ["algebra"] }, { "required": ["poisson"] }] },
        { "anyOf": [
            { "required": ["state"] },
            {
                "required": ["algebra"],
                "properties": { "algebra": { "anyOf": [{ "type": "string" }, { "required": ["named"] }] } },
            },
        ] },
    ]);
    schema["$defs"]["Algebra"]["anyOf"] =
        serde_json::json!([{ "required": ["basis"] }, { "required": ["named"] }]);
    schema["dependentRequired"] =
        serde_json::json!({ "cocycle": ["algebra"], "constraint": ["algebra"] });
    schema
}

/// An optional key may be absent, but `null` is no value of it. The schema has no depth to fear.
fn forbid_null(value: &mut Value) {
    let is_null = |v: &Value| v == "null" || v.get("type").is_some_and(|t| t == "null");
    match value {
        Value::Object(object) => {
            for key in ["type", "anyOf"] {
                let Some(Value::Array(options)) = object.get_mut(key) else {
                    continue;
                };
                options.retain(|option| !is_null(option));
                if let [only] = options.as_mut_slice() {
                    let only = only.take();
                    object.remove(key);
                    match only {
                        Value::Object(inner) => object.extend(inner),
                        other => drop(object.insert(key.to_owned(), other)),
                    }
                }
            }
            object.values_mut().for_each(forbid_null);
        }
        Value::Array(list) => list.iter_mut().for_each(forbid_null),
        _ => {}
    }
}

#[cfg(test)]
mod tests;
