// Whoever uses the type hears of nothing else.
fn main() {
    let mut body = Body::new();
    body.I1 = 3.0;
    let system = body.system().expect("finite constants");
    let problem = Problem::new(system, [1.0, 0.0, 0.5], (0.0, 1.0));
    let solution = solve(&problem, LieMidpoint::exp(), &Options::new(0.1)).expect("a solution");
    let single = Body::<f32>::default().system().expect("finite constants");
    let mut velocity = single.zero_state();
    single.vector_field(&single.zero_state(), &mut velocity);
    println!("{} {:?} {:?}", body.I2, solution.last(), solution.drift());
}
