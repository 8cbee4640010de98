//! The orbits of rods: with weak rotary diffusion, whose distribution of C is known, and with collisions.

use super::*;
use crate::methods::coefficients::jumps::{Quantity, Shares, Watch, above};
use crate::oracle::closed_form::orbit_constant_cdf;
use crate::oracle::diffusion::orbits::cdf;
use crate::studies::coefficients;
use crate::studies::coefficients::jumps::{diffused, kicked};

const ASPECT_RATIO: f64 = 11.6;

/// Weak diffusion: C_I r_e³ is 0.3.
const C_I: f64 = 2e-4;

#[derive(Clone, Copy)]
struct Orbits {
    /// The distribution function of C_b for weak diffusion.
    weak: fn(f64, f64) -> f64,
    collisions: Change,
}

pub fn cases() -> Vec<Case> {
    let right = Orbits { weak: cdf, collisions: |_| {} };
    vec![
        Case::interpretation("orbits-of-collisions")
            .claim(
                "Weak rotary diffusion leaves the closed form's 46.1 % of rods of r_e = 11.6 above C_b = ½; \
                 collisions leave far more there than isotropic directions have, 50.7 %.",
            )
            .source("eq. 13; Leal & Hinch 1971; docs/src/theory/diffusion.md")
            .under_test(right)
            .mistake(
                "the orbits of isotropic directions for those of weak diffusion",
                Orbits { weak: orbit_constant_cdf, ..right },
            )
            .mistake(
                "hardly any collisions: α of 10⁻⁶",
                Orbits { collisions: |scene| lab::interaction(scene).alpha = 1e-6, ..right },
            )
            .check(orbits),
    ]
}

static OF_DIFFUSION: Shared<(), Vec<Shares>> = Shared::new();

fn orbits(orbits: &Orbits, effort: &Effort) -> Vec<Evidence> {
    let (weak, high) = (Design::new(0.031, 0.06), Design::new(0.15, 0.06));
    let setting = coefficients::kick(0.5, ASPECT_RATIO, 0.5, 1);
    let scene = coefficients::scene(setting, effort);
    // C_I times the strain before is 0.07, and A(C)'s r_e²/2 makes that long enough. Diffusing rods turn exactly
    // between coarse steps.
    let watch = Watch::new(&scene, 5.0, 1.0);
    let coarse = Watch { steps: 1, strain: strain_per_period(ASPECT_RATIO) / 50.0, before: 250, jumps: 1 };
    let of_diffusion =
        OF_DIFFUSION.get(effort, (), || diffused(&scene, C_I, coarse, effort.samples(weak), (effort, 1 << 22)));
    let suspension = lab::changed(scene.clone(), orbits.collisions);
    let of_collisions = kicked(&suspension, watch, effort.samples(high));
    let less = |all: &[Shares], share: f64| Sample::of(above(all, Quantity::Orbit, 0.5).iter().map(|own| own - share));
    vec![
        Evidence::on("share of diffusing rods with C_b above ½, less the closed form's")
            .is(less(&of_diffusion, 1.0 - (orbits.weak)(0.5, ASPECT_RATIO)), 0.0, 0.015, weak.effect)
            .because("a third of what isotropic directions differ by, 0.046"),
        Evidence::on("share of colliding rods with C_b above ½, less that of isotropic directions")
            .exceeds(less(&of_collisions, 1.0 - orbit_constant_cdf(0.5, ASPECT_RATIO)), 0.0, high.effect)
            .because("\"far more\": the table of docs/src/theory/coefficients.md has 0.22"),
    ]
}
