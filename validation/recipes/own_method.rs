//! An integrator in a crate of your own, and its observed order. Beside a clone of this repository, `shearbed`:
//!
//! ```sh
//! cargo new my_method && cd my_method
//! cargo add --path ../shearbed/validation/methods
//! cp ../shearbed/validation/recipes/own_method.rs src/main.rs && cargo run
//! ```
use shearbed_methods::integrators::{Integrator, RodProblem, Setting, grade};

fn main() {
    // Heun's method: a step of length h (in 1/G) from p.
    let heun = Integrator::in_p("Heun", 2, |problem, p, h| {
        let k1 = problem.rate(&p);
        p + 0.5 * h * (k1 + problem.rate(&(p + h * k1)))
    });
    let (problem, start) = RodProblem::mid_flip(11.6);
    let error = |steps| grade(&heun, &problem, &start, Setting::Steps(steps)).expect("finite").orientation_rad;
    println!("observed order {:.2}", (error(4096) / error(8192)).log2());
}
