//! A plan as text for people: what is computed, by how many operations, with a digest that changes when the operations do.

use std::fmt;
use std::hash::{Hash, Hasher};

use super::{Constants, Fused, Generating, Item, Method, Partner, Plan, Recurrence, Solver};
use super::{Energy, Found, Function, Spectrum, Structure};
use crate::structure::integrable::Motion;
use lie_symbolic::schedule::Program;

/// The width of the column of labels.
const LABEL: usize = 34;

impl fmt::Display for Plan {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let names = &self.names;
        writeln!(
            f,
            "plan of {} (# is a digest of the operations)",
            names.system
        )?;
        for line in self.docs.iter().filter(|line| !line.is_empty()) {
            writeln!(f, "  {line}")?;
        }
        list(f, "coordinates", &names.coordinates)?;
        list(f, "basis", &names.basis)?;
        let parameters = names.parameters.iter().zip(&self.parameters);
        let sign = |positive| if positive { " > 0" } else { "" };
        let parameters = parameters.map(|(name, p)| format!("{name}{}", sign(p.positive)));
        list(f, "parameters", &parameters.collect::<Vec<_>>())?;
        writeln!(f)?;
        constants(f, "constants of the system", &self.constants)?;
        section(f, "system")?;
        for function in self.system.functions() {
            write!(f, "{function}")?;
        }
        if self.system.energy == Energy::Legendre {
            writeln!(
                f,
                "  the energy is a Legendre transform by Newton's iteration"
            )?;
        }
        if !self.system.derivatives {
            writeln!(
                f,
                "  Hessian and Jacobian by dual numbers: no method needs them"
            )?;
        }
        write!(f, "{}", self.structure)?;
        for item in &self.items {
            write!(f, "{item}")?;
        }
        if let Some(splitting) = &self.splitting {
            section(f, "flows of the pieces of H")?;
            for flow in &splitting.flows {
                match &flow.function {
                    Some(function) => write!(f, "{function}")?,
                    None => writeln!(f, "  {}: by its series", names.coordinates[flow.coordinate])?,
                }
            }
        }
        if let Some(Found::Pieces { pieces, text, .. }) = &self.found {
            let of = text.as_ref().map(|text| format!(", {text}"));
            let of = of.unwrap_or_default();
            section(f, &format!("flows of the pieces that were found{of}"))?;
            for piece in pieces {
                writeln!(f, "  {}", piece.terms.join(", "))?;
                for part in &piece.parts {
                    match &part.flows {
                        Some(flows) => {
                            for function in flows.iter().filter_map(|flow| flow.function.as_ref()) {
                                write!(f, "{function}")?;
                            }
                        }
                        None => writeln!(f, "    by the exponential of its direction")?,
                    }
                }
            }
        }
        if let Some(family) = &self.family {
            section(f, "family")?;
            for function in family.functions() {
                write!(f, "{function}")?;
            }
        }
        list(f, "generic", &self.generic)
    }
}

impl fmt::Display for Function {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        line(f, &self.label, &self.program)?;
        writeln!(f, "    {}", self.formula)?;
        for explicit in &self.explicit {
            writeln!(f, "      {explicit}")?;
        }
        Ok(())
    }
}

impl fmt::Display for Structure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(group) = &self.group {
            let size = group.size;
            let is = |yes, text| if yes { text } else { "" };
            writeln!(
                f,
                "\ngroup of {size} x {size} matrices{}{}{}",
                is(group.closed, ", closed under Gauss methods"),
                is(group.orthogonal, ", orthogonal"),
                is(group.right, ", right-invariant")
            )?;
        }
        if let Some(representation) = &self.representation {
            let size = representation.size;
            let spectrum = match representation.spectrum {
                Spectrum::Imaginary => "imaginary eigenvalues",
                Spectrum::Bounded(_) => "real eigenvalues, bounded",
            };
            writeln!(
                f,
                "representation by {size} x {size} matrices with dual: {spectrum}"
            )?;
        }
        if let Some(spins) = &self.spins {
            writeln!(f, "spins {:?}", spins.coordinates)?;
        }
        if let Some(motion) = self.motion {
            let motion = match motion {
                Motion::Bodies => "free rigid bodies",
                Motion::Uniform => "a constant gradient along each solution",
            };
            writeln!(f, "flow in closed form: {motion}")?;
        }
        if let Some(vectors) = &self.vectors {
            let places = |vector: &[(usize, _); 3]| vector.each_ref().map(|(k, _)| *k);
            let found: Vec<[usize; 3]> = vectors.vectors.iter().map(places).collect();
            writeln!(f, "rotations {:?}, vectors {found:?}", vectors.rotation)?;
        }
        if let Some(unitary) = &self.unitary {
            writeln!(
                f,
                "unitary representation of {} complex rows",
                unitary.degree
            )?;
        }
        if let Some(smallest) = &self.smallest {
            let space = smallest.description();
            writeln!(f, "smallest linear space over it: {space}")?;
        }
        for function in self.flows() {
            write!(f, "{function}")?;
        }
        if let Some(inertia) = &self.inertia {
            writeln!(f, "free rigid body, planes {:?}", inertia.planes)?;
        }
        if let Some(momenta) = self.momenta {
            writeln!(
                f,
                "cotangent bundle, the first {momenta} coordinates are momenta"
            )?;
        }
        if let Some(realization) = &self.realization {
            section(f, "realization")?;
            for function in &realization.functions {
                write!(f, "{function}")?;
            }
        }
        let others = [
            ("retraction", &self.retraction),
            ("canonical coordinates", &self.canonical),
        ];
        for (title, functions) in others {
            if !functions.is_empty() {
                section(f, title)?;
            }
            for function in functions {
                write!(f, "{function}")?;
            }
        }
        Ok(())
    }
}

impl fmt::Display for Item {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Fused(fused) => write!(f, "{fused}"),
            Self::Generating(function) => write!(f, "{function}"),
            Self::Gradient(gradient) => {
                section(
                    f,
                    &format!(
                        "discrete gradient {} in closed form",
                        gradient.gradient.name()
                    ),
                )?;
                gradient
                    .functions
                    .iter()
                    .try_for_each(|function| write!(f, "{function}"))
            }
            Self::Sparse(sparse) => {
                let counts = sparse.elimination.counts();
                writeln!(f, "\n{}: {counts}", sparse.label)
            }
            Self::Method(method, solver) => writeln!(f, "{method} -> {solver}"),
            Self::Recurrence(recurrence) => write!(f, "{recurrence}"),
        }
    }
}

impl fmt::Display for Recurrence {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        section(f, &format!("Taylor coefficients for {}", self.label()))?;
        let [(of_begin, _), (of_advance, _)] = self.counts();
        line(f, &of_begin, &self.begin)?;
        line(f, &of_advance, &self.advance)?;
        writeln!(
            f,
            "    {} sums of products, {} values of order 0 kept",
            self.pairs, self.kept
        )?;
        match self.conditions {
            0 => Ok(()),
            count => writeln!(f, "    {count} conditions of branches"),
        }
    }
}

impl fmt::Display for Method {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Catalogue(choice) => f.write_str(&choice.label()),
            Self::Own(path) => f.write_str(path),
        }
    }
}

impl fmt::Display for Fused {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        section(f, &format!("equation {}", self.suffix))?;
        for doc in self.docs {
            writeln!(f, "  {doc}")?;
        }
        constants(f, "  constants of the step", &self.step)?;
        for function in &self.functions {
            write!(f, "{function}")?;
        }
        writeln!(
            f,
            "  elimination in the order {:?}, {} entries of fill-in: {}",
            self.elimination.order,
            self.elimination.fill.len(),
            self.elimination.counts()
        )
    }
}

impl fmt::Display for Generating {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        section(f, &format!("generating function {}", self.suffix))?;
        writeln!(f, "  {}", self.formula)?;
        constants(f, "  constants of the step", &self.step)?;
        write!(f, "{}", self.gradient)?;
        match &self.linearize {
            Some(linearize) => write!(f, "{linearize}"),
            None => writeln!(f, "  the Hessian over dual numbers"),
        }
    }
}

impl fmt::Display for Solver {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Fused(suffix) => write!(f, "equation {suffix}"),
            Self::Eliminated(partner, elimination) => write!(f, "{partner} by {elimination}"),
            Self::Generic(partner) => write!(f, "{partner}"),
        }
    }
}

impl fmt::Display for Partner {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Catalogue {
                equation, along, ..
            } => {
                write!(f, "generic {}", equation.key)?;
                along.map_or(Ok(()), |along| write!(f, " along {along}"))
            }
            Self::Own(path) => write!(f, "generic {path}"),
        }
    }
}

fn section(f: &mut fmt::Formatter<'_>, title: &str) -> fmt::Result {
    writeln!(f, "\n{title}")
}

fn list(f: &mut fmt::Formatter<'_>, title: &str, entries: &[String]) -> fmt::Result {
    if entries.is_empty() {
        return Ok(());
    }
    writeln!(f, "\n{title}: {}", entries.join(", "))
}

fn constants(f: &mut fmt::Formatter<'_>, title: &str, constants: &Constants) -> fmt::Result {
    if constants.entries.is_empty() {
        return Ok(());
    }
    line(f, title, &constants.program)?;
    for entry in &constants.entries {
        writeln!(f, "    {} = {}", entry.name, entry.text)?;
    }
    Ok(())
}

/// A label with the operation counts and the digest of its program.
fn line<P: fmt::Debug>(
    f: &mut fmt::Formatter<'_>,
    label: &str,
    program: &Program<P>,
) -> fmt::Result {
    writeln!(
        f,
        "  {label:LABEL$} {} #{:08x}",
        program.counts,
        digest(program)
    )
}

/// A digest of the operations, the same on every machine.
fn digest<P: fmt::Debug>(program: &Program<P>) -> u32 {
    let mut hasher = Fnv(0xcbf2_9ce4_8422_2325);
    format!("{program:?}").hash(&mut hasher);
    let value = hasher.finish();
    (value ^ (value >> 32)) as u32
}

/// The hash function of Fowler, Noll and Vo, 64 bits (RFC 9923).
struct Fnv(u64);

impl Hasher for Fnv {
    fn finish(&self) -> u64 {
        self.0
    }

    fn write(&mut self, bytes: &[u8]) {
        for byte in bytes {
            self.0 = (self.0 ^ u64::from(*byte)).wrapping_mul(0x0000_0100_0000_01b3);
        }
    }
}
