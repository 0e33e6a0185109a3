//! The values that may be written in several ways.

use schemars::JsonSchema;

use super::{Algebra, DescribedObservable, DescribedParameter, Numbers, PerSite, Random};

/// The name of an algebra, or what it consists of.
#[derive(JsonSchema)]
#[schemars(untagged)]
#[expect(dead_code, reason = "the variants describe the schema")]
pub enum AlgebraForm {
    /// A name, such as `so(3) + R^2`.
    Name(String),
    /// Basis, brackets and matrices.
    Written(Algebra),
}

/// The initial state: of a family at random or from a file, else value by value.
#[derive(JsonSchema)]
#[schemars(untagged)]
#[expect(dead_code, reason = "the variants describe the schema")]
pub enum Initial {
    /// Numbers or exact expressions in parameters.
    Values(Vec<Constant>),
    /// At random.
    Random(Random),
    /// From a file.
    Numbers(Numbers),
}

/// The points of a table: a list, or a file.
#[derive(JsonSchema)]
#[schemars(untagged)]
#[expect(dead_code, reason = "the variants describe the schema")]
pub enum Points {
    /// The points `[x, y]`.
    List(Vec<[Constant; 2]>),
    /// The path of a CSV file, relative to that of the spec: `x,y` in each line, after at most one line of names.
    File(String),
}

/// What a function by a table is outside of it.
#[derive(JsonSchema)]
#[schemars(rename_all = "lowercase")]
#[expect(dead_code, reason = "the variants describe the schema")]
pub enum Outside {
    /// Not a number: a step that leaves the table fails.
    Refuse,
    /// The value at the end.
    Constant,
    /// The tangent at the end.
    Linear,
}

/// How the sites of a random state are distributed.
#[derive(JsonSchema)]
#[schemars(rename_all = "kebab-case")]
#[expect(dead_code, reason = "the variants describe the schema")]
pub enum Distribution {
    /// Uniformly on the unit sphere.
    UnitSphere,
}

/// The kinds of dissipation.
#[derive(JsonSchema)]
#[schemars(rename_all = "kebab-case")]
#[expect(dead_code, reason = "the variants describe the schema")]
pub enum DissipationKind {
    /// Along the coadjoint orbit.
    DoubleBracket,
    /// What keeps the energy.
    Metriplectic,
    /// By a matrix.
    Rayleigh,
}

/// A matrix by rows, or the name of one of `vectors`.
#[derive(JsonSchema)]
#[schemars(untagged)]
#[expect(dead_code, reason = "the variants describe the schema")]
pub enum MatrixForm {
    /// Its rows.
    Rows(Vec<Vec<Constant>>),
    /// Its name.
    Name(String),
}

/// A number, or an exact constant as text, such as "1/3".
#[derive(JsonSchema)]
#[schemars(untagged)]
#[expect(dead_code, reason = "the variants describe the schema")]
pub enum Constant {
    /// A decimal number, taken exactly: 0.1 is 1/10.
    Number(f64),
    /// An exact constant.
    Text(String),
}

/// Entries of a vector, or rows of a matrix.
#[derive(JsonSchema)]
#[schemars(untagged)]
#[expect(dead_code, reason = "the variants describe the schema")]
pub enum VectorOrMatrix {
    /// The entries: numbers, names or expressions.
    Vector(Vec<Constant>),
    /// The rows.
    Matrix(Vec<Vec<Constant>>),
}

/// The default of a parameter, or an object that also describes it.
#[derive(JsonSchema)]
#[schemars(untagged)]
#[expect(dead_code, reason = "the variants describe the schema")]
pub enum Parameter {
    /// A decimal number, taken exactly: 0.1 is 1/10.
    Number(f64),
    /// An exact constant.
    Text(String),
    /// Default and description.
    Described(DescribedParameter),
    /// A value for each site of a family.
    Values(SiteValues),
    /// The same with a description, or from a file.
    PerSite(PerSite),
}

/// A value for each site.
#[derive(JsonSchema)]
#[schemars(untagged)]
#[expect(dead_code, reason = "the variants describe the schema")]
pub enum SiteValues {
    /// Of a chain.
    Chain(Vec<Constant>),
    /// Of a lattice, row by row.
    Lattice(Vec<Vec<Constant>>),
    /// Of a lattice of three dimensions, layer by layer.
    Layers(Vec<Vec<Vec<Constant>>>),
}

/// Bonds between two sites.
#[derive(JsonSchema)]
#[schemars(untagged)]
#[expect(dead_code, reason = "the variants describe the schema")]
pub enum Bonds {
    /// The path of a file, relative to that of the spec: CSV, or what `numpy.save` wrote.
    File(String),
    /// `[i, j, value]` for each bond.
    Rows(Vec<Vec<Constant>>),
}

/// A function of the state that is recorded beside it.
#[derive(JsonSchema)]
#[schemars(untagged)]
#[expect(dead_code, reason = "the variants describe the schema")]
pub enum Observable {
    /// The function.
    Text(String),
    /// The function, and how it is recorded.
    Described(DescribedObservable),
}

/// Times of rows.
#[derive(JsonSchema)]
#[schemars(untagged)]
#[expect(dead_code, reason = "the variants describe the schema")]
pub enum Times {
    /// One time.
    Number(f64),
    /// Times with commas between them.
    Text(String),
    /// A list of times.
    List(Vec<Constant>),
}

/// The axes of Euler angles.
#[derive(JsonSchema)]
#[schemars(rename_all = "lowercase")]
#[expect(dead_code, reason = "the variants describe the schema")]
pub enum EulerAxes {
    Xyx,
    Xyz,
    Xzx,
    Xzy,
    Yxy,
    Yxz,
    Yzx,
    Yzy,
    Zxy,
    Zxz,
    Zyx,
    Zyz,
}

/// Left or right invariance.
#[derive(JsonSchema)]
#[schemars(rename_all = "lowercase")]
#[expect(dead_code, reason = "the variants describe the schema")]
pub enum Invariance {
    /// mu' = ad*_(grad H) mu
    Left,
    /// mu' = -ad*_(grad H) mu
    Right,
}
