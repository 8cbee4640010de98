//! The runs from which the coefficients are measured.

use super::*;
use crate::methods::coefficients::{Means, free, watched};
use crate::studies::interpretations::damping_rate;
use rand::RngExt;

#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Setting {
    pub n_a3: f64,
    /// r_e, the same for all rods.
    pub aspect_ratio: f64,
    /// α, with m = 3.
    pub alpha: f64,
    /// How colliding rods take their step.
    pub update: Update,
    /// Factor on the number of time steps that resolves the motion.
    pub finer: u64,
    pub places: Places,
}

/// Whether a pair that has collided meets again in the next step.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub enum Places {
    /// As the liquid carries the rods.
    #[serde(rename = "kept")]
    Carried,
    /// Drawn before every step, so that no pair has a past: a broken model, which shows what the past does.
    #[serde(rename = "anew")]
    Redrawn,
}

pub const fn kick(n_a3: f64, aspect_ratio: f64, alpha: f64, finer: u64) -> Setting {
    Setting { n_a3, aspect_ratio, alpha, update: Update::Kick, finer, places: Places::Carried }
}

/// The suspensions of the report, or all those of `shearbed bench`: updates and time steps first, then the rest at
/// [`FINER`] steps.
pub fn settings(full: bool) -> Vec<Setting> {
    let base = kick(0.2, 11.6, 0.5, FINER);
    let steps = |base: Setting, factors: &[u64]| -> Vec<Setting> {
        factors.iter().map(|finer| Setting { finer: *finer, ..base }).collect()
    };
    let rotation = Setting { update: Update::Rotation, ..base };
    let n_a3 = |n_a3| Setting { n_a3, ..base };
    let r_e = |aspect_ratio| Setting { aspect_ratio, ..base };
    let alpha = |alpha| Setting { alpha, ..base };
    if !full {
        let others = vec![n_a3(0.1), n_a3(0.5), n_a3(1.0), r_e(5.0), alpha(1.0)];
        return [steps(base, &[1, 4]), steps(rotation, &[1, 4]), others].concat();
    }
    [
        steps(base, &[1, 2, 4, 8, 16, 32]),
        steps(rotation, &[1, 4, 32]),
        steps(Setting { update: Update::Angles, ..base }, &[1, 4, 32]),
        steps(Setting { places: Places::Redrawn, ..base }, &[1, 8, 32]),
        [0.05, 0.1, 0.5, 1.0].map(n_a3).into(),
        [5.0, 20.0, 30.0].map(r_e).into(),
        [0.25, 1.0, 2.0].map(alpha).into(),
    ]
    .concat()
}

/// Factor on the number of time steps that resolves the motion, for the comparison of suspensions.
pub const FINER: u64 = 4;

#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Coefficients {
    pub setting: Setting,
    /// φ r_p of cylinders of the same length, with r_p = r_e.
    pub phi_rp: f64,
    /// Replicas of 100 rods.
    pub replicas: u64,
    /// Periods before the window; the window has as many.
    pub periods: u64,
    pub c_i: Estimate,
    /// C_I from each of the components 11, 22 and 33 of J alone.
    pub own: [Estimate; 3],
    /// J's component 12, which grows with the number of steps.
    pub j_12: Estimate,
    /// The relative residual of a fit with a single C_I.
    pub misfit: Estimate,
    /// β₁ and β₂ of Koch's anisotropic diffusivity.
    pub koch: [Estimate; 2],
    /// The relative residual of a fit by these two.
    pub koch_misfit: Estimate,
    /// The decay rate of X̄₁'s oscillation from an isotropic start, per period; none if the oscillation is lost in
    /// noise.
    pub damping_per_period: Option<Estimate>,
    /// Steady σ₁₂, N₁ and N₂ of the rods over μ_fiber G.
    pub stress: [Estimate; 3],
    /// Steady σ₁₂/(μG n a³) for rods that are spheroids.
    pub spheroids: Estimate,
}

const RODS: usize = 100;

/// Measures the suspensions one after the other.
pub fn rows(settings: &[Setting], replicas: u64, effort: &Effort) -> Vec<Coefficients> {
    settings.iter().map(|setting| row(*setting, replicas, effort)).collect()
}

/// Number of periods until the state is steady, and of the window: about equal numbers of collisions in each
/// suspension.
fn periods(setting: Setting) -> u64 {
    (1.0 / (setting.n_a3 * setting.alpha / 0.5)).ceil().clamp(5.0, 50.0) as u64
}

pub fn scene(setting: Setting, effort: &Effort) -> Scene {
    let mut scene = lab::interacting_scene(effort);
    scene.particles.count = RODS;
    scene.particles.aspect_ratio = setting.aspect_ratio;
    let length_cm = 0.1 * scene.particles.length_mm;
    let interaction = lab::interaction(&mut scene);
    interaction.concentration_per_cm3 = Some(setting.n_a3 / length_cm.powi(3));
    (interaction.alpha, interaction.update) = (setting.alpha, setting.update);
    scene.time.duration = 2.0 * periods(setting) as f64;
    scene.time.outputs_per_unit = Some(1);
    scene.time.steps_per_unit = Some(setting.finer * scene.resolving_steps());
    scene
}

/// The means of each replica over the second half of its scene, and X̄₁ at each quarter of the first two periods.
pub(crate) fn windows(scene: &Scene, places: Places, replicas: u64) -> Vec<(Means, [f64; 9])> {
    let lost = (Means { gain: Matrix3::from_element(f64::NAN), ..Means::default() }, [f64::NAN; 9]);
    lab::replicas(replicas, |replica| window(scene, places, replica).unwrap_or(lost))
}

/// One replica of [`windows`]; `None` where a step fails.
fn window(scene: &Scene, places: Places, replica: u64) -> Option<(Means, [f64; 9])> {
    let (r_e, steps) = (scene.particles.aspect_ratio, scene.time.steps_per_unit? as usize);
    let half = scene.time.duration as usize * steps / 2;
    let strain = strain_per_period(r_e) / steps as f64;
    let mut rods = lab::suspension(scene, replica);
    let mut rng = Pcg64Dxsm::seed_from_u64(scene.ensemble.seed ^ replica.rotate_left(32));
    let mut moved = |rods: &mut Suspension| {
        if places == Places::Redrawn {
            let sides = rods.sides_in_lengths();
            let axis = |side: f64| (0..RODS).map(|_| side * rng.random::<f64>()).collect();
            let directions: Vec<_> = rods.directions().into_iter().map(UnitVector3::new_unchecked).collect();
            rods.place(sides.map(axis), &directions)?;
        }
        rods.step().ok()?;
        Some(())
    };
    let mut quarters = [f64::NAN; 9];
    for step in 0..half {
        // The nearest step to each quarter of a period; the first half of a scene has more than two periods.
        if let Some(k) = (0..9).find(|k| (k * steps + 2) / 4 == step) {
            quarters[k] = lab::x1_after(&mut rods, 0)?;
        }
        moved(&mut rods)?;
    }
    let start = rods.directions();
    let mut next = || moved(&mut rods).map(|()| rods.directions());
    Some((watched(&free(shape_factor(r_e), strain), strain, start, half, &mut next)?, quarters))
}

fn row(setting: Setting, replicas: u64, effort: &Effort) -> Coefficients {
    let (means, quarters): (Vec<_>, Vec<_>) =
        windows(&scene(setting, effort), setting.places, replicas).into_iter().unzip();
    let of = |value: &dyn Fn(&Means) -> f64| {
        let without: Vec<_> = (0..means.len()).map(|k| value(&Means::of(&means, Some(k)))).collect();
        Estimate::jackknife(value(&Means::of(&means, None)), &without)
    };
    let own = |i: usize| of(&|means| means.gain[(i, i)] / means.diffusion()[(i, i)]);
    Coefficients {
        setting,
        phi_rp: std::f64::consts::FRAC_PI_4 * setting.n_a3 / setting.aspect_ratio,
        replicas,
        periods: periods(setting),
        c_i: of(&|means| means.coefficient()),
        own: [0, 1, 2].map(own),
        j_12: of(&|means| means.gain[(0, 1)]),
        misfit: of(&|means| means.misfit()),
        koch: std::array::from_fn(|k| of(&|means| means.koch().0[k])),
        koch_misfit: of(&|means| means.koch().1),
        damping_per_period: damping(&quarters),
        stress: std::array::from_fn(|k| of(&|means| means.stress()[k])),
        spheroids: of(&|means| means.spheroids(setting.aspect_ratio)),
    }
}

/// The decay of X̄₁'s oscillation from the mean over replicas, with an error by the jackknife.
fn damping(quarters: &[[f64; 9]]) -> Option<Estimate> {
    let rate = |without: Option<usize>| {
        let others = || quarters.iter().enumerate().filter(|(k, _)| Some(*k) != without);
        let count = others().count() as f64;
        let mean = |place: usize| others().map(|(_, x)| x[place]).sum::<f64>() / count;
        damping_rate(&std::array::from_fn(|place| if place < 9 { mean(place) } else { 0.0 }))
    };
    let without: Vec<_> = (0..quarters.len()).map(|k| rate(Some(k))).collect();
    let rate = Estimate::jackknife(rate(None), &without);
    (rate.value.is_finite() && rate.se.is_finite() && rate.readable()).then_some(rate)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::methods::coefficients::of_run;
    use shearbed::run::ensemble;
    use shearbed::{Observable, Plan};

    /// C_I from the means of a run against J of every step of the same rods, which shares no sum with it.
    #[test]
    fn the_means_of_a_run_have_the_coefficient_of_its_steps() {
        let mut scene = scene(kick(1.0, 5.0, 0.5, 1), &Effort::gate());
        let steps = Means::of(&windows(&scene, Places::Carried, 4).into_iter().map(|w| w.0).collect::<Vec<_>>(), None);
        scene.ensemble.replicas = 4;
        scene.output.observables = vec![Observable::OrientationTensor, Observable::OrientationTensor4];
        let mut of = |outputs: u64, r_e: f64| {
            scene.time.outputs_per_unit = Some(outputs);
            let results = ensemble::run(&Plan::new(&scene).unwrap()).unwrap();
            of_run(&results, r_e, scene.flow.shear_rate_per_s().unwrap(), 4).unwrap()
        };
        let (due, found) = (steps.coefficient(), of(100, 5.0));
        assert!((found.value / due - 1.0).abs() < 0.02, "{found:?} {due}");
        assert!(found.se.is_some_and(|se| se < 0.3 * due), "{found:?}");
        // Of a wrong shape factor the rest is no effect of collisions.
        let wrong = of(100, 2.0);
        assert!((wrong.value / due - 1.0).abs() > 0.1, "{wrong:?} {due}");
    }
}
