//! Checking how the rods are shaped and where they start: what goes together.

#[cfg(test)]
mod tests;

use super::allowed::Invalid;
use super::particles::equivalent;
use super::{Orientation, Scene, find};

impl Scene {
    /// Checks that r_e is given once: by itself, or by a cylinder and a formula that gives one for it.
    pub(super) fn check_shape(&self) -> Result<(), Invalid> {
        let particles = &self.particles;
        let key = "particles.shape_correlation";
        let (r, formula) = match (particles.physical_aspect_ratio, particles.shape_correlation) {
            (None, None) => return Ok(()),
            (None, Some(given)) => {
                let allowed = "it goes with physical_aspect_ratio, which is not given";
                return Err(Invalid::new(key, format!("{:?}", given.name()), allowed));
            }
            (Some(r), None) => {
                let words = find(key).map_or_else(String::new, |key| key.holds.to_string());
                let allowed = format!("physical_aspect_ratio = {r} takes {words}");
                return Err(Invalid::missing(key, &allowed));
            }
            (Some(r), Some(correlation)) => (r, correlation.formula()),
        };
        match equivalent(Some(r), particles.shape_correlation) {
            Some(value) if value == particles.aspect_ratio => Ok(()),
            Some(value) => {
                let allowed = format!(
                    "either aspect_ratio or physical_aspect_ratio, of which {} makes {value}",
                    formula.name
                );
                Err(Invalid::new(
                    "particles.aspect_ratio",
                    particles.aspect_ratio,
                    allowed,
                ))
            }
            None => {
                let allowed = format!(
                    "{} ({}) gives no r_e there: above r, or falling as r grows; `shearbed shape` lists what others give",
                    formula.name, formula.formula
                );
                Err(Invalid::new("particles.physical_aspect_ratio", r, allowed))
            }
        }
    }

    /// Checks that the directions of a file are there, one for each rod.
    pub(super) fn check_start(&self) -> Result<(), Invalid> {
        let Orientation::Each { file, p, .. } = &self.particles.orientation else {
            return Ok(());
        };
        let refused = |allowed: String| {
            let value = format!("{{ file = {file:?} }}");
            Err(Invalid::new("particles.orientation", value, allowed))
        };
        let Some(p) = p else {
            return refused(
                "a file's directions where something has read it, as `shearbed run`, `plan` and `sweep` do"
                    .into(),
            );
        };
        let count = self.particles.count;
        if p.iter().any(|axis| axis.len() != count) {
            return refused(format!(
                "a direction for each rod: it has {}, and particles.count is {count}",
                p[0].len()
            ));
        }
        let square = |rod: usize| p.iter().map(|axis| axis[rod] * axis[rod]).sum::<f64>();
        let is_unit = |rod: usize| (square(rod) - 1.0).abs() <= 16.0 * f64::EPSILON;
        match (0..count).find(|rod| !is_unit(*rod)) {
            Some(rod) => refused(format!("directions of length 1, which that of rod {rod} is not")),
            None => Ok(()),
        }
    }

    /// Checks that r_e has the mean that its flow allows, and stays on its side of 1.
    pub(super) fn check_particles(&self) -> Result<(), Invalid> {
        let (r, sd) = (
            self.particles.aspect_ratio,
            self.particles.aspect_ratio_sd_percent,
        );
        if self.interaction.is_some() && r <= 1.0 {
            let allowed = "interacting rods need a number > 1";
            return Err(Invalid::new("particles.aspect_ratio", r, allowed));
        }
        // Three standard deviations: P(r_e ≤ 1) = 0.0013 per rod.
        let deviation = 3.0 * r * sd / 100.0;
        let too_wide = sd > 0.0 && ((r - 1.0).abs() <= deviation || r <= deviation);
        if too_wide {
            let widest = 100.0 * ((r - 1.0).abs().min(r) / (3.0 * r));
            return Err(Invalid::new(
                "particles.aspect_ratio_sd_percent",
                sd,
                format!(
                    "so wide that r_e ≤ 1 (for discs: r_e ≥ 1 or ≤ 0) is likely; with mean {r} below {widest:.4}, \
                     three standard deviations"
                ),
            ));
        }
        Ok(())
    }
}
