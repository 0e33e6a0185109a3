//! What an input has, by the keys of the spec: the reader asks for entries, and each front end gives them.

use std::borrow::Cow;

use super::tables;
use super::token::Token;
use super::vectors::{Declared, Value};
use super::{Names, attitude, driving};
use crate::ast::{
    Algebra, Expr, Input, Name, OwnFunction, Parameter, Realization, RunOption, SiteData, Size,
    Start,
};
use crate::diagnostic::{Kind, Origin, Report};

/// The tokens of an entry, and its place even where it is empty.
pub struct Line<'a> {
    /// The tokens.
    pub tokens: Cow<'a, [Token]>,
    /// The statement or the string as a whole.
    pub place: Origin,
}

/// The parameters as far as they could be read.
#[derive(Default)]
pub struct Parameters {
    /// The names that could be read.
    pub names: Vec<Name>,
    /// The parameters without mistakes.
    pub whole: Vec<Parameter>,
    /// The coefficients that have a value for each site of a family.
    pub sites: Vec<SiteData>,
}

/// An algebra, written out or by its name.
pub struct Read {
    /// Its brackets and matrices.
    pub algebra: Algebra,
    /// Of a named one the standard names of the coordinates; none where its basis is not the standard one.
    pub state: Option<Vec<Name>>,
    /// Of a family the numbers of its copies.
    pub sizes: Vec<Size>,
}

/// An observable whose expression is not read yet.
pub struct Recorded<'a> {
    /// Its name.
    pub name: Name,
    /// Its expression.
    pub value: Line<'a>,
    /// Whether its jumps by 2 pi are taken out.
    pub unwrap: bool,
}

/// An event whose expression is not read yet.
pub struct Awaited<'a> {
    /// Its name.
    pub name: Name,
    /// Its expression.
    pub when: Line<'a>,
    /// Which zeros count.
    pub direction: i8,
    /// Whether the first of them ends the run.
    pub stop: bool,
}

/// A declaration in the form of one of the front ends; `key` is one of the spec. Mistakes of form are reported
/// where an entry is asked for.
pub trait Entries {
    /// The kind of the mistake where entries do not go together.
    const FORM: Kind;

    /// Where an entry stands, if there is one.
    fn place(&self, key: &str) -> Option<Origin>;
    /// An entry with one value.
    fn line(&self, key: &str, report: &mut Report) -> Option<Line<'_>>;
    /// An entry with many.
    fn lines(&self, key: &str, report: &mut Report) -> Vec<Line<'_>>;
    /// Names, each with what is given for it.
    fn definitions(&self, key: &str, report: &mut Report) -> Vec<(Name, Line<'_>)>;
    /// What dissipates energy, in these names.
    fn dissipation(&self, names: &Names, report: &mut Report) -> Vec<driving::Entry>;
    /// Noise.
    fn noise(&self, report: &mut Report) -> Vec<driving::Noisy<'_>>;
    /// What is set from outside.
    fn inputs(&self, report: &mut Report) -> Vec<Input>;
    /// A list of names.
    fn names(&self, key: &str, report: &mut Report) -> Vec<Name>;
    /// The ids of the methods.
    fn methods(&self, report: &mut Report) -> Vec<Name>;
    /// The word `left` or `right`, or what stands there.
    fn invariance(&self, report: &mut Report) -> Option<(String, Origin)>;
    /// The algebra; values of brackets may use the parameters.
    fn algebra(&self, parameters: &[String], report: &mut Report) -> Option<Read>;
    /// The realization; its map may use the parameters.
    fn realization(&self, parameters: &[String], report: &mut Report) -> Option<Realization>;
    /// What is given for the matrices of the retraction, whose entries may use `names`.
    fn retraction(&self, names: &Names, report: &mut Report) -> Option<Vec<(Name, Value)>>;
    /// The vectors and matrices, whose entries may use `names`.
    fn vectors(&self, names: &Names, report: &mut Report) -> Vec<Declared>;
    /// The observables.
    fn observables(&self, report: &mut Report) -> Vec<Recorded<'_>>;
    /// The events.
    fn events(&self, report: &mut Report) -> Vec<Awaited<'_>>;
    /// The functions by tables.
    fn tables(&self, report: &mut Report) -> Vec<tables::Read>;
    /// The functions of Rust.
    fn own_functions(&self, report: &mut Report) -> Vec<OwnFunction>;
    /// The initial state in these names.
    fn initial(&self, state: &[Name], names: &Names, report: &mut Report) -> Vec<Expr>;
    /// The initial group element in these names.
    fn attitude(&self, names: &Names, report: &mut Report) -> Option<attitude::Written>;
    /// The bonds of a family.
    fn bonds(&self, report: &mut Report) -> Option<SiteData>;
    /// The initial state of a family.
    fn start(&self, report: &mut Report) -> Option<Start>;
    /// Description and references, for people.
    fn prose(&self, report: &mut Report) -> (Vec<String>, Vec<String>);
    /// Defaults of the command.
    fn run(&self, report: &mut Report) -> Vec<RunOption>;
}
