//! The initial state of a family.

use std::path::Path;

use lie_codegen::methods::Choice;
use lie_codegen::model::{Family, SiteData, Start, wrong_bond};
use lie_codegen::structure::Structure;
use lie_runtime::driver::MOST_PROCESSES;
use lie_runtime::family::{unit_spheres, values};
use lie_runtime::lattice::{self, AXES, count};
use lie_syntax::diagnostic::{Kind, Origin};
use lie_syntax::front::npy::{self, Array};

use super::Front;
use super::plan::Planner;
use crate::memory;
use crate::message::{Fault, Message, Place};
use crate::words::{self, counted};

/// What to do about a number that is not finite.
pub(super) const FINITE: &str = "give each coordinate of each site a finite number";

/// The first number of the state of a family that is not finite, in words.
pub(super) fn not_finite(model: &Structure, state: &[f64]) -> Option<String> {
    let at = state.iter().position(|value| !value.is_finite())?;
    let sites = model.of_sites(state).len() / model.dimension();
    let coordinate = &model.coordinates[at / sites].text;
    Some(format!(
        "`{coordinate}` of site {} is {}",
        at % sites,
        state[at]
    ))
}

impl Planner<'_> {
    /// The initial state of a family: the values of `--initial`, the first coordinates of all sites, then the second and
    /// so on, or what the spec says.
    pub(super) fn family_state(&mut self, family: &Family, parameters: &[f64]) -> Option<Vec<f64>> {
        let n = self.spec.model.dimension();
        let Some(sizes) = family.sites(parameters) else {
            let text = "the number of sites is a whole number from 1 to 2147483648";
            let front = self.request.front;
            let message = Message::new(Kind::Domain, text).at_option(&front.option("param"));
            let help = format!("write it like {}", front.parameter("N", "1000"));
            self.mistakes.push(message.help(help));
            return None;
        };
        if let Some(message) = self.without_values(family, sizes) {
            self.mistakes.push(message);
            return None;
        }
        let sites = count(sizes);
        if let Err(exceeded) = memory::fits(sites as f64 * n as f64 * memory::COORDINATE) {
            let text = format!("{}: {exceeded}", counted(sites as u64, "site"));
            let option = self.request.front.option("param");
            let message = Message::new(Kind::Limit, text).at_option(&option);
            let message = message.help("take fewer sites, or a machine with more memory");
            self.mistakes.push(message.with_fault(Fault::Memory));
            return None;
        }
        let noises = self
            .spec
            .model
            .driving
            .as_ref()
            .map_or(0, |driving| driving.noises);
        if noises * sites > MOST_PROCESSES {
            let text = format!(
                "{} have {} Wiener processes, and a run has at most {MOST_PROCESSES}",
                counted(sites as u64, "site"),
                noises * sites,
            );
            let option = self.request.front.option("param");
            let message = Message::new(Kind::Limit, text).at_option(&option);
            self.mistakes.push(message.help("take fewer sites"));
            return None;
        }
        let Some(given) = self.requested("initial") else {
            return match &family.start {
                Some(Start::UnitSpheres(seed)) => Some(unit_spheres(sites, n, *seed)),
                Some(Start::File(path)) => self.file(&path.text, path.origin, sizes),
                None => {
                    let text = format!("the spec of {} has no `initial`", self.spec.model.name);
                    let help = format!(
                        "write `\"initial\": {{\"random\": \"unit-sphere\", \"seed\": 1}}` or `{{\"npy\": \"chain.npy\"}}`, or give the values by `{}`",
                        self.request.front.option("initial")
                    );
                    let message = self
                        .option_mistake("initial", text)
                        .with_fault(Fault::Arguments);
                    self.mistakes.push(message.help(help));
                    None
                }
            };
        };
        let parts = given.split();
        if parts.len() != n * sites {
            let text = format!(
                "{} for {} of {}",
                counted(parts.len() as u64, "value"),
                counted(sites as u64, "site"),
                counted(n as u64, "coordinate")
            );
            let mut message = given.wrong(text);
            message.kind = Kind::StateLength;
            let help = "give the first coordinates of all sites, then the second ones, and so on";
            self.mistakes.push(message.help(help));
            return None;
        }
        let values: Vec<Option<f64>> = parts.iter().map(|part| self.keep(part.number())).collect();
        values.into_iter().collect()
    }

    /// What is said of a coefficient that has no value for each of so many sites.
    fn without_values(&self, family: &Family, sizes: [usize; AXES]) -> Option<Message> {
        if let Some(data) = family.data.last().filter(|_| family.has_bonds)
            && let Some(fault) = wrong_bond(&data.values, count(sizes))
        {
            let option = self.request.front.option("param");
            let message = Message::new(Kind::Domain, fault).at_option(&option);
            return Some(message.help("take as many sites as the bonds join"));
        }
        let of_sites = family.data.iter();
        let of_sites = of_sites.take(family.data.len() - usize::from(family.has_bonds));
        let fits = |data: &&SiteData| match data.sizes {
            Some(of_values) => of_values == sizes,
            None => values(&data.values, "", sizes, data.unused).is_ok(),
        };
        let data = of_sites.into_iter().find(|data| !fits(data))?;
        let sites = words::sites(sizes);
        let given = counted(data.values.len() as u64, "value");
        let text = format!("`{}` has {given}, and there are {sites}", data.name);
        let option = self.request.front.option("param");
        let message = Message::new(Kind::StateLength, text).at_option(&option);
        Some(message.help(
            "give the values of as many sites in the spec, or take as many sites as it has values",
        ))
    }

    /// The numbers of a file, the path of which stands in the spec and is relative to it.
    fn file(&mut self, name: &str, origin: Origin, sizes: [usize; AXES]) -> Option<Vec<f64>> {
        let source = &self.spec.source;
        let place = match origin {
            Origin::Text { start, end } => Place::Text(source.clone(), start..end),
            Origin::Span(_) => Place::File(source.path.clone()),
        };
        let folder = Path::new(&source.path).parent().unwrap_or(Path::new(""));
        let path = folder.join(name);
        let mut refuse = |kind, text: String, help: &str| {
            let text = format!("{}: {text}", path.display());
            let message = Message::new(kind, text).at_place(place.clone());
            self.mistakes.push(message.help(help));
            None
        };
        let bytes = match memory::read(&path) {
            Ok(bytes) => bytes,
            Err(error) => {
                let help = "the path is relative to the folder of the spec";
                return refuse(Kind::Io, format!("it cannot be read: {error}"), help);
            }
        };
        let array = match npy::parse(&bytes) {
            Ok(array) => array,
            Err(fault) => return refuse(Kind::Io, fault.text, fault.help),
        };
        let n = self.spec.model.dimension();
        let shape = array.shape.clone();
        let Some(state) = state(array, sizes, n) else {
            let sites = count(sizes);
            let text = format!("its shape is {shape:?}, for {sites} sites of {n} coordinates");
            let by_axes = match lattice::shown(&sizes) {
                [_] => String::new(),
                axes => {
                    let axes: Vec<String> = axes.iter().map(usize::to_string).collect();
                    format!(" or ({}, {n})", axes.join(", "))
                }
            };
            let help = format!(
                "write an array of the shape ({sites}, {n}){by_axes}, or one-dimensional the first coordinates of all sites, then the second ones; `--param` changes the number of sites"
            );
            return refuse(Kind::StateLength, text, &help);
        };
        match not_finite(&self.spec.model, &state) {
            Some(text) => refuse(Kind::Domain, text, FINITE),
            None => Some(state),
        }
    }
}

/// Why a splitting of a family does not run where these are the parameters: its pieces turn two sites by each other, which
/// are one on a short ring.
pub fn bound_to_itself(
    model: &Structure,
    choice: &Choice,
    parameters: &[f64],
    front: Front,
) -> Option<Message> {
    let splits = matches!(choice.solved(), Choice::Splitting(..));
    let family = model.family.as_ref().filter(|_| splits)?;
    let sizes = family.sites(parameters)?;
    let pieces = &model.family_pieces.as_ref()?.as_ref().ok()?.pieces;
    let piece = pieces.iter().find(|piece| {
        let offset = piece.offset;
        offset != [0; AXES] && (0..AXES).all(|axis| offset[axis] % sizes[axis] as i64 == 0)
    })?;
    let sites = words::sites(sizes);
    let text = format!(
        "on a ring of {sites} the bond `{}` joins a site to itself, and has no piece of a splitting",
        piece.describe(model)
    );
    let other = front.assignment("method", "gauss8");
    let help = format!("use {other}, which needs no pieces, or take another number of sites");
    let message = Message::new(Kind::Method, text).at_option(&front.option("method"));
    Some(message.help(help))
}

/// The state of a family in an array: a row for each site, or one-dimensional in the order of the state.
fn state(array: Array, sizes: [usize; AXES], n: usize) -> Option<Vec<f64>> {
    let (sites, Array { shape, values }) = (count(sizes), array);
    if shape == [sites * n] {
        return Some(values);
    }
    // axes of one site in front may stand in the shape
    let by_axes = |axes: &[usize]| axes.ends_with(lattice::shown(&sizes)) && sizes.ends_with(axes);
    let by_site = match shape.split_last() {
        Some((last, axes)) => *last == n && (axes == [sites] || by_axes(axes)),
        None => false,
    };
    let place = |place: usize| values[place % sites * n + place / sites];
    by_site.then(|| (0..sites * n).map(place).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_are_sites_and_a_flat_array_is_a_state() {
        let values: Vec<f64> = (0..6).map(f64::from).collect();
        let array = |shape: &[usize]| Array {
            shape: shape.to_vec(),
            values: values.clone(),
        };
        let by_component = Some(vec![0.0, 3.0, 1.0, 4.0, 2.0, 5.0]);
        assert_eq!(state(array(&[2, 3]), [1, 1, 2], 3), by_component);
        assert_eq!(state(array(&[1, 2, 3]), [1, 1, 2], 3), by_component);
        assert_eq!(state(array(&[2, 1, 3]), [1, 2, 1], 3), by_component);
        assert_eq!(state(array(&[2, 1, 1, 3]), [2, 1, 1], 3), by_component);
        assert_eq!(state(array(&[2, 1, 3]), [2, 1, 1], 3), None);
        assert_eq!(state(array(&[6]), [1, 1, 2], 3), Some(values.clone()));
        for shape in [&[3, 2][..], &[6, 1], &[1, 2, 3, 1], &[2, 1, 3], &[]] {
            let found = state(array(shape), [1, 1, 2], 3);
            assert_eq!(found, None, "{shape:?}");
        }
    }
}
