//! Rigid slender rods in a sheared viscous liquid, after Lee & Springer (1982).
//!
//! # The model on one page
//!
//! The liquid moves as u = L·x with a constant velocity gradient L (eqs 2 and 3, [`model::flow`]). A rod's centre
//! moves with the liquid; its direction p (|p| = 1, p ≡ −p, [`model::orientation`]) turns by Jeffery's equation
//! ṗ = W·p + Λ(D·p − p p·D·p) ([`model::jeffery`]), whose exact solution over any time is p = q/|q| with
//! q = exp((W + ΛD)t) p(0) ([`motion`]). In plane Couette flow u_2 = G x_1 it has the period
//! T = 2π(r_e + 1/r_e)/G (eq. 15).
//!
//! In each time step every rod finds its nearest neighbour in the control volume and draws a random number R. Where P_c
//! = (α/(s/a + α))^m > R (eqs 7 and 8, [`model::collision`]) the two rods collide: the velocities of their contact
//! points along the contact line ([`model::contact`]) become their mean (eqs 5 and 6), and for that step each rod turns
//! accordingly (A.7 to A.14). All other rods take Jeffery's exact motion ([`suspension`]).
//!
//! The results are means over rods against time ([`observable`]): projections (eqs 4 and 21), the mean angle (eq. 18),
//! the orbit constant (eq. 13), ⟨pp⟩; or an observable of your own ([`run::own`]).
//!
//! # Data goes one way
//!
//! A scene file ([`scene::parse`]) is a [`Scene`]; a [`Plan`] checks it, says which stages it needs and drops the rest;
//! [`run::ensemble::run`] runs the plan's replicas, each by [`run::run_replica`], and returns [`Results`].
//!
//! ```
//! let text = r#"
//! title = "free rods"
//! [flow]
//! shear_rate_per_s = 0.5
//! [particles]
//! count = 1000
//! length_mm = 0.72
//! aspect_ratio = 11.6
//! orientation = "isotropic"
//! [time]
//! periods = 1
//! outputs_per_period = 4
//! "#;
//! let scene = shearbed::scene::parse("free.toml", text)?;
//! let plan = shearbed::Plan::new(&scene)?;
//! let results = shearbed::run::ensemble::run(&plan)?;
//! // Free rods of one aspect ratio are back after half a period, because p ≡ −p.
//! let x1 = &results.column("x1").expect("projections are the default").mean;
//! assert!((x1[2] - x1[0]).abs() < 1e-12);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
#![cfg_attr(not(test), deny(clippy::disallowed_methods, clippy::disallowed_types))]
#![forbid(unsafe_code)]

pub mod model;
pub mod motion;
pub mod observable;
pub mod scene;
pub mod plan;
pub mod suspension;
pub mod run;

/// Re-exported because vectors and matrices in this crate's interface are nalgebra's.
pub use nalgebra;

pub use observable::Observable;
pub use plan::Plan;
pub use run::ensemble::Results;
pub use scene::{Error, Scene};
pub use suspension::Suspension;

/// Configuration of property tests: a fixed seed, so that every run draws the same examples.
#[cfg(test)]
fn fixed_seed(cases: u32) -> proptest::test_runner::Config {
    proptest::test_runner::Config {
        rng_seed: proptest::test_runner::RngSeed::Fixed(1982),
        failure_persistence: None,
        cases,
        ..Default::default()
    }
}

/// The code in the library's README.
#[cfg(doctest)]
#[doc = include_str!("README.md")]
pub struct Readme;
