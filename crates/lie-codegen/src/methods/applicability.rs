//! Which methods a system can carry.

use super::acting::driven;
use super::constrained::almost_poisson;
use super::{CATALOGUE, Choice, Lift, Pieces, Retraction, Scheme, Tensor};
use crate::model::{Bracket, Descent, Discrete, Energy, Model};
use crate::structure::{
    Structure, conjugate, flows, found, inertia, integrable, lifts, matrices, separable, spins,
    unitary, vectors,
};
use lie_syntax::diagnostic::Kind;

/// Why a method does not apply to a system, with the nearest one that does; `None` if it applies.
pub fn refusal(structure: &Structure, choice: &Choice) -> Option<(String, String)> {
    if let Choice::Compose(_, _, base) = choice {
        return refusal(structure, base);
    }
    if let Some(pieces) = &structure.family_pieces {
        let acts = structure.driving.is_some();
        return driven(structure, choice).or_else(|| family(pieces.as_ref().err(), acts, choice));
    }
    let model = &structure.model;
    let whole = almost_poisson(model, choice).or_else(|| bracket(model, choice));
    let whole = whole.or_else(|| driven(model, choice));
    if let Some(reason) = whole.or_else(|| lagrangian(model, choice)) {
        return Some(reason);
    }
    match choice {
        Choice::DiscreteGradient(_, Tensor::Mean) => tensor(model, choice),
        Choice::Splitting(order, scheme, pieces) => {
            let (why, count) = match pieces {
                Pieces::Found => (
                    found::refusal(structure, *order),
                    structure.splitting.count(),
                ),
                Pieces::Coordinate => (
                    separable::refusal(structure, *order),
                    structure.pieces.as_ref().map_or(0, Vec::len),
                ),
            };
            why.or_else(|| near_integrable(*order, *scheme, count + structure.pieces_beside()))
        }
        Choice::Generating(6, Retraction::Cayley) => Some((
            "the generating function of order 6 is known in exponential coordinates, not in those \
             of the Cayley map"
                .into(),
            "use `generating6` with `--retraction exp`, or `generating4` with `--retraction cayley`"
                .into(),
        )),
        Choice::LieMidpoint(Retraction::Cayley)
        | Choice::Generating(_, Retraction::Cayley)
        | Choice::Variational(_, Retraction::Cayley)
        | Choice::DiscreteEulerPoincare(Retraction::Cayley) => {
            cayley(model).map(|reason| {
                let discrete = matches!(choice, Choice::DiscreteEulerPoincare(_));
                let help = match in_entries(model) && discrete {
                    true => IN_OTHERS.into(),
                    false => format!(
                        "use `{}` with `--retraction exp`, which works for every Lie algebra",
                        choice.id()
                    ),
                };
                (reason.into(), help)
            })
        }
        Choice::LieMidpoint(Retraction::Spec) | Choice::Variational(_, Retraction::Spec) => {
            retraction(model)
        }
        Choice::Canonical(order) => conjugate::refusal(structure, *order),
        Choice::Collective(order, Lift::Representation) | Choice::Isospectral(order) => {
            matrices::refusal(structure, *order)
        }
        Choice::Collective(order, Lift::Spec) => realization(model, *order),
        Choice::Collective(order, Lift::Hopf) => spins::refusal(structure, Some(*order)),
        Choice::Exact => integrable::refusal(structure),
        Choice::Taylor | Choice::LieTaylor => expression(model).or_else(|| own_joints(structure)),
        Choice::Collective(order, Lift::Quaternion) => vectors::refusal(structure, *order),
        Choice::Collective(order, Lift::Unitary) => unitary::refusal(structure, *order),
        Choice::Collective(order, Lift::Smallest) => lifts::refusal(structure, *order),
        Choice::EulerArnold2 => cotangent(model),
        Choice::NinomiyaVictoir => flows::unsteady_noise(model),
        Choice::SphericalMidpoint => spins::refusal(structure, None),
        Choice::MoserVeselov => inertia::refusal(structure),
        _ => None,
    }
}

/// Why coefficients for two pieces are not for this many.
fn near_integrable(order: u32, scheme: Scheme, pieces: usize) -> Option<(String, String)> {
    (scheme.is_near_integrable() && pieces > 2).then(|| {
        let message = format!(
            "the coefficients `{}` are for two pieces of which one is small, and there are {pieces}",
            scheme.name()
        );
        (message, other_scheme(order))
    })
}

/// The remedy: the default scheme of an order.
fn other_scheme(order: u32) -> String {
    let default = Scheme::of_splitting(order).next();
    let name = default.map_or("", Scheme::name);
    format!("use `splitting{order}` with `--composition {name}`, which is for any number of pieces")
}

/// Why a method does not apply to a family, of which no matrix is kept; there may be no pieces of it, for a reason.
fn family(no_pieces: Option<&String>, acts: bool, choice: &Choice) -> Option<(String, String)> {
    match choice {
        Choice::Splitting(_, _, Pieces::Coordinate) => Some((
            "the pieces of a family are those of its sums".into(),
            "leave `--pieces` out".into(),
        )),
        Choice::Splitting(order, scheme, _) => {
            if let Some(why) = no_pieces {
                let help = match acts {
                    true => "use `gauss16` or `rk4`, which take the whole field",
                    false => "use `gauss16`, which keeps quadratic Casimirs",
                };
                return Some((format!("{NO_PIECES}: {why}"), help.into()));
            }
            if !scheme.is_near_integrable() {
                return None;
            }
            let message = format!(
                "the coefficients `{}` are for two pieces of which one is small, and those of a family are counted \
                 at each site",
                scheme.name()
            );
            Some((message, other_scheme(*order)))
        }
        Choice::Rk4 | Choice::Dopri5 => None,
        Choice::Gauss(stages) if *stages >= PARALLEL => None,
        _ => {
            let message = "a family keeps no matrix of all its coordinates, and the method is not one that does without";
            let help = "use `gauss16`, which iterates without one and keeps quadratic Casimirs, or `dopri5`";
            Some((message.into(), help.into()))
        }
    }
}

/// What stands before the reason why a family has no splitting.
const NO_PIECES: &str = "it is not made of pieces with exact flows";

/// Gauss methods with so many stages or more are solved without a matrix.
const PARALLEL: usize = 4;

/// Why solutions are not developed into series.
fn expression(model: &Model) -> Option<(String, String)> {
    model.energy.expression().is_none().then(|| {
        (
            "it differentiates an expression of H, and H is a Legendre transform by iteration"
                .into(),
            "use `gauss16`, or `rkmk6`, which need the velocity alone".into(),
        )
    })
}

/// Why a series does not find the joints of H.
fn own_joints(structure: &Structure) -> Option<(String, String)> {
    let model = &structure.model;
    let own = model.graph.own_functions(model.energy.expression()?.value);
    (!structure.joints.is_empty() && !own.is_empty()).then(|| {
        (
            "its series hold on one branch of H, and with a function of Rust in H it does not see where branches change".into(),
            "use `gauss4`, or `rk4`, which have the order that `lie check` names at joints".into(),
        )
    })
}

/// Why a method for Lagrangians does not apply.
fn lagrangian(model: &Model, choice: &Choice) -> Option<(String, String)> {
    match choice {
        Choice::Variational(order, _) if matches!(model.energy, Energy::Expression(_)) => {
            let other = match (&model.driving, order) {
                (None, order) => {
                    format!("`generating{order}`, which is a Poisson map of the same order")
                }
                (Some(_), 2) => "`lie-midpoint`, which carries forces in the same way".into(),
                (Some(_), order) => {
                    format!("`compose{order}(lie-midpoint)`, which has the same order")
                }
            };
            Some((
                "the method needs a Lagrangian, and the system is given by its Hamiltonian".into(),
                format!(
                    "declare `velocity` and `lagrangian` instead of `hamiltonian`, or use {other}"
                ),
            ))
        }
        Choice::Variational(order @ (4 | 6), Retraction::Cayley)
            if !model.energy.is_transformed() =>
        {
            let message = "of a reduced Lagrangian the step of this order is along the exponential map; along the Cayley map it is for Lagrangians \
                           with the group element, the time or something that acts beside them";
            let help = format!(
                "use `variational{order}` with `--retraction exp`, or `compose{order}(variational2)` with `--retraction cayley`"
            );
            Some((message.into(), help))
        }
        Choice::DiscreteEulerPoincare(_) if discrete(model).is_none() => {
            let message = "the method needs a discrete Lagrangian, and the system declares none";
            let help = "declare `discrete_lagrangian`; for a system with a `lagrangian` use `variational2`";
            Some((message.into(), help.into()))
        }
        Choice::DiscreteEulerPoincare(Retraction::Exp) if in_entries(model) => {
            let message = "the discrete Lagrangian is written in the entries of the group element, which are functions \
                           of the coordinates of the Cayley map";
            let help = match cayley(model) {
                None => "use `--retraction cayley`",
                Some(_) => IN_OTHERS,
            };
            Some((message.into(), help.into()))
        }
        _ => None,
    }
}

/// Why a method does not apply to the bracket of a system, whatever H is.
fn bracket(model: &Model, choice: &Choice) -> Option<(String, String)> {
    if matches!(choice, Choice::Splitting(.., Pieces::Coordinate)) && !model.is_lie_poisson() {
        return Some((
            "pieces of one coordinate each have the flows of elements of a Lie algebra, and the system declares a general bracket".into(),
            "leave `--pieces` out".into(),
        ));
    }
    let method = choice.entry().filter(|method| method.needs_algebra())?;
    let nearest = match method.order {
        // what acts leaves no place for a generating function
        _ if model.driving.is_some() => "`midpoint` or `gauss16`, which take the whole field",
        1 | 2 => {
            "`orbit-energy`, which keeps the Casimirs and the energy, or `k-hj2`, a Poisson map"
        }
        3 | 4 => {
            "`compose4(orbit-energy)`, which keeps the Casimirs and the energy, or `k-hj4`, a Poisson map"
        }
        5 | 6 => "`k-hj6`, a Poisson map, or `gauss6`",
        7 | 8 => "`gauss8` or `cohen-hairer8`",
        _ => "`gauss16` or `cohen-hairer16`",
    };
    let apply = format!("use {nearest}: both apply to every Poisson bracket");
    match model.bracket {
        Bracket::Lie(_) => None,
        Bracket::General(_) => Some((
            "it needs a Lie algebra, and the system declares a general bracket".into(),
            apply,
        )),
    }
}

/// What to do where entries of the group element stand in a discrete Lagrangian, and there is no Cayley map.
const IN_OTHERS: &str = "declare matrices whose span is closed under (abc + cba)/2, such as those of u(n) around su(n), or give the discrete \
                         Lagrangian in exponential coordinates, without `group`";

/// Whether a discrete Lagrangian is written in the entries of the group element.
fn in_entries(model: &Model) -> bool {
    discrete(model).is_some_and(|discrete| discrete.in_entries.is_some())
}

/// The discrete Lagrangian by which a system is declared.
fn discrete(model: &Model) -> Option<&Discrete> {
    model.energy.lagrangian()?.discrete.as_ref()
}

/// Why there is no choice of the tensor.
fn tensor(model: &Model, choice: &Choice) -> Option<(String, String)> {
    let matrix = model.bracket.matrix();
    let affine = matrix.is_none_or(|matrix| matrix.degree.is_some_and(|degree| degree <= 1));
    affine.then(|| {
        let id = choice.id();
        (
            "the Poisson matrix is affine in the coordinates, and its mean over the ends of a step is \
             its value at the midpoint"
                .into(),
            format!("use `{id}` without the option: the steps are the same"),
        )
    })
}

/// Why there is no retraction of the user's own.
fn retraction(model: &Model) -> Option<(String, String)> {
    model.retraction.is_none().then(|| {
        (
            "the retraction `spec` is one that is declared, and none is".into(),
            "declare `retraction`, the matrix of a group element as a function of one of the algebra".into(),
        )
    })
}

/// Why a collective method has no declared realization to go over.
fn realization(model: &Model, order: u32) -> Option<(String, String)> {
    let Some(realization) = &model.realization else {
        return Some((
            "the lift `spec` needs a realization, and none is declared".into(),
            "declare `realization`, a map from canonical coordinates to the state".into(),
        ));
    };
    let nearest = match order {
        2 => "use `lie-midpoint`, which works for every Lie algebra".to_owned(),
        order => format!("use `compose{order}(lie-midpoint)`, which works for every Lie algebra"),
    };
    let reason = match realization.descent {
        Descent::Closed => return None,
        Descent::Degree => format!(
            "the components of the realization must have degree at most two: otherwise the Gauss method of order \
             {order} does not descend to the state"
        ),
        Descent::Adds { commuting: false } => {
            "the flows of the components are linear maps, which must be closed under (abc + cba)/2; for this \
             realization the closure adds others: the step would depend on the point over the state and leave the \
             coadjoint orbit"
                .into()
        }
        Descent::Adds { commuting: true } => {
            "the closure of the components of the realization under (abc + cba)/2 adds functions that commute with them: \
             the step would depend on their values, which the state does not determine"
                .into()
        }
        Descent::Unknown => {
            "it could not be decided whether the components of the realization are closed under (abc + cba)/2: their \
             coefficients are not rational functions of the parameters, or there are too many"
                .into()
        }
    };
    Some((reason, nearest))
}

/// Why a system is none on `T*G`.
fn cotangent(model: &Model) -> Option<(String, String)> {
    let group = model.configuration.as_ref().and_then(|c| c.group.as_ref());
    group.is_none().then(|| {
        (
            "the method is for systems on T*G, and no group element is declared".into(),
            "declare `group` in addition to `matrices`, or use `lie-midpoint`".into(),
        )
    })
}

/// Why a system has no Cayley map.
fn cayley(model: &Model) -> Option<&'static str> {
    let bracket = &model.bracket;
    if bracket.triple().is_some() {
        return None;
    }
    let represented = bracket.representation().is_some();
    let parametric = bracket.parametric().is_some();
    let extended = bracket.algebra().is_some_and(|algebra| {
        let declared = parametric || algebra.group_representation().is_some();
        algebra.extension.is_some() && declared && !represented
    });
    match () {
        () if extended => Some(
            "the Cayley map needs a matrix representation, and the declared `matrices` are not those of the central \
             extension that the cocycle makes",
        ),
        () if represented || parametric => Some(
            "the Cayley map needs a representation whose span is closed under (abc + cba)/2, \
             and the declared `matrices` are not",
        ),
        () => Some(
            "the Cayley map needs a matrix representation, and the algebra declares no `matrices`",
        ),
    }
}

/// Why there is nothing to compose: the midpoint rule applies to every system but families, whose splittings may.
fn composed(structure: &Structure) -> Option<String> {
    let of_family = structure.family_pieces.as_ref()?.as_ref().err()?;
    let why = "no symmetric method of order 2 applies";
    Some(format!("{why}: {NO_PIECES}: {of_family}"))
}

/// The kind of the mistake to ask for a method of a system that cannot carry it.
pub fn kind_of_refusal(choice: &Choice) -> Kind {
    match choice.solved() {
        Choice::Splitting(..) => Kind::Splitting,
        _ => Kind::Method,
    }
}

/// Every method of the catalogue with the reason why it cannot be used, if there is one.
pub fn applicability(structure: &Structure) -> Vec<(&'static str, Option<String>)> {
    CATALOGUE
        .iter()
        .map(|method| {
            let composition = method.id.starts_with("compose");
            let reason = match Choice::from_id(method.id) {
                _ if composition => composed(structure),
                Err(unusable) => Some(unusable.message),
                Ok(choice) => refusal(structure, &choice).map(|(reason, _)| reason),
            };
            (method.id, reason)
        })
        .collect()
}
