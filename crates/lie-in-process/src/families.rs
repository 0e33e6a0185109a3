//! What is measured of families, and of how many sites.

use lie_codegen::program::Purpose;
use lie_codegen::structure::Structure;

/// The most coordinates of a family of which something is measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Limit {
    most: usize,
    why: &'static str,
}

/// Of `lie verify`.
pub const VERIFIED: Limit = Limit {
    most: 64,
    why: "matrices of all of them are computed",
};

/// Of `lie bench`.
pub const BENCHED: Limit = Limit {
    most: 100_000,
    why: "runs are compared with a reference solution of all of them",
};

/// Of `lie stress`.
pub const STRESSED: Limit = Limit {
    most: 64,
    why: "each of them is made small by itself",
};

impl Limit {
    /// That of a measurement; none of a run.
    pub fn for_purpose(purpose: Purpose) -> Option<Self> {
        match purpose {
            Purpose::Verify => Some(VERIFIED),
            Purpose::Bench => Some(BENCHED),
            Purpose::Stress => Some(STRESSED),
            Purpose::Run | Purpose::OnGroup(_) => None,
        }
    }

    /// What stands against measuring a family of so many coordinates in all, and a remedy.
    pub fn exceeded(&self, model: &Structure, coordinates: usize) -> Option<(String, String)> {
        let Self { most, why } = *self;
        if model.family.is_none() || coordinates <= most {
            return None;
        }
        let text = format!(
            "{} has {coordinates} coordinates, and {why} up to {most}",
            model.name
        );
        // beside those of the sites there are the time, inputs, and the noise of each site
        let state = model.complete_sites(Vec::new(), 0).len();
        let help = match most.saturating_sub(state) / model.numbers_of_a_site() {
            0 => "a single site has more: measure the sites as a system of their own".to_owned(),
            sites => format!("measure fewer sites, at most {sites}"),
        };
        Some((text, help))
    }
}
