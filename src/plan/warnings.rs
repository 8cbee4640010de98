//! Warnings about results that may be doubtful.

use super::{Plan, Stage};
use crate::model::collision::reach;
use crate::observable::Observable;
use crate::scene::{DENSE, Interaction, Orientation, Update};

/// The aspect ratio below which the slender limit of the rods' stress triggers a warning. A rule of thumb: the terms
/// that the limit leaves out fall slowly with r_e, and vanish at no r_e.
const SLENDER: f64 = 30.0;

/// The aspect ratio below which colliding rods trigger a warning. The paper asks for r_e ≫ 1 and states no bound. Its
/// contact rule joins the rods' axes, so it ignores their diameter, which is more than a tenth of the length here; and
/// the paper compares no rods below r_e = 11.6 with measurements.
const RULE_OF_LINES: f64 = 10.0;

/// Largest relative difference between the mean r_e of a file and the scene's without a warning: three standard errors
/// of a few rods.
const OWN_MEAN: f64 = 0.1;

impl Plan {
    /// Warnings that a reader of the results should know.
    pub fn warnings(&self) -> Vec<String> {
        [
            self.unresolved_steps(),
            self.steps_for_nothing(),
            self.alone(),
            self.turned_straight(),
            self.unrelated_sizes(),
            self.one_start(),
            self.other_mean(),
            self.drawn_for_nothing(),
            self.half_empty(),
            self.thick(),
            self.not_slender(),
            self.cut_short(),
            self.dense(),
            self.all_collide(),
            self.thin_box(),
            self.undisturbed(),
        ]
        .into_iter()
        .flatten()
        .collect()
    }

    /// Warns if steps are too long for the motion.
    fn unresolved_steps(&self) -> Option<String> {
        let (steps, motion) = (self.scene.steps_per_unit(), self.scene.motion_per_step());
        let resolved = self.scene.resolved_motion();
        (self.steps() > 0 && motion > resolved).then(|| {
            // In shear both are equal, to round-off.
            let what = if self.scene.diffuses() {
                "the largest of the strain, twice the turn of the liquid and five times D_r Δt, per step,"
            } else if motion > 1.5 * self.elapsed(1.0).strain / steps as f64 {
                "twice the angle by which the liquid turns in a step"
            } else {
                "the strain per step"
            };
            format!(
                "{} = {steps} does not resolve the motion: {what} is {motion:.3}, above {resolved:.3}; {} steps a {} \
                 resolve it (the default)",
                self.scene.time.unit.steps_key(),
                self.scene.resolving_steps(),
                self.scene.time.unit
            )
        })
    }

    /// Warns about a number of steps in a scene without collisions; one of which these are switched off may keep its
    /// steps.
    fn steps_for_nothing(&self) -> Option<String> {
        let given = self.scene.time.steps_per_unit.is_some() && !self.scene.steps();
        given.then(|| format!("{} has no effect: free rods take no steps", self.scene.time.unit.steps_key()))
    }

    /// Warns about collisions of a single rod.
    fn alone(&self) -> Option<String> {
        let alone = self.scene.interaction.is_some() && self.scene.particles.count == 1;
        alone.then(|| "interaction has no effect: one rod has no neighbour".to_owned())
    }

    /// Warns if collisions turn rods straight in a liquid that rotates, except in the paper's flow.
    fn turned_straight(&self) -> Option<String> {
        let update = self.scene.interaction.as_ref()?.update;
        let turns = self.flow.shear_rate_per_s().is_none() && self.flow.turn_per_s() > 0.0;
        (self.runs(Stage::Contacts) && turns && update != Update::Kick).then(|| {
            "interaction.update turns colliding rods straight through a step, where free rods follow the liquid: an \
             error ∝ Δt that adds up with time in flows that turn; \"kick\" has none"
                .to_owned()
        })
    }

    /// Warns if directions come from a file, but the rods' aspect ratios or lengths are drawn.
    fn unrelated_sizes(&self) -> Option<String> {
        let particles = &self.scene.particles;
        let (file, own) = (&particles.rods.as_ref()?.file, particles.own()?);
        let drawn = [
            ("aspect_ratio", own.aspect_ratio.is_none(), particles.aspect_ratio_sd_percent),
            ("length", own.length_mm.is_none(), particles.length_sd_percent),
        ];
        let (name, _, sd) = (drawn.into_iter()).find(|(_, lacks, sd)| own.p.is_some() && *lacks && *sd > 0.0)?;
        Some(format!(
            "particles.{name}_sd_percent = {sd} draws each rod's {} again, unrelated to its direction in {file}: to \
             continue a suspension of unequal rods, give the file that column too, as rods.csv has it",
            name.replace('_', " ")
        ))
    }

    /// Warns if all replicas start with the same directions from a file: their scatter is not that of the rods.
    fn one_start(&self) -> Option<String> {
        let particles = &self.scene.particles;
        let (file, own) = (&particles.rods.as_ref()?.file, particles.own()?);
        let replicas = self.scene.ensemble.replicas;
        let drawn = particles.aspect_ratio_sd_percent > 0.0 && own.aspect_ratio.is_none();
        let moves = self.runs(Stage::Contacts) || self.runs(Stage::Diffusion) || drawn;
        let said = if moves {
            format!(
                "{replicas} replicas start with the directions in {file}: standard errors over replicas leave out the \
                 scatter of these rods, which those of one replica have"
            )
        } else {
            format!(
                "the {replicas} replicas are alike: free rods start with the directions in {file}, and nothing is \
                 drawn that turns them; one replica says as much, with standard errors over its rods"
            )
        };
        (own.p.is_some() && replicas > 1).then_some(said)
    }

    /// Warns if the mean r_e of the rods in a file is far from the scene's.
    fn other_mean(&self) -> Option<String> {
        let particles = &self.scene.particles;
        let mean = particles.mean_aspect_ratio();
        let near = (mean / particles.aspect_ratio - 1.0).abs() <= OWN_MEAN;
        (!near).then(|| {
            format!(
                "particles.aspect_ratio = {} sets only the period T and the output times: the rods in particles.rods \
                 have a mean of {mean:.4}",
                particles.aspect_ratio
            )
        })
    }

    /// Warns about keys without effect because a file gives the values that they would draw.
    fn drawn_for_nothing(&self) -> Option<String> {
        let particles = &self.scene.particles;
        let own = particles.own()?;
        let unused = [
            ("orientation", own.p.is_some() && particles.orientation != Orientation::default()),
            ("aspect_ratio_sd_percent", own.aspect_ratio.is_some() && particles.aspect_ratio_sd_percent > 0.0),
            ("length_sd_percent", own.length_mm.is_some() && particles.length_sd_percent > 0.0),
        ];
        let unused = unused.into_iter().filter(|(_, is)| *is);
        let unused: Vec<_> = unused.map(|(key, _)| format!("particles.{key}")).collect();
        let verb = if unused.len() > 1 { "have" } else { "has" };
        (!unused.is_empty())
            .then(|| format!("{} {verb} no effect: particles.rods gives it for each rod", unused.join(", ")))
    }

    /// Warns if the places in a file leave part of the control volume empty, as after a change of its size.
    fn half_empty(&self) -> Option<String> {
        let (places, sides) = (self.scene.particles.own()?.place_mm.as_ref()?, self.scene.sides_mm()?);
        let farthest = |axis: &Vec<f64>| axis.iter().copied().fold(0.0, f64::max);
        let short = places.iter().map(farthest).zip(sides);
        // The probability that n uniform places all lie within this share of a side; below 1e-6 it is no accident.
        let rods = places[0].len() as f64;
        let by_chance = |share: f64| libm::pow(share, rods) < 1e-6;
        let (axis, (farthest, side)) = (short.enumerate()).find(|(_, (farthest, side))| by_chance(farthest / side))?;
        Some(format!(
            "the places in particles.rods reach only {farthest} of {side} mm along axis {}: check that they belong to \
             this control volume",
            axis + 1
        ))
    }

    /// Warns if colliding rods are too thick for the collision rule.
    fn thick(&self) -> Option<String> {
        let mean = self.scene.particles.mean_aspect_ratio();
        (self.runs(Stage::Contacts) && mean < RULE_OF_LINES).then(|| {
            format!(
                "{}: the collision rule is for slender rods, r_e ≫ 1. Below {RULE_OF_LINES} it leaves out a diameter \
                 of more than a tenth of a rod's length. Lee & Springer leave out Okagawa & Mason's points of r_e = \
                 3.96, and name a lack of slenderness as one possible reason (Results, after Fig. 5)",
                self.mean_and_its_key()
            )
        })
    }

    /// The mean r_e, with the key that gives it.
    fn mean_and_its_key(&self) -> String {
        let particles = &self.scene.particles;
        if particles.own().is_some_and(|own| own.aspect_ratio.is_some()) {
            format!("particles.rods has a mean r_e of {:.4}", particles.mean_aspect_ratio())
        } else {
            format!("particles.aspect_ratio = {}", particles.aspect_ratio)
        }
    }

    /// Warns if the stress of slender rods is computed for rods that are not slender.
    fn not_slender(&self) -> Option<String> {
        let r = self.scene.particles.mean_aspect_ratio();
        (self.runs(Stage::Observe(Observable::ParticleStress)) && r < SLENDER).then(|| {
            format!(
                "{}: particle_stress is the limit of slender rods, r_e ≫ 1. Below {SLENDER} the terms that it leaves \
                 out are not small; the observable \"stress\" has them (docs/src/theory/coefficients.md)",
                self.mean_and_its_key()
            )
        })
    }
    /// Warns if a scene ends between two outputs, as nothing is run after the last output.
    fn cut_short(&self) -> Option<String> {
        let time = &self.scene.time;
        let (key, end) = (time.unit.duration_key(), time.duration);
        let last = *self.times().last()?;
        // An end that differs from an output by rounding is not between outputs.
        (self.scene.output.times.is_empty() && last < end * (1.0 - 1e-12)).then(|| {
            let (outputs, own) = (time.unit.outputs_key(), self.scene.outputs_per_unit());
            let steps = time.steps_per_unit.filter(|_| self.scene.steps());
            let ends = |outputs: &u64| {
                let of_end = end * *outputs as f64;
                (of_end - of_end.round()).abs() < 1e-9 && steps.is_none_or(|steps| steps.is_multiple_of(*outputs))
            };
            // Of many outputs a look at some is enough: each point of a sweep is asked.
            let fit = (own..=10 * own)
                .take(10_000)
                .find(ends)
                .map_or(String::new(), |fit| format!("; with {fit} the last is at the end"));
            format!("{key} = {end} ends between two outputs: the last one is at {last}; {outputs} is {own}{fit}")
        })
    }

    /// Warns if more than two rods may meet at a time.
    fn dense(&self) -> Option<String> {
        let scene = &self.scene;
        let n_a3 = scene.rods_per_cubed_length().filter(|n_a3| *n_a3 >= DENSE)?;
        let shown = if n_a3 < 1e4 { format!("{n_a3:.3}") } else { format!("{n_a3:.3e}") };
        let lengths = if scene.particles.rods.is_some() { "rods" } else { "length_mm" };
        let regime = scene.regime()?;
        Some(format!(
            "{} and particles.{lengths} give n a³ = {shown}: {regime}. The model is for dilute suspensions, n a³ far \
             below 1, in which two rods meet at a time",
            scene.concentration_key(),
        ))
    }

    /// Warns if more than half of the rods collide in a step: then the means depend on the step.
    fn all_collide(&self) -> Option<String> {
        let scene = &self.scene;
        let Interaction { alpha, m, .. } = *scene.interaction.as_ref().filter(|_| self.runs(Stage::Contacts))?;
        // The mean distance of the nearest of random points: Chandrasekhar 1943, Rev. Mod. Phys. 15, 1.
        let distance_mm = 10.0 * 0.554 / libm::cbrt(scene.concentration_per_cm3()?);
        (distance_mm < scene.particles.length_mm * reach(0.5, alpha, m)).then(|| {
            let alpha = if alpha < 1e4 { format!("{}", (1e4 * alpha).round() / 1e4) } else { format!("{alpha:e}") };
            format!(
                "interaction.alpha = {alpha}, m = {m}: a rod and its neighbour at the mean distance collide in more \
                 than half of all steps, however short: the means depend on the step"
            )
        })
    }

    /// Warns if the control volume is thinner than a rod is long.
    fn thin_box(&self) -> Option<String> {
        let (sides, length) = (self.scene.box_mm()?, self.scene.particles.length_mm);
        let thinnest = sides.into_iter().fold(f64::INFINITY, f64::min);
        (thinnest < length).then(|| {
            format!(
                "interaction.box_mm = {sides:?}: {thinnest} mm is less than a rod's length, {length} mm; rods near a \
                 face lack neighbours, and here all are near one"
            )
        })
    }

    /// Warns if rods collide without effect.
    fn undisturbed(&self) -> Option<String> {
        let why = self.scene.particles.undisturbed().filter(|_| self.runs(Stage::Contacts))?;
        Some(format!(
            "interaction has no effect: {why}, and such rods disturb each other in this model only by the error of a \
             time step"
        ))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{OwnRods, Particles, RodsFile, parse};

    /// 50 rods per cm³ of 0.72 mm, with keys that follow those of particles, of interaction and of time.
    fn warnings(particles: &str, interaction: &str, time: &str) -> Vec<String> {
        let text = format!(
            "title = \"t\"\n[flow]\nshear_rate_per_s = 0.5\n[particles]\ncount = 100\nlength_mm = 0.72\naspect_ratio = \
             11.6\n{particles}\n[interaction]\nalpha = 0.5\n{interaction}\n[time]\n{time}\n"
        );
        Plan::new(&parse("t.toml", &text).unwrap()).unwrap().warnings()
    }

    #[test]
    fn results_that_mean_little_are_warned_of_once() {
        let (rods, n, t) = ("orientation = \"isotropic\"", "concentration_per_cm3 = 50", "periods = 6");
        let start = |phi: f64, theta: f64| format!("orientation = {{ phi_deg = {phi:?}, theta_deg = {theta:?} }}");
        let [spread, spread_in_plane] =
            [45.0, 90.0].map(|theta| start(90.0, theta) + "\naspect_ratio_sd_percent = 3.6");
        let none = "";
        let short = "time.periods = 0.353 ends between two outputs: the last one is at 0.35; time.outputs_per_period";
        for (particles, interaction, time, expected) in [
            (rods, n, t, none),
            (rods, n, "periods = 0.3", none),
            (rods, n, "periods = 0", none),
            (rods, n, "periods = 0.353", &format!("{short} is 200; with 1000 the last is at the end")),
            (rods, n, "periods = 0.004", "time.periods = 0.004 ends between two outputs: the last one is at 0;"),
            (rods, "concentration_per_cm3 = 260", t, none),
            (
                rods,
                "concentration_per_cm3 = 270",
                t,
                "interaction.concentration_per_cm3 and particles.length_mm give \
                n a³ = 0.101: not far below 1.",
            ),
            (rods, "concentration_per_cm3 = 50\nm = 0.5", t, none),
            (
                rods,
                "concentration_per_cm3 = 50\nm = 0.4",
                t,
                "interaction.alpha = 0.5, m = 0.4: a rod and its neighbour",
            ),
            (
                rods,
                "concentration_per_cm3 = 5000",
                t,
                "interaction.concentration_per_cm3 and particles.length_mm give \
                n a³ = 1.866: semi-dilute.",
            ),
            (
                rods,
                "concentration_per_cm3 = 50000",
                t,
                "interaction.concentration_per_cm3 and particles.length_mm \
                give n a³ = 18.662: concentrated.",
            ),
            (rods, "box_mm = [0.73, 50, 50]", t, none),
            (rods, "box_mm = [0.71, 50, 50]", t, "interaction.box_mm = [0.71, 50.0, 50.0]: 0.71 mm is less than a"),
            (&start(90.0, 90.0), n, t, "interaction has no effect: all rods start parallel in the shear plane"),
            (&start(0.0, 0.0), n, t, "interaction has no effect: all rods start along the vorticity axis"),
            (&start(90.0, 45.0), n, t, "interaction has no effect: all rods start parallel with one r_e"),
            (&spread, n, t, none),
            (&spread_in_plane, n, t, "interaction has no effect: all rods start parallel in the shear plane"),
            (&start(30.0, 180.0), n, t, "interaction has no effect: all rods start along the vorticity axis"),
            (&start(90.0, 90.0), "concentration_per_cm3 = 50\nupdate = \"angles\"", t, "interaction has no effect"),
        ] {
            let found = warnings(particles, interaction, time);
            assert_eq!(found.len(), usize::from(!expected.is_empty()), "{particles} {interaction} {time}: {found:?}");
            assert!(found.iter().all(|warning| warning.starts_with(expected)), "{found:?}");
        }
        // Outputs are at steps of their own.
        assert_eq!(warnings(rods, n, "periods = 0.353\nsteps_per_period = 200"), [format!("{short} is 200")]);
    }

    #[test]
    fn rods_of_a_file_in_the_shear_plane_or_along_the_vorticity_axis_do_not_disturb_each_other() {
        let why = |p: [[f64; 2]; 3]| {
            let own = OwnRods { p: Some(p.map(Vec::from)), ..OwnRods::default() };
            Particles { rods: Some(RodsFile::with("two.csv", own)), ..Particles::default() }.undisturbed()
        };
        assert_eq!(why([[1.0, 0.6], [0.0, 0.8], [0.0, 0.0]]), Some("all rods start in the shear plane"));
        assert_eq!(why([[0.0, 0.0], [0.0, 0.0], [1.0, -1.0]]), Some("all rods start along the vorticity axis"));
        // One of two out of the plane; two across the flow; two across the gradient.
        assert_eq!(why([[1.0, 0.6], [0.0, 0.0], [0.0, 0.8]]), None);
        assert_eq!(why([[0.0, 0.6], [0.0, 0.0], [1.0, 0.8]]), None);
        assert_eq!(why([[0.0, 0.0], [0.0, 0.6], [1.0, 0.8]]), None);
    }
}
