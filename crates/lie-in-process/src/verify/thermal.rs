//! The density that declared temperatures leave invariant.

use lie_codegen::model::Acting;
use lie_codegen::structure::Structure;
use lie_measure::facts::Thermal;
use lie_symbolic::symbolic::Symbol;

/// The density exp(-H/T) on orbits, where damping along them has a temperature, or on the space, where `rayleigh` has one; none without a
/// temperature. It is unknown where anything else acts, and where H changes with the time.
pub(super) fn density(model: &Structure, parameters: &[f64]) -> Option<Thermal> {
    let declared = &model.driving.as_ref()?.declared;
    let value = |symbol| match symbol {
        Symbol::Parameter(place) => parameters[place],
        _ => f64::NAN,
    };
    let warm = |acting: &Acting| match acting {
        Acting::Temperature(temperature) => Some(model.graph.evaluate(*temperature, &value)),
        _ => None,
    };
    let temperature = declared.iter().find_map(warm)?;
    let unknown = |why: &str| Some(Thermal::Unknown(why.to_owned()));
    if model.family.is_some() {
        return unknown("no quadrature is made over the spins of a family");
    }
    let (mut along, mut against) = (false, false);
    for pair in declared.chunks(2) {
        let [damping, noise] = pair else {
            return unknown("something without a temperature acts too");
        };
        match damping {
            Acting::DoubleBracket(..) => along = true,
            Acting::Rayleigh(_) => against = true,
            _ => return unknown("something without a temperature acts too"),
        }
        match warm(noise) {
            None => return unknown("something without a temperature acts too"),
            Some(other) if other != temperature => {
                return unknown("the damping has several temperatures");
            }
            Some(_) => {}
        }
    }
    if along && against {
        return unknown("damping along orbits and against them acts, and no orbit is kept");
    }
    if temperature.is_nan() {
        return unknown("the temperature is no number of the whole system");
    }
    if temperature <= 0.0 {
        return unknown("the temperature is 0, and nothing moves about");
    }
    if model.is_energy_driven() {
        return unknown("H changes with the time");
    }
    Some(match along {
        true => Thermal::Orbit(temperature),
        false => Thermal::Space(temperature),
    })
}
