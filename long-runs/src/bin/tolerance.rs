//! trial
use long_runs::drawn::member::Member;
use long_runs::measured::{Outcome, Way};
fn main() {
    let args: Vec<String> = std::env::args().collect();
    let (from, to): (u64, u64) = (args[1].parse().unwrap(), args[2].parse().unwrap());
    for number in from..to {
        let clock = std::time::Instant::now();
        let member = Member::draw(number);
        println!(
            "# {number} {} {:?} growth {:.1e} doubt {:.1e} refused {} span {:.2} {:.2}s",
            member.system.algebra.name,
            member.kind,
            member.growth,
            member.doubt,
            member.refused,
            member.span,
            clock.elapsed().as_secs_f64()
        );
        for way in Way::ALL {
            if !way.applies(&member) || (args.len() > 3 && !args[3..].iter().any(|a| a == way.id()))
            {
                continue;
            }
            for &tolerance in way.tolerances() {
                let clock = std::time::Instant::now();
                let outcome = way.run(&member, tolerance);
                let time = clock.elapsed().as_secs_f64();
                match outcome {
                    Outcome::Done {
                        error,
                        warned,
                        steps,
                        evaluations,
                    } => println!(
                        "{number} {} {tolerance:e} ratio {:.3e} perg {:.3e} warned {warned} steps {steps} evals {evaluations} time {time:.4}",
                        way.id(),
                        error / tolerance,
                        error / tolerance / member.growth
                    ),
                    Outcome::Refused(why) => println!(
                        "{number} {} {tolerance:e} REFUSED {why} time {time:.4}",
                        way.id()
                    ),
                }
            }
        }
    }
}
