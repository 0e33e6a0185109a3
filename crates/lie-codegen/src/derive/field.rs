//! Energy, Casimirs and the field: the kernels of a Poisson system.

use super::{Argument, Block, Bracket, Kernel, Source};
use crate::model::{Acting, Hamiltonian};
use lie_symbolic::prove::joints::joints_in;
use lie_symbolic::symbolic::{ExprId, Symbol};

pub(super) fn mu(source: &Source) -> Argument {
    Argument {
        name: "mu",
        symbols: (0..source.dimension).map(Symbol::Coordinate).collect(),
    }
}

/// All kernels, or those without derivatives of the field and second ones of H.
pub(super) fn kernels(source: &mut Source, derivatives: bool) -> Vec<Kernel> {
    let mut kernels = Vec::new();
    let hamiltonian = source.energy.expression().cloned();
    if let Some(hamiltonian) = &hamiltonian {
        kernels.extend(motion(source, hamiltonian.value, derivatives));
    }
    kernels.extend(driving(source));
    if derivatives {
        kernels.extend(metriplectic(source));
    }
    let matrix = poisson_matrix(source);
    let [of_matrix, ..] = formulas(source.is_lie());
    let arguments = vec![mu(source)];
    let poisson_matrix = Kernel::matrix(
        &source.graph,
        "poisson_matrix",
        of_matrix,
        arguments,
        &matrix,
    );
    kernels.insert(kernels.len().min(3), poisson_matrix);
    kernels.extend(joints(source, hamiltonian.as_ref()));
    let graph = &source.graph;
    let arguments = || vec![mu(source)];
    if let Some(Hamiltonian { value, energy, .. }) = hamiltonian
        && value != energy
    {
        let formula = "`H(t, mu)`, without the momentum of the time";
        kernels.push(Kernel::scalar("energy", formula, arguments(), energy));
    }
    let values = source.casimirs.clone();
    kernels.push(Kernel::vector(
        graph,
        "casimirs",
        "`out_i = C_i(mu)`",
        arguments(),
        &values,
    ));
    let gradients: Vec<Vec<ExprId>> = values
        .iter()
        .map(|c| {
            (0..source.dimension)
                .map(|i| source.graph.derivative(*c, Symbol::Coordinate(i)))
                .collect()
        })
        .collect();
    for gradient in gradients {
        let arguments = vec![mu(source)];
        kernels.push(Kernel::vector(
            &source.graph,
            "casimir_gradient",
            "`out_i = dC/dmu_i`",
            arguments,
            &gradient,
        ));
    }
    for (name, formula, values) in [
        ("quantities", "`out_i = q_i(mu)`", source.quantities.clone()),
        (
            "events",
            "`out_i = g_i(mu)`, whose zeros are events",
            source.events.clone(),
        ),
    ] {
        let kernel = || Kernel::values(name, formula, vec![mu(source)], values.clone());
        kernels.extend((!values.is_empty()).then(kernel));
    }
    kernels
}

/// The force and the generator with their slopes, where something acts beside the Hamiltonian.
fn driving(source: &mut Source) -> Vec<Kernel> {
    let mut kernels = Vec::new();
    let mut push = |source: &mut Source, names: [&'static str; 4], values: &[ExprId]| {
        let slope = jacobian(source, values);
        let [vector, formula, matrix, slopes] = names;
        let arguments = || vec![mu(source)];
        let graph = &source.graph;
        kernels.push(Kernel::vector(graph, vector, formula, arguments(), values));
        kernels.push(Kernel::matrix(graph, matrix, slopes, arguments(), &slope));
    };
    if let Some(force) = source.force() {
        let names = [
            "force",
            "`out_i = F_i`",
            "force_slope",
            "`out_ij = dF_i/dmu_j`",
        ];
        push(source, names, &force);
    }
    if !source.is_damped() {
        return kernels;
    }
    let generator = source.generator();
    let names = [
        "generator",
        "`out = xi = grad H + c G ad*_{grad H} mu`",
        "generator_slope",
        "`out_ij = dxi_i/dmu_j`",
    ];
    push(source, names, &generator);
    kernels.extend(damping(source));
    kernels
}

/// The entropy and the metric of a metriplectic term, with their derivatives.
fn metriplectic(source: &mut Source) -> Vec<Kernel> {
    let Some((entropy, rows)) = source.metriplectic() else {
        return Vec::new();
    };
    let zero = source.graph.integer(0);
    let mut metric = vec![vec![zero; source.dimension]; source.dimension];
    for (row, given) in metric.iter_mut().zip(rows) {
        row[..given.len()].copy_from_slice(&given);
    }
    let gradient = source.jacobian_of(&[entropy]).concat();
    let hessian = source.jacobian_of(&gradient);
    let v = source.block(Block::Xi);
    let moved: Vec<ExprId> = metric
        .iter()
        .map(|row| {
            let pairs = row.iter().zip(&v);
            let parts: Vec<ExprId> = pairs.map(|(k, v)| source.graph.mul(*k, *v)).collect();
            source.graph.sum(&parts)
        })
        .collect();
    let slope = source.jacobian_of(&moved);
    let at = mu(source);
    let along = Argument {
        name: "xi",
        symbols: source.symbols(Block::Xi),
    };
    let arguments = || vec![at.clone()];
    let graph = &source.graph;
    vec![
        Kernel::scalar("entropy", "`S(mu)`", arguments(), entropy),
        Kernel::vector(
            graph,
            "entropy_gradient",
            "`out_i = dS/dmu_i`",
            arguments(),
            &gradient,
        ),
        Kernel::matrix(
            graph,
            "entropy_hessian",
            "`out_ij = d^2S/dmu_i dmu_j`",
            arguments(),
            &hessian,
        ),
        Kernel::matrix(graph, "metric", "`out_ij = K_ij`", arguments(), &metric),
        Kernel::matrix(
            graph,
            "metric_slope",
            "`out_ij = d(K xi)_i/dmu_j` at a fixed vector xi",
            vec![at.clone(), along],
            &slope,
        ),
    ]
}

/// What the double brackets make of a covector: `sum c G v`.
fn damping(source: &mut Source) -> Option<Kernel> {
    let declared = source.driving.as_ref()?.declared.clone();
    let v = source.block(Block::Xi);
    let zero = source.graph.integer(0);
    let mut out = vec![zero; source.dimension];
    let mut any = false;
    for acting in &declared {
        let Acting::DoubleBracket(strength, metric) = acting else {
            continue;
        };
        any = true;
        let own = metric.as_ref().map_or_else(|| source.own(), Vec::len);
        for (i, slot) in out.iter_mut().enumerate().take(own) {
            let lowered = match metric {
                Some(rows) => {
                    let parts = rows[i].iter().zip(&v);
                    let parts: Vec<ExprId> = parts.map(|(g, v)| source.graph.mul(*g, *v)).collect();
                    source.graph.sum(&parts)
                }
                None => v[i],
            };
            let part = source.graph.mul(*strength, lowered);
            *slot = source.graph.add(*slot, part);
        }
    }
    let arguments = vec![
        mu(source),
        Argument {
            name: "xi",
            symbols: source.symbols(Block::Xi),
        },
    ];
    let formula = "`out = c G v` of a covector v";
    any.then(|| Kernel::vector(&source.graph, "damping", formula, arguments, &out))
}

/// What is 0 where branches of H meet at a time that is known beforehand.
fn joints(source: &mut Source, hamiltonian: Option<&Hamiltonian>) -> Option<Kernel> {
    let (clock, hamiltonian) = (source.clock()?, hamiltonian?);
    let known = |symbol| match symbol {
        Symbol::Coordinate(place) => place == clock.time,
        Symbol::Parameter(_) => true,
        _ => false,
    };
    let mut places = joints_in(&mut source.graph, hamiltonian.value, &known);
    for force in source.force().unwrap_or_default() {
        for place in joints_in(&mut source.graph, force, &known) {
            if !places.contains(&place) {
                places.push(place);
            }
        }
    }
    let formula = "`out_i = g_i(t)`, which is 0 where branches of H meet";
    let arguments = vec![mu(source)];
    (!places.is_empty())
        .then(|| Kernel::vector(&source.graph, "joints", formula, arguments, &places))
}

/// What comes from an expression of H.
fn motion(source: &mut Source, hamiltonian: ExprId, derivatives: bool) -> Vec<Kernel> {
    let gradient = source.gradient_of_h();
    let field = source.field();
    let [_, of_field, of_both] = formulas(source.is_lie());
    let arguments = vec![mu(source)];
    let graph = &source.graph;
    let of_h = Kernel::scalar("hamiltonian", "`H(mu)`", arguments.clone(), hamiltonian);
    let formula = "`out_i = dH/dmu_i`";
    let of_slope = Kernel::vector(graph, "gradient", formula, arguments.clone(), &gradient);
    let mut of_f = Kernel::vector(graph, "vector_field", of_field, arguments.clone(), &field);
    if !derivatives {
        return vec![of_h, of_slope, of_f];
    }
    let hessian = source.hessian_of_h();
    let jacobian = jacobian(source, &field);
    let graph = &source.graph;
    let arguments = || arguments.clone();
    let mut of_j = Kernel::matrix(
        graph,
        "jacobian",
        "`out_ij = df_i/dmu_j`",
        arguments(),
        &jacobian,
    );
    let mut both = Kernel::fused(graph, "linearize", of_both, arguments(), &field, &jacobian);
    Kernel::agree(&mut of_f, &mut of_j, &mut both);
    vec![
        of_h,
        of_slope,
        Kernel::matrix(
            graph,
            "hessian",
            "`out_ij = d^2H/dmu_i dmu_j`",
            arguments(),
            &hessian,
        ),
        of_f,
        of_j,
        both,
    ]
}

/// The formulas of the Poisson matrix, of the field, and of the field with its Jacobian.
fn formulas(is_lie: bool) -> [&'static str; 3] {
    if is_lie {
        [
            "`out_ij = {mu_i, mu_j} = -C_ij^k mu_k`",
            "`f_j = C_ij^k (dH/dmu_i) mu_k`",
            "`f_j = C_ij^k (dH/dmu_i) mu_k` and `df_i/dmu_j`",
        ]
    } else {
        [
            "`out_ij = {mu_i, mu_j} = Pi_ij(mu)`",
            "`f_i = Pi_ij(mu) (dH/dmu_j)`",
            "`f_i = Pi_ij(mu) (dH/dmu_j)` and `df_i/dmu_j`",
        ]
    }
}

/// `df_i/dmu_j`
pub(super) fn jacobian(source: &mut Source, field: &[ExprId]) -> Vec<Vec<ExprId>> {
    field
        .iter()
        .map(|f| {
            (0..source.dimension)
                .map(|j| source.graph.derivative(*f, Symbol::Coordinate(j)))
                .collect()
        })
        .collect()
}

/// `Pi_ab`, of a Lie algebra `-C_ab^k mu_k`.
pub(super) fn poisson_matrix(source: &mut Source) -> Vec<Vec<ExprId>> {
    if let Bracket::Entries(entries) = source.bracket.clone() {
        return super::poisson::matrix(source, &entries);
    }
    let n = source.dimension;
    let mu = source.coordinates();
    let zero = source.graph.integer(0);
    let mut rows = vec![vec![zero; n]; n];
    for (a, b, k, value) in source.all_constants() {
        let term = source.graph.mul(value, mu[k]);
        rows[a][b] = source.graph.sub(rows[a][b], term);
    }
    rows
}
